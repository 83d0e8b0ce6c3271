// halved_topology.cpp — compares the topology of the isosurface in a cell with that in its eight halves.
#include "contour/octree/error_function.hpp"
#include "contour/small_bodies/halved_grid.hpp"
#include "contour/surface/ambiguous_cell.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace molmesh::contour {
namespace {

using Corners = std::array<double, 8>; ///< values minus the isovalue, never 0

/// A cell's corners and the points between them, x + 3 y + 9 z.
struct Halves {
  std::array<double, 27> value; ///< as Corners

  static Vec3i step(int point) { return {point % 3, point / 3 % 3, point / 9}; } ///< from the lowest corner
  /// Of corner c of child `octant`; of the cell's own corner c: at(c, c).
  static int at(int octant, int c) {
    const Vec3i p = corner_step(octant) + corner_step(c);
    return p.x + 3 * p.y + 9 * p.z;
  }
  Corners child(int octant) const {
    Corners v;
    for (int c = 0; c < 8; ++c)
      v[c] = value[at(octant, c)];
    return v;
  }
};

uint32_t inside_of(const Corners& v) {
  uint32_t inside = 0;
  for (size_t c = 0; c < 8; ++c)
    inside |= uint32_t{v[c] > 0} << c;
  return inside;
}

/// Joins what the mesh joins within a cell. point: number of corner c.
template <int N, class Point>
void join_cell(SmallSets<N>& sets, const Corners& v, Point&& point) {
  const std::array<int, 8> label = joined_corners(cell_topology(v.data()));
  for (int c = 0; c < 8; ++c)
    sets.join(point(c), point(label[c]));
}

/// The same on its face f.
template <int N, class Point>
void join_face(SmallSets<N>& sets, const Corners& v, int f, Point&& point) {
  const auto corner = [&](int i) { return face_corner_of(f, i & 3); };
  const auto at = [&](int i) { return v[corner(i)]; };
  for (int i = 0; i < 4; ++i)
    if ((at(i) > 0) == (at(i + 1) > 0))
      sets.join(point(corner(i)), point(corner(i + 1)));
  if (const Diagonal d = face_diagonal(at(0), at(1), at(2), at(3)); d != Diagonal::none) {
    const auto [a, b] = diagonal_corners(f, d);
    sets.join(point(a), point(b));
  }
}

/// Parts of what is inside on its face f.
int face_parts(const Corners& v, int f) {
  const auto at = [&](int i) { return v[face_corner_of(f, i)]; };
  if (!(at(0) > 0 || at(1) > 0 || at(2) > 0 || at(3) > 0))
    return 0;
  const Diagonal d = face_diagonal(at(0), at(1), at(2), at(3));
  return d != Diagonal::none && !(v[diagonal_corners(f, d)[0]] > 0) ? 2 : 1;
}

/// Of the points that count: whether the cell's sets and the halves' tell the same corners from each other, and
/// each set of the halves has a corner of the cell.
template <class Takes>
bool same_parts(const SmallSets<8>& whole, const SmallSets<27>& halves, Takes&& takes) {
  std::array<bool, 27> has_corner{};
  for (int c = 0; c < 8; ++c) {
    if (!takes(Halves::at(c, c)))
      continue;
    const int part = halves.find(Halves::at(c, c));
    has_corner[part] = true;
    for (int d = 0; d < c; ++d)
      if (takes(Halves::at(d, d)) && (whole.find(c) == whole.find(d)) != (part == halves.find(Halves::at(d, d))))
        return false;
  }
  for (int p = 0; p < 27; ++p)
    if (takes(p) && !has_corner[halves.find(p)])
      return false;
  return true;
}

/// Euler number of what is inside in the cell: its components, less the tunnels that the outside makes through
/// them.
int inside_euler(const Corners& v) {
  const CellTopology t = cell_topology(v.data());
  const std::array<int, 8> on_boundary = boundary_components(t.mask, t.diagonal), within = joined_corners(t);
  int chi = 0;
  for (int c = 0; c < 8; ++c) {
    const bool part = within[c] == c;
    chi += v[c] > 0 ? part : part - (on_boundary[c] == c);
  }
  return chi;
}

/// The same through the halves: of these, less that of what two share, and so on.
int inside_euler(const Halves& halves) {
  constexpr int middle = 13, steps[3] = {1, 3, 9};
  const auto inside = [&](int p) { return halves.value[p] > 0; };
  int chi = -int(inside(middle));
  for (int o = 0; o < 8; ++o)
    chi += inside_euler(halves.child(o));
  for (int a = 0; a < 3; ++a) {
    for (int side : {-1, 1})
      chi += inside(middle) || inside(middle + side * steps[a]);
    for (int o = 0; o < 8; ++o)
      if (!(o >> a & 1))
        chi -= face_parts(halves.child(o), 2 * a + 1);
  }
  return chi;
}

bool same_in_cell(const Corners& v, const Halves& halves) {
  if (inside_euler(v) != inside_euler(halves))
    return false;
  SmallSets<8> whole;
  SmallSets<27> fine;
  join_cell(whole, v, [](int c) { return c; });
  for (int o = 0; o < 8; ++o)
    join_cell(fine, halves.child(o), [&](int c) { return Halves::at(o, c); });
  return same_parts(whole, fine, [](int) { return true; });
}

bool same_on_face(const Corners& v, const Halves& halves, int f) {
  SmallSets<8> whole;
  SmallSets<27> fine;
  join_face(whole, v, f, [](int c) { return c; });
  for (int i = 0; i < 4; ++i) {
    const int o = face_corner_of(f, i);
    join_face(fine, halves.child(o), f, [&](int c) { return Halves::at(o, c); });
  }
  return same_parts(whole, fine, [&](int p) { return Halves::step(p)[f / 2] == (f % 2 ? 2 : 0); });
}

/// A disc through plain cells, as octree nodes are merged.
bool plain(const Corners& v, const Halves& halves) {
  static constexpr OneDisc one_disc;
  if (!one_disc(inside_of(v)))
    return false;
  for (int o = 0; o < 8; ++o)
    if (const uint32_t inside = inside_of(halves.child(o)); inside != 0 && inside != 0xFF && !one_disc(inside))
      return false;
  uint32_t inside = 0;
  for (size_t p = 0; p < halves.value.size(); ++p)
    inside |= uint32_t{halves.value[p] > 0} << p;
  return middles_agree(inside);
}

bool same_topology(const Corners& v, const Halves& halves) {
  if (plain(v, halves))
    return true;
  for (int f = 0; f < 6; ++f)
    if (!same_on_face(v, halves, f))
      return false;
  return same_in_cell(v, halves);
}

} // namespace

