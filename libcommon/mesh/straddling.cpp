// straddling.cpp — heights of a curved surface above its chords, from normals.
#include "mesh/straddling.hpp"
#include "geom/tet_measures.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh {
namespace {

/// Sums over the triangles of the surface at a point.
struct Star {
  Vec3d normal;         // of the area, then of length 1
  double area = 0;      // twice the triangles'
  double height = 0;    // of the surface above them, times that
  double shortest2 = 0; // edge, Å²
  bool moves = false;
};

std::vector<Star> stars(const TetMesh& m) {
  std::vector<Star> star(m.point.size());
  const auto each_triangle = [&](auto&& at) {
    for (size_t t = 0; t < m.tri.size(); ++t)
      if (m.boundary[t] == Boundary::surface)
        at(m.tri[t]);
  };
  each_triangle([&](const Tri& t) {
    const Vec3d n = tri_normal(m.point[t[0]], m.point[t[1]], m.point[t[2]]);
    for (size_t i = 0; i < 3; ++i) {
      Star& s = star[t[i]];
      s.normal += n;
      s.area += norm(n);
      const double longer2 =
          std::min(norm2(m.point[t[(i + 1) % 3]] - m.point[t[i]]), norm2(m.point[t[(i + 2) % 3]] - m.point[t[i]]));
      s.shortest2 = s.moves ? std::min(s.shortest2, longer2) : longer2;
      s.moves = true;
    }
  });
  for (Star& s : star) {
    const double length = norm(s.normal);
    s.moves = s.moves && length > 0;
    if (s.moves)
      s.normal = s.normal / length;
  }
  each_triangle([&](const Tri& t) {
    // Above the middle of an edge e a surface with the normals n and n' at its ends is e·(n' - n) / 8 high. A
    // triangle's mean height is a third of the sum of its edges' if the height is quadratic.
    double height = 0;
    for (size_t i = 0; i < 3; ++i) {
      const int32_t a = t[i], b = t[(i + 1) % 3];
      height += dot(m.point[b] - m.point[a], star[b].normal - star[a].normal) / 24;
    }
    const double area = norm(tri_normal(m.point[t[0]], m.point[t[1]], m.point[t[2]]));
    for (const int32_t v : t)
      star[v].height += area * height;
  });
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (m.boundary[t] != Boundary::surface)
      for (const int32_t v : m.tri[t])
        star[v].moves = false;
  return star;
}

} // namespace

int64_t straddle_surface(TetMesh& m) {
  std::vector<Star> star = stars(m);
  const std::vector<Vec3d> before = m.point;
  for (size_t v = 0; v < star.size(); ++v)
    if (const Star& s = star[v]; s.moves) {
      const double most = 0.1 * std::sqrt(s.shortest2);
      m.point[v] += std::clamp(s.height / s.area, -most, most) * s.normal;
    }
  const auto volume = [&](const std::vector<Vec3d>& p, const Tet& t) {
    return tet_volume(p[t[0]], p[t[1]], p[t[2]], p[t[3]]);
  };
  for (bool again = true; again;) { // points go back, at the most all of them
    again = false;
    for (const Tet& t : m.tet)
      if (volume(m.point, t) < 0.5 * volume(before, t))
        for (const int32_t v : t) {
          again |= star[v].moves;
          star[v].moves = false;
          m.point[v] = before[v];
        }
  }
  return std::count_if(star.begin(), star.end(), [](const Star& s) { return s.moves; });
}

} // namespace molmesh
