// ambiguous_cell.hpp — tells ambiguous cells and their topology under the trilinear function: asymptotic decider on
// faces, a sweep for the interior. Section 4.1 of Liao et al. 2013, their reference 51. Host and device.
#pragma once
#include "base/hd.hpp"
#include "geom/vec.hpp"
#include <array>
#include <cmath>
#include <cstdint>

namespace molmesh::contour {

/// Corner c of a cell lies here, from its lower corner.
MOLMESH_HD constexpr Vec3i corner_step(int c) {
  return {c & 1, c >> 1 & 1, c >> 2 & 1};
}

/// Corner i of face f, counter-clockwise seen from outside the cell. Faces: 0..5 = -x, +x, -y, +y, -z, +z.
/// A function: a device cannot see the table below.
MOLMESH_HD constexpr int face_corner_of(int f, int i) {
  return (f == 0   ? 0x2640
          : f == 1 ? 0x5731
          : f == 2 ? 0x4510
          : f == 3 ? 0x3762
          : f == 4 ? 0x1320
                   : 0x6754) >>
             (4 * i) &
         7;
}

/// No diagonal, or the one from the first corner of face f to its third (even), or from the second to the
/// fourth (odd).
enum class Diagonal : uint8_t { none, even, odd };

/// Corners at either end of face f's diagonal d: 0 and 2, or 1 and 3, in face order.
MOLMESH_HD constexpr std::array<int, 2> diagonal_corners(int f, Diagonal d) {
  const int first = d == Diagonal::even ? 0 : 1;
  return {face_corner_of(f, first), face_corner_of(f, first + 2)};
}

/// value[8]: corner values minus the isovalue; inside where > 0, zero counts as outside.
struct CellTopology {
  uint8_t mask = 0;                 ///< bit c: corner c is inside
  std::array<Diagonal, 6> diagonal; ///< joins the pair that the bilinear function joins on an ambiguous face
  /// The surface meets the cell's boundary in `loops` closed curves; 1: a disc, one dual vertex will do.
  int loops = 0;
  /// With two loops or more the cell is split around its centre, which takes the side that joins what the trilinear
  /// function joins. With `chop` ≥ 0 that corner (an isolated one) is cut off first.
  bool centre_inside = false;
  int chop = -1;
  MOLMESH_HD bool split() const { return loops > 1; }
};

/// A corner's value minus the isovalue, never 0: a corner at the isovalue is outside, and so counts as below it by
/// less than any other float is.
MOLMESH_HD inline double over_isovalue(float value, float isovalue) {
  constexpr double least = 1e-9; // of the isovalue, > 0; floats differ from it by 3e-8 and more
  const double over = double(value) - double(isovalue);
  return over != 0 ? over : -least * double(isovalue);
}

/// Which diagonal a face with these values (in face order, minus the isovalue) needs. The same for both its cells.
MOLMESH_HD inline Diagonal face_diagonal(double a, double b, double c, double d) {
  const bool in = a > 0;
  if ((c > 0) != in || (b > 0) == in || (d > 0) == in)
    return Diagonal::none;
  // The saddle of the bilinear function is inside exactly when the inside pair has the larger product.
  const bool even_joined = in ? a * c > b * d : !(b * d > a * c);
  return even_joined ? Diagonal::even : Diagonal::odd;
}

/// Union-find over a handful of things; the lowest member names the set.
template <int N>
struct SmallSets {
  int parent[N];
  MOLMESH_HD SmallSets() {
    for (int i = 0; i < N; ++i)
      parent[i] = i;
  }
  MOLMESH_HD int find(int i) const {
    while (parent[i] != i)
      i = parent[i];
    return i;
  }
  MOLMESH_HD void join(int a, int b) {
    a = find(a), b = find(b);
    if (a < b)
      parent[b] = a;
    if (b < a)
      parent[a] = b;
  }
};

/// Labels of the sets that the cell's boundary (edges and diagonals) joins.
MOLMESH_HD inline std::array<int, 8> boundary_components(uint8_t mask, const std::array<Diagonal, 6>& diagonal) {
  SmallSets<8> set;
  for (int a = 0; a < 8; ++a)
    for (int bit = 1; bit < 8; bit *= 2)
      if ((mask >> a & 1) == (mask >> (a ^ bit) & 1))
        set.join(a, a ^ bit);
  for (int f = 0; f < 6; ++f)
    if (diagonal[f] != Diagonal::none) {
      const auto [a, b] = diagonal_corners(f, diagonal[f]);
      set.join(a, b);
    }
  std::array<int, 8> label{};
  for (int c = 0; c < 8; ++c)
    label[c] = set.find(c);
  return label;
}

/// The boundary labels after everything on side `inside` is joined through the centre.
MOLMESH_HD inline std::array<int, 8> joined_through_centre(std::array<int, 8> label, uint8_t mask, bool inside,
                                                           int except) {
  int first = -1;
  for (int c = 0; c < 8; ++c)
    if (c != except && (mask >> c & 1) == int(inside)) {
      if (first < 0)
        first = label[c];
      label[c] = first;
    }
  return label;
}

MOLMESH_HD inline bool same_partition(const std::array<int, 8>& a, const std::array<int, 8>& b) {
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < i; ++j)
      if ((a[i] == a[j]) != (b[i] == b[j]))
        return false;
  return true;
}

