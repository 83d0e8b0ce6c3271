// cube.cpp — asymptotic decider on faces, a sweep for the interior.
#include "contour/cube.hpp"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace molmesh::contour {
namespace {

/// Union-find over a handful of things; the lowest member names the set.
template <int N>
struct SmallSets {
  std::array<int, N> parent;
  SmallSets() { std::iota(parent.begin(), parent.end(), 0); }
  int find(int i) const {
    while (parent[i] != i)
      i = parent[i];
    return i;
  }
  void join(int a, int b) {
    a = find(a), b = find(b);
    if (a < b)
      parent[b] = a;
    if (b < a)
      parent[a] = b;
  }
};

/// Labels of the sets that the cell's boundary (edges and diagonals) joins.
std::array<int, 8> boundary_components(uint8_t mask, const std::array<Diagonal, 6>& diagonal) {
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
  std::array<int, 8> label;
  for (int c = 0; c < 8; ++c)
    label[c] = set.find(c);
  return label;
}

/// The boundary labels after everything on side `inside` is joined through the centre.
std::array<int, 8> joined_through_centre(std::array<int, 8> label, uint8_t mask, bool inside, int except) {
  int first = -1;
  for (int c = 0; c < 8; ++c)
    if (c != except && (mask >> c & 1) == int(inside)) {
      if (first < 0)
        first = label[c];
      label[c] = first;
    }
  return label;
}

bool same_partition(const std::array<int, 8>& a, const std::array<int, 8>& b) {
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < i; ++j)
      if ((a[i] == a[j]) != (b[i] == b[j]))
        return false;
  return true;
}

} // namespace

std::array<int, 8> trilinear_components(const double value[8]) {
  // Slices of constant z carry a bilinear function of the four vertical lines. Their joins change only where a line
  // changes sign or where the saddle does: between such heights one slice speaks for all.
  std::array<double, 8> height{}; // 0, roots, 1
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
    for (auto [a, b] : {std::array{0, 1}, {1, 3}, {3, 2}, {2, 0}})
      if ((v[a] > 0) == (v[b] > 0))
        set.join(node(a), node(b));
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
  std::array<int, 8> label;
  for (int c = 0; c < 8; ++c)
    label[c] = set.find(c);
  return label;
}

CellTopology cell_topology(const double value[8]) {
  CellTopology t;
  for (int c = 0; c < 8; ++c)
    t.mask = static_cast<uint8_t>(t.mask | (value[c] > 0) << c);
  for (int f = 0; f < 6; ++f) {
    const int* c = face_corner[f];
    t.diagonal[f] = face_diagonal(value[c[0]], value[c[1]], value[c[2]], value[c[3]]);
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
  for (bool inside : {false, true})
    if (same_partition(joined_through_centre(boundary, t.mask, inside, -1), wanted)) {
      t.centre_inside = inside;
      return t;
    }
  for (int corner = 0; corner < 8; ++corner) {
    bool isolated = true;
    for (int f = 0; f < 6; ++f) {
      const int* c = face_corner[f];
      for (int i = 0; i < 4; ++i)
        if (c[i] == corner)
          isolated &= t.diagonal[f] == (i % 2 ? Diagonal::even : Diagonal::odd);
    }
    if (!isolated)
      continue;
    for (bool inside : {false, true})
      if (same_partition(joined_through_centre(boundary, t.mask, inside, corner), wanted)) {
        t.centre_inside = inside;
        t.chop = corner;
        return t;
      }
  }
  // Reached only when rounding decides between equal cases: keep the sheets apart if one side has a hub.
  int regions[2] = {0, 0};
  for (int c = 0; c < 8; ++c)
    if (boundary[c] == c)
      ++regions[t.mask >> c & 1];
  t.centre_inside = regions[1] < regions[0];
  return t;
}

} // namespace molmesh::contour
