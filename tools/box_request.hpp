// box_request.hpp — the outer boundary in the words of --box.
#pragma once
#include "base/error.hpp"
#include "cli/options.hpp"
#include "cli/value.hpp"
#include "contour/octree/lattice.hpp"
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

namespace molmesh {

/// "a sphere of 61.2 Å about 1.00 2.00 3.00".
inline std::string sphere_text(const Sphere& s) {
  char text[160];
  std::snprintf(text, sizeof text, "a sphere of %.2f Å about %.2f %.2f %.2f", s.radius, s.center.x, s.center.y,
                s.center.z);
  return text;
}

inline cli::Value sphere_value(const Sphere& s) {
  return {{"center", std::vector{s.center.x, s.center.y, s.center.z}}, {"radius", s.radius}};
}

inline contour::BoxRequest parse_sphere(const std::string& text) {
  contour::BoxRequest box;
  const std::string prefix = "sphere:", given = text.substr(std::min(text.size(), prefix.size()));
  const auto refuse = [&](const std::string& expected) {
    fail(Status::usage, "--box: found '" + text + "', expected " + expected);
  };
  const auto forms = "sphere:2x for twice the radius of the molecule's surface, sphere:+30 for 30 Å round it, or "
                     "sphere:X,Y,Z,RADIUS in Å";
  if (text.rfind(prefix, 0) != 0 || given.empty())
    refuse(forms);
  if (given[0] == '+') {
    box.kind = contour::BoxRequest::sphere_padding;
    box.distance = cli::numbers("--box", given.substr(1), 1)[0];
    if (!(box.distance > 0))
      refuse("+ and a distance above 0 Å");
  } else if (given.back() == 'x') {
    box.kind = contour::BoxRequest::sphere_factor;
    box.scale = cli::numbers("--box", given.substr(0, given.size() - 1), 1)[0];
    if (!(box.scale > 1))
      refuse("a factor above 1");
  } else {
    if (std::count(given.begin(), given.end(), ',') != 3)
      refuse(forms);
    const std::vector<double> v = cli::numbers("--box", given, 4);
    box.kind = contour::BoxRequest::sphere;
    box.outer = {{v[0], v[1], v[2]}, v[3]};
    if (!(v[3] > 0))
      refuse("a radius above 0 Å");
  }
  return box;
}

inline contour::BoxRequest parse_box(const std::string& text) {
  contour::BoxRequest box;
  if (text == "auto")
    return box;
  if (text == "tight") {
    box.kind = contour::BoxRequest::tight;
    return box;
  }
  const auto refuse = [&](const std::string& expected) {
    fail(Status::usage, "--box: found '" + text + "', expected " + expected);
  };
  constexpr double largest_bare = 10; // a number alone is a factor; what is larger was meant to be Å
  if (text.rfind("sphere", 0) == 0)
    return parse_sphere(text);
  if (text.rfind('+', 0) == 0) {
    box.kind = contour::BoxRequest::padding;
    box.distance = cli::numbers("--box", text.substr(1), 1)[0];
    if (!(box.distance > 0))
      refuse("+ and a distance above 0 Å");
    return box;
  }
  if (text.empty() || text.find_first_not_of("0123456789.,+-eEx") != text.npos)
    refuse("auto, tight, a factor such as 2x, a distance such as +30, x0,y0,z0,x1,y1,z1, sphere:2x, sphere:+30 or "
           "sphere:X,Y,Z,RADIUS");
  if (std::count(text.begin(), text.end(), ',') == 0) {
    box.kind = contour::BoxRequest::factor;
    const bool times = !text.empty() && text.back() == 'x';
    box.scale = cli::numbers("--box", times ? text.substr(0, text.size() - 1) : text, 1)[0];
    if (!(box.scale > 1))
      refuse("a factor above 1");
    if (!times && box.scale > largest_bare)
      refuse(text + "x for that many times the surface's extents, +" + text +
             " for that many Å round it, or x0,y0,z0,x1,y1,z1");
    return box;
  }
  const std::vector<double> v = cli::numbers("--box", text, 6);
  box.kind = contour::BoxRequest::corners;
  box.lower = {v[0], v[1], v[2]};
  box.upper = {v[3], v[4], v[5]};
  for (int a = 0; a < 3; ++a)
    if (!(box.lower[a] < box.upper[a]))
      fail(Status::usage, "--box: found '" + text + "', expected x0 < x1, y0 < y1 and z0 < z1");
  return box;
}

} // namespace molmesh
