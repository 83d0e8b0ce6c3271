// intersect.hpp — tells exactly whether two triangles of a mesh meet elsewhere than in their common corners and
// edges.
#pragma once
#include "geom/predicates.hpp"
#include <array>
#include <cstdint>

namespace molmesh {

/// Sign of the turn a → b → c, coordinate `axis` left out. Exact.
MOLMESH_HD inline int orient2d(Vec3d a, Vec3d b, Vec3d c, int axis) {
  Vec3d above = a; // off the plane: a tetrahedron over the projected triangle
  a[axis] = b[axis] = c[axis] = 0;
  above[axis] = 1;
  return orient3d(a, b, c, above);
}

/// Segments p q and a b, end points included, in the plane without `axis`.
MOLMESH_HD inline bool segments_meet(Vec3d p, Vec3d q, Vec3d a, Vec3d b, int axis) {
  const int pa = orient2d(p, q, a, axis), pb = orient2d(p, q, b, axis);
  const int ap = orient2d(a, b, p, axis), aq = orient2d(a, b, q, axis);
  if (pa * pb > 0 || ap * aq > 0)
    return false;
  if (pa != 0 || pb != 0)
    return true;
  for (int k = 0; k < 3; ++k) { // on one line
    if (k == axis)
      continue;
    if ((p[k] < a[k] && p[k] < b[k] && q[k] < a[k] && q[k] < b[k]) ||
        (p[k] > a[k] && p[k] > b[k] && q[k] > a[k] && q[k] > b[k]))
      return false;
  }
  return true;
}

/// Closed segment p q and closed triangle a b c.
MOLMESH_HD inline bool segment_meets_triangle(Vec3d p, Vec3d q, Vec3d a, Vec3d b, Vec3d c) {
  const int sp = orient3d(a, b, c, p), sq = orient3d(a, b, c, q);
  if (sp * sq > 0)
    return false;
  if (sp != 0 || sq != 0) {
    const int x = orient3d(p, q, a, b), y = orient3d(p, q, b, c), z = orient3d(p, q, c, a);
    return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
  }
  int axis = 0, turn = 0; // all in one plane
  while (axis < 3 && (turn = orient2d(a, b, c, axis)) == 0)
    ++axis;
  if (turn == 0)
    return false; // no triangle
  if (segments_meet(p, q, a, b, axis) || segments_meet(p, q, b, c, axis) || segments_meet(p, q, c, a, axis))
    return true;
  return orient2d(a, b, p, axis) == turn && orient2d(b, c, p, axis) == turn && orient2d(c, a, p, axis) == turn;
}

/// Triangles s and t by indices of their corners: true when they have a point in common that is neither a common
/// corner nor on a common edge. Triangles on the same three points do not count.
template <class Points>
bool triangles_cross(const Points& point, std::array<int32_t, 3> s, std::array<int32_t, 3> t) {
  const auto at = [&](int32_t v) -> Vec3d { return point[v]; };
  const auto has = [](const std::array<int32_t, 3>& x, int32_t v) { return x[0] == v || x[1] == v || x[2] == v; };
  int common = 0;
  for (int32_t v : s)
    common += has(t, v);
  if (common == 3)
    return false;
  const auto turn_to = [&](std::array<int32_t, 3>& x, const std::array<int32_t, 3>& other, bool shared) {
    while (has(other, x[0]) != shared)
      x = {x[1], x[2], x[0]};
  };
  if (common == 2) { // an edge: they cross when one lies folded on the other
    turn_to(s, t, false);
    turn_to(t, s, false);
    const Vec3d a = at(s[0]), u = at(s[1]), v = at(s[2]), b = at(t[0]);
    if (orient3d(u, v, a, b) != 0)
      return false;
    for (int axis = 0; axis < 3; ++axis)
      if (const int side = orient2d(u, v, a, axis); side != 0)
        return orient2d(u, v, b, axis) == side;
    return false;
  }
  const auto edge_meets = [&](const std::array<int32_t, 3>& x, std::size_t i, const std::array<int32_t, 3>& y) {
    return segment_meets_triangle(at(x[i]), at(x[(i + 1) % 3]), at(y[0]), at(y[1]), at(y[2]));
  };
  if (common == 1) { // a corner: the edges across from it
    turn_to(s, t, true);
    turn_to(t, s, true);
    return edge_meets(s, 1, t) || edge_meets(t, 1, s);
  }
  for (std::size_t i = 0; i < 3; ++i)
    if (edge_meets(s, i, t) || edge_meets(t, i, s))
      return true;
  return false;
}

} // namespace molmesh
