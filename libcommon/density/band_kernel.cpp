// band_kernel.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/band_kernel.hpp"
#include <algorithm>
#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/band_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using U = hn::CappedTag<uint64_t, 8>;
constexpr U u{};
constexpr int32_t lanes = static_cast<int32_t>(HWY_MIN(8, HWY_LANES(uint64_t))), vectors = 40 / lanes;

// Eight rows of 32 points are eight words of four bytes, or four blocks of eight bytes: a transposition.
#if HWY_TARGET != HWY_SCALAR
/// 4 × 4 bytes transposed.
HWY_INLINE hn::Vec<hn::Full128<uint32_t>> transposed(const void* from) {
  constexpr hn::Full128<uint8_t> b8{};
  alignas(16) static constexpr uint8_t order[16] = {0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15};
  return hn::BitCast(hn::Full128<uint32_t>(),
                     hn::TableLookupBytes(hn::LoadU(b8, static_cast<const uint8_t*>(from)), hn::Load(b8, order)));
}
#endif

void words_from_rows_simd(const NodeBits& rows, NodeWords& words) {
  for (size_t x = 0; x < 32; ++x)
    for (size_t by = 0; by < 4; ++by) {
      const uint32_t* const row = &rows.row[x][8 * by];
      uint64_t word[4];
#if HWY_TARGET != HWY_SCALAR
      constexpr hn::Full128<uint32_t> d{};
      const auto lo = transposed(row), hi = transposed(row + 4);
      hn::StoreU(hn::InterleaveLower(d, lo, hi), d, reinterpret_cast<uint32_t*>(word));
      hn::StoreU(hn::InterleaveUpper(d, lo, hi), d, reinterpret_cast<uint32_t*>(word + 2));
#else
      for (size_t bz = 0; bz < 4; ++bz) {
        word[bz] = 0;
        for (size_t j = 0; j < 8; ++j)
          word[bz] |= uint64_t{row[j] >> 8 * bz & 255} << 8 * j;
      }
#endif
      for (size_t bz = 0; bz < 4; ++bz)
        words.word[16 * (x >> 3) + 4 * by + bz][x & 7] = word[bz];
    }
}

/// Here, since the machine's instruction for it is one of the set's.
int64_t count_points_simd(const NodeWords& words) {
  int64_t n = 0;
  for (const auto& block : words.word)
    for (const uint64_t word : block)
      n += std::popcount(word);
  return n;
}

void rows_from_words_simd(const NodeWords& words, NodeBits& rows) {
  for (size_t x = 0; x < 32; ++x)
    for (size_t by = 0; by < 4; ++by) {
      uint32_t* const row = &rows.row[x][8 * by];
      uint64_t word[4];
      for (size_t bz = 0; bz < 4; ++bz)
        word[bz] = words.word[16 * (x >> 3) + 4 * by + bz][x & 7];
#if HWY_TARGET != HWY_SCALAR
      constexpr hn::Full128<uint32_t> d{};
      const auto a = hn::LoadU(d, reinterpret_cast<const uint32_t*>(word)),
                 b = hn::LoadU(d, reinterpret_cast<const uint32_t*>(word + 2));
      uint32_t half[8]; // rows 0 to 3 of the four blocks, then rows 4 to 7
      hn::StoreU(hn::ConcatEven(d, b, a), d, half);
      hn::StoreU(hn::ConcatOdd(d, b, a), d, half + 4);
      hn::StoreU(transposed(half), d, row);
      hn::StoreU(transposed(half + 4), d, row + 4);
#else
      for (size_t j = 0; j < 8; ++j) {
        row[j] = 0;
        for (size_t bz = 0; bz < 4; ++bz)
          row[j] |= static_cast<uint32_t>(word[bz] >> 8 * j & 255) << 8 * bz;
      }
#endif
    }
}

/// An x-plane of the 34³ points around a node: bit k + 1 of row j + 1 is point (j, k); room for one more vector.
struct Plane {
  HWY_ALIGN uint64_t row[48];
};

