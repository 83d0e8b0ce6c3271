// sag.hpp — how far triangles of the outer sphere lie below it.
#pragma once
#include "geom/sphere.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include <algorithm>
#include <vector>

namespace molmesh::optimize {

/// No operation makes a triangle that lies deeper below the sphere than this share of its longest edge, unless one
/// that goes lay deeper.
inline constexpr double most_sag = 0.1;

/// Depth below the sphere over the longest edge, of a triangle between points on it, seen from outside. Large where
/// it is turned.
inline double sag(const Sphere& s, Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d normal = cross(b - a, c - a);
  const double longest = std::sqrt(std::max({norm2(b - a), norm2(c - a), norm2(c - b)}));
  return (s.radius - dot(normal, a - s.center) / std::max(norm(normal), 1e-300)) / std::max(longest, 1e-300);
}

/// Of the elements' faces on the sphere that have vertex v, the largest.
inline double largest_sag(const DynamicMesh& m, const std::vector<int32_t>& elements, int32_t v) {
  double most = 0;
  for (const int32_t t : elements) {
    const Element& e = m.element[t];
    for (size_t f = 0; f < 4; ++f)
      if (m.labels[e.label[f]].round && e.v[f] != v) {
        const auto p = outward_triangle(e.v, f);
        most = std::max(most, sag(m.sphere, m.point[p[0]], m.point[p[1]], m.point[p[2]]));
      }
  }
  return most;
}

} // namespace molmesh::optimize