/// For each corner a label: two inside (outside) corners carry the same label exactly when the inside (outside) of
/// the trilinear function joins them within the cell. Labels are corner numbers.
MOLMESH_HD_CALL inline std::array<int, 8> trilinear_components(const double value[8]) {
  // Slices of constant z carry a bilinear function of the four vertical lines. Their joins change only where a line
  // changes sign or where the saddle does: between such heights one slice speaks for all.
  double height[8] = {}; // 0, roots, 1
  int n = 1;
  const auto add = [&](double z) {
    if (!(z > 0 && z < 1) || n == 7)
      return;
    int i = n++;
    for (; height[i - 1] > z; --i)
      height[i] = height[i - 1];
    height[i] = z;
  };
  for (int line = 0; line < 4; ++line)
    if ((value[line] > 0) != (value[line + 4] > 0))
      add(value[line] / (value[line] - value[line + 4]));
  // a(z) d(z) - b(z) c(z), with a, d and b, c diagonally opposite.
  const double da = value[4] - value[0], db = value[5] - value[1], dc = value[6] - value[2],
               dd = value[7] - value[3];
  const double q2 = da * dd - db * dc;
  const double q1 = value[0] * dd + value[3] * da - value[1] * dc - value[2] * db;
  const double q0 = value[0] * value[3] - value[1] * value[2];
  const double disc = q1 * q1 - 4 * q2 * q0;
  if (disc >= 0) {
    const double q = -0.5 * (q1 + std::copysign(std::sqrt(disc), q1));
    if (q2 != 0)
      add(q / q2);
    if (q != 0)
      add(q0 / q);
  }
  height[n++] = 1;

  SmallSets<40> set; // 8 corners, then (slice, line)
  const auto line_at = [&](int line, double z) { return value[line] + z * (value[line + 4] - value[line]); };
  for (int s = 0; s + 1 < n; ++s) {
    const double z = 0.5 * (height[s] + height[s + 1]);
    const double v[4] = {line_at(0, z), line_at(1, z), line_at(2, z), line_at(3, z)};
    const auto node = [&](int line) { return 8 + 4 * s + line; };
    for (int line = 0; line < 4; ++line) // with the next, in the order 0 1 3 2
      if (const int next = line == 0 ? 1 : line == 1 ? 3 : line == 3 ? 2 : 0; (v[line] > 0) == (v[next] > 0))
        set.join(node(line), node(next));
    const Diagonal d = face_diagonal(v[0], v[1], v[3], v[2]);
    if (d == Diagonal::even)
      set.join(node(0), node(3));
    if (d == Diagonal::odd)
      set.join(node(1), node(2));
    for (int line = 0; line < 4; ++line) {
      const bool in = v[line] > 0;
      if (s == 0 && (value[line] > 0) == in)
        set.join(line, node(line));
      if (s + 2 == n && (value[line + 4] > 0) == in)
        set.join(line + 4, node(line));
      if (s > 0) {
        const double below = line_at(line, 0.5 * (height[s - 1] + height[s]));
        if ((below > 0) == in)
          set.join(node(line), node(line) - 4);
      }
    }
  }
  std::array<int, 8> label{};
  for (int c = 0; c < 8; ++c)
    label[c] = set.find(c);
  return label;
}

MOLMESH_HD_CALL inline CellTopology cell_topology(const double value[8]) {
  CellTopology t;
  for (int c = 0; c < 8; ++c)
    t.mask = static_cast<uint8_t>(t.mask | (value[c] > 0) << c);
  for (int f = 0; f < 6; ++f) {
    const auto v = [&](int i) { return value[face_corner_of(f, i)]; };
    t.diagonal[f] = face_diagonal(v(0), v(1), v(2), v(3));
  }
  if (t.mask == 0 || t.mask == 255)
    return t;
  const std::array<int, 8> boundary = boundary_components(t.mask, t.diagonal);
  for (int c = 0; c < 8; ++c)
    t.loops += boundary[c] == c;
  t.loops -= 1;
  if (!t.split())
    return t;

  // The sweep also has to see what the boundary joins: rounding must not tear it apart.
  const std::array<int, 8> wanted = trilinear_components(value);
  for (int inside = 0; inside < 2; ++inside)
    if (same_partition(joined_through_centre(boundary, t.mask, inside != 0, -1), wanted)) {
      t.centre_inside = inside != 0;
      return t;
    }
  for (int corner = 0; corner < 8; ++corner) {
    bool isolated = true;
    for (int f = 0; f < 6; ++f) {
      for (int i = 0; i < 4; ++i)
        if (face_corner_of(f, i) == corner)
          isolated &= t.diagonal[f] == (i % 2 ? Diagonal::even : Diagonal::odd);
    }
    if (!isolated)
      continue;
    for (int inside = 0; inside < 2; ++inside)
      if (same_partition(joined_through_centre(boundary, t.mask, inside != 0, corner), wanted)) {
        t.centre_inside = inside != 0;
        t.chop = corner;
        return t;
      }
  }
  // Reached only when rounding decides between equal cases: keep the components apart if one side can be joined
  // through the centre.
  int regions[2] = {0, 0};
  for (int c = 0; c < 8; ++c)
    if (boundary[c] == c)
      ++regions[t.mask >> c & 1];
  t.centre_inside = regions[1] < regions[0];
  return t;
}

/// For each corner a label, as trilinear_components: of what the mesh joins within the cell.
MOLMESH_HD_CALL inline std::array<int, 8> joined_corners(const CellTopology& t) {
  const std::array<int, 8> boundary = boundary_components(t.mask, t.diagonal);
  return t.split() ? joined_through_centre(boundary, t.mask, t.centre_inside, t.chop) : boundary;
}

} // namespace molmesh::contour
