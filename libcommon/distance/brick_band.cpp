// brick_band.cpp — sides of points as bits of rows along z, 64 at once; a brick needs no other brick's result.
#include "distance/brick_band.hpp"
#include "distance/distance.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace molmesh::distance {

float Scale::value(double distance) const {
  // Beyond what any band holds; the limits keep a float from being 0 or infinite.
  const double exponent = std::clamp((distance - offset) / length, -80.0, 80.0);
  const auto exact = static_cast<float>(std::exp(exponent));
  if (dropped_bits == 0)
    return exact;
  const uint32_t half = uint32_t{1} << (dropped_bits - 1), bits = std::bit_cast<uint32_t>(exact);
  return std::bit_cast<float>((bits + half) & (~uint32_t{0} << dropped_bits));
}

void BrickBand::fill(const PointCube& cube, Vec3i first, Side side) {
  const int32_t begin = cube.lo.z - first.z + 1, n = cube.hi.z - cube.lo.z;
  const uint64_t all = ((uint64_t{1} << n) - 1) << begin;
  const double* d = distances_.value();
  for (int32_t x = cube.lo.x; x < cube.hi.x; ++x)
    for (int32_t y = cube.lo.y; y < cube.hi.y; ++y) {
      uint64_t &below = below_[size_t(x - first.x + 1)][size_t(y - first.y + 1)],
               &above = above_[size_t(x - first.x + 1)][size_t(y - first.y + 1)];
      if (side != Side::mixed) {
        (side == Side::inside ? above : below) |= all;
        continue;
      }
      for (int32_t z = cube.lo.z; z < cube.hi.z; ++z, ++d) {
        below |= uint64_t{*d < scale_.lower} << (z - first.z + 1);
        above |= uint64_t{*d > scale_.upper} << (z - first.z + 1);
        const Vec3i p = Vec3i{x, y, z} - first;
        if ((p.x | p.y | p.z) >= 0 && p.x < edge && p.y < edge && p.z < edge)
          distance_[size_t(16 * (p.x >> 3) + 4 * (p.y >> 3) + (p.z >> 3))][size_t(slot(p))] = *d;
      }
    }
}

void BrickBand::find_sides(const NearBrick& brick) {
  below_ = above_ = {};
  const Vec3i first = 8 * brick.corner;
  // The layer around the brick belongs to the cubes next to it.
  const auto cube_at = [&](Vec3i at, int32_t blocks) {
    PointCube cube{first + 8 * at, first + 8 * (at + blocks * Vec3i{1, 1, 1})};
    for (int a = 0; a < 3; ++a) {
      cube.lo[a] -= at[a] == 0;
      cube.hi[a] += at[a] + blocks == density::brick_blocks;
    }
    return cube;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const Vec3i part = 2 * Vec3i{octant >> 2, octant >> 1 & 1, octant & 1};
    distances_.narrow(brick.near, cube_at(part, 2), near_);
    for (int i = 0; i < 8; ++i) {
      const Vec3i at = part + Vec3i{i >> 2, i >> 1 & 1, i & 1};
      const PointCube cube = cube_at(at, 1);
      const Side side = distances_.find(cube, near_);
      ++cubes;
      if (side == Side::mixed) {
        ++mixed_cubes;
        points += density::in_grid(frame_, brick.corner + at) ? frame_.points_of_block(8 * (brick.corner + at)) : 0;
      }
      fill(cube, first, side);
    }
  }
}

/// Corners of band cells of the grid. False when there are none.
bool BrickBand::find_active(Vec3i first) {
  const Vec3i begin = frame_.lower - first + Vec3i{1, 1, 1},
              end = begin + frame_.points - Vec3i{1, 1, 1}; // of cells
  const auto cut = [](int32_t v) { return std::clamp(v, 0, wide - 1); };
  uint64_t in_grid = 0;
  for (int32_t z = cut(begin.z); z < cut(end.z); ++z)
    in_grid |= uint64_t{1} << z;
  active_ = {};
  bool any = false;
  for (int32_t x = cut(begin.x); x < cut(end.x); ++x)
    for (int32_t y = cut(begin.y); y < cut(end.y); ++y) {
      const auto of_cells = [x, y](const Rows& r) {
        const size_t i = size_t(x), j = size_t(y);
        const uint64_t columns = r[i][j] & r[i][j + 1] & r[i + 1][j] & r[i + 1][j + 1];
        return columns & columns >> 1;
      };
      const uint64_t cells = ~(of_cells(below_) | of_cells(above_)) & in_grid, corners = cells | cells << 1;
      any = any || cells;
      for (const size_t i : {size_t(x), size_t(x) + 1})
        for (const size_t j : {size_t(y), size_t(y) + 1})
          active_[i][j] |= corners;
    }
  return any;
}

void BrickBand::find(const NearBrick& brick, par::Arena<float>& memory, std::vector<BandBlock>& band,
                     std::vector<Vec3i>& inside) {
  const Vec3i first = 8 * brick.corner;
  find_sides(brick);
  const bool any = find_active(first);
  for (int b = 0; b < density::blocks_a_brick; ++b) {
    const Vec3i at = Vec3i{b >> 4, b >> 2 & 3, b & 3};
    if (!density::in_grid(frame_, brick.corner + at))
      continue;
    BandBlock block{first + 8 * at, {}, {}, {}, nullptr};
    const auto words_of = [&](const Rows& rows, Mask& to) {
      for (int32_t x = 0; x < 8; ++x)
        for (int32_t y = 0; y < 8; ++y)
          to[size_t(x)] |= (rows[size_t(8 * at.x + x + 1)][size_t(8 * at.y + y + 1)] >> (8 * at.z + 1) & 0xff)
                           << 8 * y;
    };
    if (any)
      words_of(active_, block.active);
    words_of(above_, block.above);
    int count = 0;
    for (const uint64_t word : block.active)
      count += std::popcount(word);
    if (count == 0) {
      if (block.above[0] & 1)
        inside.push_back(block.corner);
      continue;
    }
    active_points += count;
    float* const values = memory.take(512 + 16);
    float* next = values;
    for (size_t s = 0; s < 512; ++s)
      if (block.active[s >> 6] >> (s & 63) & 1)
        *next++ = scale_.value(distance_[size_t(b)][s]);
    memory.keep(static_cast<size_t>(count));
    block.stored = block.active;
    block.value = values;
    band.push_back(block);
  }
}

} // namespace molmesh::distance
