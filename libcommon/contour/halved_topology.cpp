// halved_topology.cpp — the parts of each cell and face, joined through smaller ones.
#include "contour/halved_topology.hpp"
#include "contour/cube.hpp"
#include "contour/detail/node_items.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace molmesh::contour {
namespace {

using Corners = std::array<double, 8>; ///< values minus the isovalue, never 0

/// A cell's corners and the points between them, x + 3 y + 9 z.
struct Halves {
  std::array<double, 27> value; ///< as Corners

  /// Of corner c of child `octant`; of the cell's own corner c: at(c, c).
  static int at(int octant, int c) {
    const Vec3i p = corner_step(octant) + corner_step(c);
    return p.x + 3 * p.y + 9 * p.z;
  }
  Corners child(int octant) const {
    Corners v;
    for (int c = 0; c < 8; ++c)
      v[static_cast<size_t>(c)] = value[static_cast<size_t>(at(octant, c))];
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
void join_cell(detail::SmallSets<N>& sets, const Corners& v, Point&& point) {
  const std::array<int, 8> label = joined_corners(cell_topology(v.data()));
  for (int c = 0; c < 8; ++c)
    sets.join(point(c), point(label[static_cast<size_t>(c)]));
}

/// The same on its face f.
template <int N, class Point>
void join_face(detail::SmallSets<N>& sets, const Corners& v, int f, Point&& point) {
  const auto corner = [&](int i) { return face_corner_of(f, i & 3); };
  const auto at = [&](int i) { return v[static_cast<size_t>(corner(i))]; };
  for (int i = 0; i < 4; ++i)
    if ((at(i) > 0) == (at(i + 1) > 0))
      sets.join(point(corner(i)), point(corner(i + 1)));
  if (const Diagonal d = face_diagonal(at(0), at(1), at(2), at(3)); d != Diagonal::none) {
    const auto [a, b] = diagonal_corners(f, d);
    sets.join(point(a), point(b));
  }
}

/// Whether the cell's sets part its corners `whole` as the halves' do, and these have a corner each, of those that
/// take part.
template <class Takes>
bool same_parts(const detail::SmallSets<8>& whole, const detail::SmallSets<27>& halves, Takes&& takes) {
  std::array<bool, 27> has_corner{};
  for (int c = 0; c < 8; ++c) {
    if (!takes(Halves::at(c, c)))
      continue;
    const int part = halves.find(Halves::at(c, c));
    has_corner[static_cast<size_t>(part)] = true;
    for (int d = 0; d < c; ++d)
      if (takes(Halves::at(d, d)) && (whole.find(c) == whole.find(d)) != (part == halves.find(Halves::at(d, d))))
        return false;
  }
  for (int p = 0; p < 27; ++p)
    if (takes(p) && !has_corner[static_cast<size_t>(halves.find(p))])
      return false;
  return true;
}

bool same_in_cell(const Corners& v, const Halves& halves) {
  detail::SmallSets<8> whole;
  detail::SmallSets<27> fine;
  join_cell(whole, v, [](int c) { return c; });
  for (int o = 0; o < 8; ++o)
    join_cell(fine, halves.child(o), [&](int c) { return Halves::at(o, c); });
  return same_parts(whole, fine, [](int) { return true; });
}

bool same_on_face(const Corners& v, const Halves& halves, int f) {
  detail::SmallSets<8> whole;
  detail::SmallSets<27> fine;
  join_face(whole, v, f, [](int c) { return c; });
  for (int i = 0; i < 4; ++i) {
    const int o = face_corner_of(f, i);
    join_face(fine, halves.child(o), f, [&](int c) { return Halves::at(o, c); });
  }
  const int step = f / 2 == 0 ? 1 : f / 2 == 1 ? 3 : 9;
  return same_parts(whole, fine, [&](int p) { return p / step % 3 == (f % 2 ? 2 : 0); });
}

/// A disc through plain cells is one whatever is interpolated between points.
bool plain(const Corners& v, const Halves& halves) {
  static constexpr detail::OneDisc one_disc;
  if (!one_disc(inside_of(v)))
    return false;
  for (int o = 0; o < 8; ++o)
    if (const uint32_t inside = inside_of(halves.child(o)); inside != 0 && inside != 0xFF && !one_disc(inside))
      return false;
  return true;
}

} // namespace

bool halving_keeps_topology(const BlockGrid& grid, const BlockGrid& half, int threads) {
  const BlockIndex index(grid), half_index(half);
  const auto iso = static_cast<float>(grid.info.isovalue);
  const auto keeps = [&](Vec3i p) {
    Corners v;
    for (int c = 0; c < 8; ++c)
      v[static_cast<size_t>(c)] = over_isovalue(value_at(grid, index, p + corner_step(c)), iso);
    if (const uint32_t inside = inside_of(v); inside == 0 || inside == 0xFF)
      return true;
    Halves halves;
    for (int q = 0; q < 27; ++q)
      halves.value[static_cast<size_t>(q)] =
          over_isovalue(value_at(half, half_index, 2 * p + Vec3i{q % 3, q / 3 % 3, q / 9}), iso);
    if (plain(v, halves))
      return true;
    for (int f = 0; f < 6; ++f)
      if (!same_on_face(v, halves, f))
        return false;
    return same_in_cell(v, halves);
  };
  // The lowest corner of a cell that the surface crosses is active (I2): its block is one of these.
  return par::reduce(
      static_cast<int64_t>(grid.corner.size()), threads, true,
      [&](int64_t b) {
        Vec3i step;
        for (step.x = 0; step.x < 8; ++step.x)
          for (step.y = 0; step.y < 8; ++step.y)
            for (step.z = 0; step.z < 8; ++step.z)
              if (!keeps(grid.corner[static_cast<size_t>(b)] + step))
                return false;
        return true;
      },
      [](bool a, bool b) { return a && b; }, 4);
}

} // namespace molmesh::contour
