// draft.cpp — finds the corners of band cells by bit masks, block by block.
#include "compose/draft.hpp"
#include "par/pages.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <bit>

namespace molmesh::compose {
namespace {

/// 8³ points: bit 8·j + k of word i.
using Mask = std::array<uint64_t, 8>;
struct Sides {
  Mask below, above; ///< of the band
};
constexpr Sides all_sides(bool above) {
  Sides s{};
  for (size_t i = 0; i < 8; ++i)
    (above ? s.above : s.below)[i] = ~uint64_t{0};
  return s;
}
constexpr Sides all_below = all_sides(false), all_above = all_sides(true);

/// The points -1 … 8 of a block along z as bits 0 … 9, for x and y from -1 to 8.
using Rows = std::array<std::array<uint32_t, 10>, 10>;

uint32_t row(const Mask& m, int i, int j) {
  return m[static_cast<size_t>(i)] >> 8 * j & 0xff;
}

/// around[9·a + 3·b + c]: the blocks at -1, 0, +1 along x, y, z.
void gather(const Sides* const* around, Mask Sides::*mask, Rows& out) {
  for (int x = -1; x <= 8; ++x)
    for (int y = -1; y <= 8; ++y) {
      const int a = x < 0 ? 0 : x < 8 ? 1 : 2, b = y < 0 ? 0 : y < 8 ? 1 : 2;
      const Sides* const* const line = around + 9 * a + 3 * b;
      const auto at = [&](int c) { return row(line[c]->*mask, x & 7, y & 7); };
      out[x + 1][y + 1] = at(0) >> 7 | at(1) << 1 | (at(2) & 1) << 9;
    }
}

/// Cells -1 … 7 along an axis that lie between the walls, as bits 0 … 8.
uint32_t cells_within(int32_t corner, int32_t lower, int32_t points) {
  uint32_t bits = 0;
  for (int c = 0; c < 9; ++c)
    if (const int64_t p = int64_t{corner} + c - 1; p >= lower && p + 1 < int64_t{lower} + points)
      bits |= 1u << c;
  return bits;
}

/// The corners of band cells among a block's points.
Mask band_corners(const Sides* const* around, Vec3i corner, const GridFrame& f) {
  Rows below, above;
  gather(around, &Sides::below, below);
  gather(around, &Sides::above, above);
  const uint32_t in_x = cells_within(corner.x, f.lower.x, f.points.x),
                 in_y = cells_within(corner.y, f.lower.y, f.points.y),
                 in_z = cells_within(corner.z, f.lower.z, f.points.z);
  std::array<std::array<uint32_t, 9>, 9> cell;
  for (size_t x = 0; x < 9; ++x)
    for (size_t y = 0; y < 9; ++y) {
      const auto all = [&](const Rows& r) {
        const uint32_t m = r[x][y] & r[x][y + 1] & r[x + 1][y] & r[x + 1][y + 1];
        return m & m >> 1;
      };
      cell[x][y] = in_x >> x & in_y >> y & 1 ? ~(all(below) | all(above)) & in_z : 0;
    }
  Mask active{};
  for (size_t x = 0; x < 8; ++x)
    for (size_t y = 0; y < 8; ++y) {
      const uint32_t r = cell[x][y] | cell[x][y + 1] | cell[x + 1][y] | cell[x + 1][y + 1];
      active[x] |= uint64_t{(r | r >> 1) & 0xff} << 8 * y; // point k has the cells k - 1 and k, bits k and k + 1
    }
  return active;
}

Sides sides_of(const float* value, const FieldInfo& info) {
  Sides s{};
  for (size_t i = 0; i < 512; ++i) {
    s.below[i >> 6] |= uint64_t{value[i] < info.band_lower} << (i & 63);
    s.above[i >> 6] |= uint64_t{value[i] > info.band_upper} << (i & 63);
  }
  return s;
}

} // namespace

BlockGrid finish(Draft d, int threads, int64_t& unknown) {
  const auto n = static_cast<int64_t>(d.corner.size());
  const auto inside_value = static_cast<float>(d.info.inside_value);
  BlockGrid g;
  g.frame = d.frame;
  g.info = d.info;
  g.corner = std::move(d.corner);
  g.inside = std::move(d.inside);
  const BlockIndex index(g);
  std::vector<Sides> sides(static_cast<size_t>(n));
  par::for_n(n, threads, 64, [&](int64_t b) {
    sides[b] = sides_of(&d.value[512 * b], d.info);
    if (d.info.inside_value <= d.info.band_upper) // it marks a side, and is no value
      for (size_t s = 0; s < 512; ++s)
        if (!(d.known[8 * b + (s >> 6)] >> (s & 63) & 1) && d.value[512 * b + static_cast<int64_t>(s)] != 0)
          sides[b].above[s >> 6] |= uint64_t{1} << (s & 63);
  });
  par::resize_pages(g.active, static_cast<size_t>(8 * n), threads);
  std::vector<int64_t> missing(static_cast<size_t>(n));
  par::for_n(n, threads, 64, [&](int64_t b) {
    const Sides* around[27];
    for (int k = 0; k < 27; ++k) {
      const int64_t at = k == 13 ? b : index.find(g.corner[b] + 8 * Vec3i{k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1});
      around[k] = at >= 0 ? &sides[at] : at == BlockIndex::inside ? &all_above : &all_below;
    }
    const Mask active = band_corners(around, g.corner[b], g.frame);
    float* const value = &d.value[512 * b];
    for (size_t s = 0; s < 512; ++s)
      if (!(active[s >> 6] >> (s & 63) & 1))
        value[s] = value[s] > d.info.isovalue ? inside_value : 0;
    for (size_t w = 0; w < 8; ++w) {
      g.active[8 * b + static_cast<int64_t>(w)] = active[w];
      missing[b] += std::popcount(active[w] & ~d.known[8 * b + static_cast<int64_t>(w)]);
    }
  });
  unknown = 0;
  int64_t kept = 0;
  const size_t before = g.inside.size();
  for (int64_t b = 0; b < n; ++b) {
    unknown += missing[b];
    const uint64_t* const word = &g.active[8 * b];
    if (std::all_of(word, word + 8, [](uint64_t w) { return w == 0; })) {
      if (d.value[512 * b] != 0)
        g.inside.push_back(g.corner[b]);
      continue;
    }
    if (kept != b) {
      g.corner[kept] = g.corner[b];
      std::copy_n(word, 8, &g.active[8 * kept]);
      std::copy_n(&d.value[512 * b], 512, &d.value[512 * kept]);
    }
    ++kept;
  }
  std::inplace_merge(g.inside.begin(), g.inside.begin() + static_cast<std::ptrdiff_t>(before), g.inside.end());
  g.corner.resize(static_cast<size_t>(kept));
  g.active.resize(static_cast<size_t>(8 * kept));
  d.value.resize(static_cast<size_t>(512 * kept));
  g.value = std::move(d.value);
  return g;
}

} // namespace molmesh::compose
