// cut_clusters.hpp — atoms in a ball, and their mesh in a box that cuts it.
#pragma once
#include "unit/contour/checked.hpp"
#include "unit/contour/sample_grid.hpp"
#include <random>

namespace molmesh::test {

// 40 atoms of 1.7 Å in a ball.
inline BlockGrid cluster(uint32_t seed, double h) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-4, 4);
  std::vector<Vec3d> centre;
  while (centre.size() < 40)
    if (const Vec3d c{u(random), u(random), u(random)}; norm(c) < 4)
      centre.push_back(c);
  return cube_grid(8, h, [centre](Vec3d x) {
    double sum = 1e-30;
    for (const Vec3d& c : centre)
      sum += std::exp(-0.8 * (norm2(x - c) - 1.7 * 1.7));
    return sum;
  });
}

// Cut by walls at x = at and y = -at.
inline TetMesh cut(const BlockGrid& grid, contour::Options::Meshed meshed, double at) {
  contour::Options options;
  options.meshed = meshed;
  options.box.kind = contour::BoxRequest::corners;
  options.box.lower = {-9, -at, -9};
  options.box.upper = {at, 9, 9};
  return mesh_of(grid, options);
}

} // namespace molmesh::test