/// nodes[9]: the 3 × 3 nodes that the plane passes, by (y, z).
HWY_INLINE void make_plane(const FacedBits* const* nodes, int32_t x, Plane& p) {
  const auto edge = [&](int32_t dy) {
    const auto row = [&](int32_t n) { return uint64_t{nodes[3 * dy + n]->y_face[dy == 0][x]}; };
    return row(1) << 1 | row(0) >> 31 | (row(2) & 1) << 33;
  };
  constexpr hn::Rebind<uint32_t, U> half{};
  alignas(64) static constexpr uint64_t bit[8] = {1, 2, 4, 8, 16, 32, 64, 128};
  const auto rows = hn::Load(u, bit);
  for (int32_t y = 0; y < 32; y += lanes) {
    const auto at = [&](uint32_t column, uint64_t to) {
      return hn::IfThenElseZero(hn::TestBit(hn::Set(u, column >> y), rows), hn::Set(u, to));
    };
    const auto mid = hn::ShiftLeft<1>(hn::PromoteTo(u, hn::LoadU(half, &nodes[4]->row[x][y])));
    hn::StoreU(hn::Or(mid, hn::Or(at(nodes[3]->z_face[1][x], 1), at(nodes[5]->z_face[0][x], uint64_t{1} << 33))), u,
               p.row + 1 + y);
  }
  p.row[0] = edge(0);
  p.row[33] = edge(2);
}

/// The same without the nodes around: what lies beyond the node's own points is what `beyond` has at the nearest of
/// them.
HWY_INLINE void make_plane_alone(const NodeBits& node, const NodeBits& beyond, int32_t x, Plane& p) {
  const auto edge = [](uint64_t row) { return row << 1 | (row & 1) | row >> 31 << 33; };
  const bool inner = x >= 0 && x < node_edge;
  const int32_t nearest = std::clamp(x, 0, node_edge - 1);
  const uint32_t *const own = inner ? node.row[x] : beyond.row[nearest], *const outer = beyond.row[nearest];
  constexpr hn::Rebind<uint32_t, U> half{};
  for (int32_t y = 0; y < 32; y += lanes) {
    const auto mid = hn::PromoteTo(u, hn::LoadU(half, own + y)), far = hn::PromoteTo(u, hn::LoadU(half, outer + y));
    const auto lo = hn::And(far, hn::Set(u, uint64_t{1})), hi = hn::ShiftLeft<33>(hn::ShiftRight<31>(far));
    hn::StoreU(hn::Or(hn::ShiftLeft<1>(mid), hn::Or(lo, hi)), u, p.row + 1 + y);
  }
  p.row[0] = edge(outer[0]);
  p.row[33] = edge(outer[31]);
}

using Planes = Plane[34];

/// Loop by loop over all planes: a load that takes parts of two vectors stored a moment ago would have to wait for
/// both. plane(x, below, p): plane x = -1 … 32 of the points below or above the band.
template <class MakePlane>
HWY_INLINE void corners_of_band_cells(MakePlane&& plane, const CellRange& cells, NodeBits& active) {
  const auto in = [&](int axis, int32_t cell) { return cell >= cells.first[axis] && cell < cells.end[axis]; };
  uint64_t z_valid = 0;
  for (int32_t k = 0; k < 33; ++k)
    z_valid |= uint64_t{in(2, k - 1)} << k;
  HWY_ALIGN uint64_t valid[40] = {};
  for (int32_t j = 0; j < 33; ++j)
    valid[j] = in(1, j - 1) ? z_valid : 0;
  Planes set[2], cell;
  for (int32_t x = -1; x <= 32; ++x)
    for (const bool below : {false, true}) {
      Plane& p = set[below][x + 1];
      std::fill_n(p.row + 34, 14, uint64_t{0});
      plane(x, below, p);
    }
  // Where the four corners of a cell that lie in a plane are in the set.
  for (Planes& planes : set)
    for (Plane& p : planes) {
      hn::Vec<U> four[vectors];
      for (int32_t v = 0; v < vectors; ++v) {
        const auto near = hn::LoadU(u, p.row + lanes * v), far = hn::LoadU(u, p.row + lanes * v + 1);
        const auto both = hn::And(near, far);
        four[v] = hn::And(both, hn::ShiftRight<1>(both));
      }
      for (int32_t v = 0; v < vectors; ++v)
        hn::StoreU(four[v], u, p.row + lanes * v);
    }
  // Cells between a plane and the next, and the points of a row along z that they touch.
  for (int32_t i = 0; i < 33; ++i)
    for (int32_t j = 0; j < 40; j += lanes) {
      const auto both = [&](const Planes& planes) {
        return hn::And(hn::Load(u, planes[i].row + j), hn::Load(u, planes[i + 1].row + j));
      };
      const auto c =
          in(0, i - 1) ? hn::AndNot(hn::Or(both(set[0]), both(set[1])), hn::Load(u, valid + j)) : hn::Zero(u);
      hn::Store(hn::Or(c, hn::ShiftRight<1>(c)), u, cell[i].row + j);
    }
  for (int32_t x = 0; x < 32; ++x)
    for (int32_t j = 0; j < 32; j += lanes) {
      const auto rows = [&](int32_t i) {
        return hn::Or(hn::Load(u, cell[i].row + j), hn::LoadU(u, cell[i].row + j + 1));
      };
      hn::StoreU(hn::TruncateTo(hn::Rebind<uint32_t, U>(), hn::Or(rows(x), rows(x + 1))), hn::Rebind<uint32_t, U>(),
                 &active.row[x][j]);
    }
}