std::vector<Vec3i> cells_of_other_topology(const BlockGrid& grid, const BlockGrid& half, int threads) {
  const BlockIndex index(grid), half_index(half);
  const auto iso = static_cast<float>(grid.info.isovalue);
  const auto is_other = [&](Vec3i p) {
    Corners v;
    for (int c = 0; c < 8; ++c)
      v[c] = over_isovalue(value_at(grid, index, p + corner_step(c)), iso);
    if (const uint32_t inside = inside_of(v); inside == 0 || inside == 0xFF)
      return false;
    Halves halves;
    for (int q = 0; q < 27; ++q)
      halves.value[q] = over_isovalue(value_at(half, half_index, 2 * p + Halves::step(q)), iso);
    return !same_topology(v, halves);
  };
  // The lowest corner of a cell that the surface crosses is active (I2): its block is one of these.
  std::vector<std::vector<Vec3i>> of_block(grid.corner.size());
  par::for_n(static_cast<int64_t>(of_block.size()), threads, 4, [&](int64_t b) {
    for (int s = 0; s < 512; ++s)
      if (const Vec3i p = grid.corner[b] + within_block(s); is_other(p))
        of_block[b].push_back(p);
  });
  std::vector<Vec3i> all;
  for (const std::vector<Vec3i>& cells : of_block)
    all.insert(all.end(), cells.begin(), cells.end());
  std::sort(all.begin(), all.end());
  return all;
}

std::optional<BlockGrid> halved_alike(const BlockGrid& grid, int threads) {
  std::vector<Vec3i> linear;
  while (true) {
    BlockGrid half = halved(grid, threads, linear);
    const std::vector<Vec3i> others = cells_of_other_topology(grid, half, threads);
    if (others.empty())
      return half;
    const size_t before = linear.size();
    for (const Vec3i& p : others)
      for (int q = 0; q < 27; ++q)
        linear.push_back(2 * p + Halves::step(q));
    std::sort(linear.begin(), linear.end());
    linear.erase(std::unique(linear.begin(), linear.end()), linear.end());
    if (linear.size() == before)
      return {};
  }
}

} // namespace molmesh::contour
