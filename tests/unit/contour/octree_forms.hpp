// octree_forms.hpp — a ball's grid, and what octrees and boxes there are besides the plain ones: for comparisons.
#pragma once
#include "contour/options.hpp"
#include "unit/contour/sample_grid.hpp"
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace molmesh::test {

/// Of radius 5 Å, whose surface is nearly plane for the spacing.
inline BlockGrid ball_grid(double h = 0.25) {
  return cube_grid(6.2, h, [](Vec3d x) { return std::exp(-0.3 * (norm2(x) - 25)); });
}

/// The cells of the ball are merged, and both regions are meshed.
inline contour::Options plain_form() {
  contour::Options o;
  o.meshed = contour::Options::both;
  o.adapt = 0.3;
  return o;
}

/// Each asks for more leaves than plain_form() does on ball_grid().
inline std::vector<std::pair<std::string, contour::Options>> octree_forms() {
  std::vector<std::pair<std::string, contour::Options>> forms;
  const auto add = [&](const char* name) -> contour::Options& {
    return forms.emplace_back(name, plain_form()).second;
  };
  add("sizes").sizes = {{{5, 0, 0}, 2, 0.25}, {{0, 5, 0.5}, 2.5, 1}};
  add("layers").layers = 3;
  add("owners").owners = [](const std::vector<Vec3d>& place) {
    std::vector<contour::Owner> owner;
    for (const Vec3d& p : place) {
      const double lead = p.x + 0.3 * p.y - 0.1;
      owner.push_back({lead > 0, std::fabs(lead)});
    }
    return owner;
  };
  contour::Options& sphere = add("sphere");
  sphere.box.kind = contour::BoxRequest::sphere;
  sphere.box.outer = {{0.7, -0.3, 0.4}, 9};
  return forms;
}

/// A body of a few spacings: the spacing is halved for it.
inline BlockGrid thin_body_grid() {
  return cube_grid(3, 0.5, [](Vec3d x) { return std::exp(2 * (0.5 - norm2(x - Vec3d{0.11, 0.27, 0.39}))); });
}

} // namespace molmesh::test