void band_points_simd(const FacedBits* const* below, const FacedBits* const* above, const CellRange& cells,
                      NodeBits& active) {
  corners_of_band_cells(
      [&](int32_t x, bool lower, Plane& p) {
        make_plane((lower ? below : above) + (x < 0 ? 0 : x < 32 ? 9 : 18), x & 31, p);
      },
      cells, active);
}

void likely_band_points_simd(const Sides& sides, const Sides& beyond, const CellRange& cells, NodeBits& active) {
  corners_of_band_cells(
      [&](int32_t x, bool lower, Plane& p) {
        make_plane_alone(lower ? sides.below : sides.above, lower ? beyond.below : beyond.above, x, p);
      },
      cells, active);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::density {

HWY_EXPORT(rows_from_words_simd);
HWY_EXPORT(words_from_rows_simd);
HWY_EXPORT(count_points_simd);
HWY_EXPORT(band_points_simd);
HWY_EXPORT(likely_band_points_simd);

void rows_from_words(const NodeWords& words, NodeBits& rows) {
  HWY_DYNAMIC_DISPATCH(rows_from_words_simd)(words, rows);
}
void words_from_rows(const NodeBits& rows, NodeWords& words) {
  HWY_DYNAMIC_DISPATCH(words_from_rows_simd)(rows, words);
}
int64_t count_points(const NodeWords& words) {
  return HWY_DYNAMIC_DISPATCH(count_points_simd)(words);
}
void faced_from_words(const NodeWords& words, FacedBits& to) {
  rows_from_words(words, to);
  // The lowest bits of a word's bytes.
  const auto column = [](uint64_t v) { return (v & ~uint64_t{0} / 255) * 0x0102040810204080 >> 56; };
  for (int x = 0; x < node_edge; ++x) {
    uint64_t low = 0, high = 0;
    for (int by = 0; by < node_blocks; ++by) {
      const uint64_t(*const row)[8] = &words.word[16 * (x >> 3) + 4 * by];
      low |= column(row[0][x & 7]) << 8 * by;
      high |= column(row[node_blocks - 1][x & 7] >> 7) << 8 * by;
    }
    to.z_face[0][x] = static_cast<uint32_t>(low);
    to.z_face[1][x] = static_cast<uint32_t>(high);
    to.y_face[0][x] = to.row[x][0];
    to.y_face[1][x] = to.row[x][node_edge - 1];
  }
}
void band_points(const FacedBits* const* below, const FacedBits* const* above, const CellRange& cells,
                 NodeBits& active) {
  HWY_DYNAMIC_DISPATCH(band_points_simd)(below, above, cells, active);
}
void likely_band_points(const Sides& sides, const Sides& beyond, const CellRange& cells, NodeBits& active) {
  HWY_DYNAMIC_DISPATCH(likely_band_points_simd)(sides, beyond, cells, active);
}

} // namespace molmesh::density
#endif
