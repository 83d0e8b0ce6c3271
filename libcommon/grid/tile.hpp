// tile.hpp — a grid cut into slabs of whole blocks across its longest axis, so that several runs can share the
// work.
#pragma once
#include "grid/block_grid.hpp"
#include <algorithm>

namespace molmesh {

/// One of `count` slabs, numbered from 1; 1 of 1 is the whole grid.
struct Tile {
  int32_t number = 1, count = 1;
  bool whole() const { return count == 1; }
  friend bool operator==(const Tile&, const Tile&) = default;
};

/// Points begin ≤ index < end along an axis, in index space; none where begin ≥ end.
struct Slab {
  int axis = 0;
  int32_t begin = 0, end = 0;
  bool contains(Vec3i p) const { return p[axis] >= begin && p[axis] < end; }
};

/// Tiles consist of layers of so many points: four blocks, a brick of the search of the band.
inline constexpr int32_t tile_layer = 32;

/// Where a tile lies. Every block of the grid is in one slab of `count`; with more tiles than layers some are
/// empty.
inline Slab slab_of(const GridFrame& frame, Tile tile) {
  Slab s;
  for (int a = 1; a < 3; ++a)
    if (frame.points[a] > frame.points[s.axis])
      s.axis = a;
  const int64_t first = block_corner(frame.lower)[s.axis],
                end = int64_t{frame.lower[s.axis]} + frame.points[s.axis],
                layers = (end - first + tile_layer - 1) / tile_layer;
  const auto from = [&](int64_t number) {
    return static_cast<int32_t>(std::min(first + layers * number / tile.count * tile_layer, end));
  };
  s.begin = from(tile.number - 1);
  s.end = from(tile.number);
  return s;
}

/// Points of the grid in a slab of it.
inline int64_t points_of(const GridFrame& frame, const Slab& slab) {
  int64_t n = 1;
  for (int a = 0; a < 3; ++a)
    n *= a != slab.axis ? frame.points[a] : std::max(0, slab.end - std::max(slab.begin, frame.lower[a]));
  return n;
}

} // namespace molmesh
