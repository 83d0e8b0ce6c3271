// active_set_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/band/active_set_simd.hpp"
#include "base/dispatch.hpp"
#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/band/active_set_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using R = hn::CappedTag<uint32_t, 16>;
constexpr R r{};
constexpr int32_t lanes = static_cast<int32_t>(HWY_MIN(16, HWY_LANES(uint32_t))),
                  rows = (33 + lanes - 1) / lanes * lanes; ///< of cells, with room

/// Lane l: `value` where bit l of `bits` is set, else 0.
HWY_INLINE hn::Vec<R> lanes_of_bits(uint64_t bits, uint32_t value) {
  alignas(64) static constexpr uint32_t bit[16] = {1,   2,   4,    8,    16,   32,   64,    128,
                                                   256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
  const auto set = hn::TestBit(hn::Set(r, static_cast<uint32_t>(bits)), hn::Load(r, bit));
  return hn::IfThenElseZero(set, hn::Set(r, value));
}

/// Bit y: whether row y of 32 holds the point `z`, 0 or 31.
template <int z>
HWY_INLINE uint64_t column(const uint32_t* row) {
  uint64_t all = 0;
  for (int32_t y = 0; y < 32; y += lanes) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(r, hn::TestBit(hn::LoadU(r, row + y), hn::Set(r, uint32_t{1} << z)), bits);
    uint64_t word;
    std::memcpy(&word, bits, 8);
    all |= word << y;
  }
  return all;
}

/// An x-plane of the 34³ points around a brick: bit z of row y + 1; those before, at and behind the first and the
/// last z as columns, bit y + 1. Then, from the same places, corners of a cell that lie in the plane: all four of
/// rows y, y + 1 and columns z, z + 1 in `row` and `before`, the two with the higher z in `behind`.
struct Plane {
  HWY_ALIGN uint32_t row[64];
  uint64_t before, first, behind;
};

/// A column of 32 points with one more at either end.
HWY_INLINE uint64_t column_of(uint64_t low, uint64_t mid, uint64_t high) {
  return low | mid << 1 | high << 33;
}

/// bricks[9]: the 3 × 3 bricks that the plane passes, by (y, z).
HWY_INLINE void make_plane(const FacedBits* const* bricks, int32_t x, Plane& p) {
  const auto y_edge = [&](int n) { return bricks[n]->y_face[n < 3][x]; };
  std::memcpy(p.row + 1, bricks[4]->row[x], sizeof bricks[4]->row[x]);
  p.row[0] = y_edge(1);
  p.row[33] = y_edge(7);
  p.before = column_of(y_edge(0) >> 31, bricks[3]->z_face[1][x], y_edge(6) >> 31);
  p.first = column_of(y_edge(1) & 1, bricks[4]->z_face[0][x], y_edge(7) & 1);
  p.behind = column_of(y_edge(2) & 1, bricks[5]->z_face[0][x], y_edge(8) & 1);
}

/// The same without the bricks around: what lies beyond the brick's own points is what `beyond` has at the nearest
/// of them.
HWY_INLINE void make_plane_alone(const FacedBits& brick, const BrickBits& beyond, int32_t x, Plane& p) {
  const bool inner = x >= 0 && x < brick_edge;
  const int32_t nearest = std::clamp(x, 0, brick_edge - 1);
  const uint32_t *const own = inner ? brick.row[x] : beyond.row[nearest], *const outer = beyond.row[nearest];
  std::memcpy(p.row + 1, own, sizeof brick.row[0]);
  p.row[0] = outer[0];
  p.row[33] = outer[31];
  const uint64_t low = column<0>(outer), high = column<31>(outer);
  p.before = column_of(low & 1, low, low >> 31);
  p.first = inner ? column_of(low & 1, brick.z_face[0][x], low >> 31) : p.before;
  p.behind = column_of(high & 1, high, high >> 31);
}

using Planes = Plane[34];

/// Loop by loop over all planes: a load that takes parts of two vectors stored a moment ago would have to wait for
/// both. plane(x, below, p): plane x = -1 … 32 of the points below or above the band.
template <class MakePlane>
HWY_INLINE void corners_of_band_cells(MakePlane&& plane, const CellRange& cells, BrickBits& active) {
  const auto in = [&](int axis, int32_t cell) { return cell >= cells.first[axis] && cell < cells.end[axis]; };
  uint32_t z_valid = 0;
  for (int32_t k = 0; k < 32; ++k)
    z_valid |= uint32_t{in(2, k)} << k;
  HWY_ALIGN uint32_t valid[rows] = {};
  uint64_t valid_before = 0;
  for (int32_t j = 0; j < 33; ++j) {
    valid[j] = in(1, j - 1) ? z_valid : 0;
    valid_before |= uint64_t{in(1, j - 1) && in(2, -1)} << j;
  }
  Planes set[2];
  for (int32_t x = -1; x <= 32; ++x)
    for (const bool below : {false, true}) {
      Plane& p = set[below][x + 1];
      std::fill_n(p.row + 34, 64 - 34, uint32_t{0});
      plane(x, below, p);
    }
  for (Planes& planes : set)
    for (Plane& p : planes) {
      p.before &= p.first;
      p.before &= p.before >> 1;
      p.behind &= p.behind >> 1;
      hn::Vec<R> four[rows / lanes];
      for (int32_t j = 0; j < rows; j += lanes) {
        const auto both = hn::And(hn::LoadU(r, p.row + j), hn::LoadU(r, p.row + j + 1));
        four[j / lanes] =
            hn::And(both, hn::Or(hn::ShiftRight<1>(both), lanes_of_bits(p.behind >> j, uint32_t{1} << 31)));
      }
      for (int32_t j = 0; j < rows; j += lanes)
        hn::StoreU(four[j / lanes], r, p.row + j);
    }
  // Cells between a plane and the next, and the points of a row along z that they touch.
  HWY_ALIGN uint32_t cell[33][rows];
  uint64_t before[33];
  for (int32_t i = 0; i < 33; ++i) {
    const auto outside = [&](uint64_t from) { return in(0, i - 1) ? from : 0; };
    before[i] = outside(valid_before & ~(set[0][i].before & set[0][i + 1].before) &
                        ~(set[1][i].before & set[1][i + 1].before));
    const auto layer = hn::Set(r, static_cast<uint32_t>(outside(~uint32_t{0})));
    for (int32_t j = 0; j < rows; j += lanes) {
      const auto both = [&](const Planes& planes) {
        return hn::And(hn::Load(r, planes[i].row + j), hn::Load(r, planes[i + 1].row + j));
      };
      const auto c = hn::AndNot(hn::Or(both(set[0]), both(set[1])), hn::And(hn::Load(r, valid + j), layer));
      hn::Store(hn::Or(c, hn::ShiftLeft<1>(c)), r, cell[i] + j);
    }
  }
  for (int32_t x = 0; x < 32; ++x) {
    uint64_t first = before[x] | before[x + 1];
    first |= first >> 1;
    for (int32_t j = 0; j < 32; j += lanes) {
      const auto touched = [&](int32_t i) {
        return hn::Or(hn::Load(r, cell[i] + j), hn::LoadU(r, cell[i] + j + 1));
      };
      hn::StoreU(hn::Or(hn::Or(touched(x), touched(x + 1)), lanes_of_bits(first >> j, 1)), r, &active.row[x][j]);
    }
  }
}

void band_points_simd(const FacedBits* const* below, const FacedBits* const* above, const CellRange& cells,
                      BrickBits& active) {
  corners_of_band_cells(
      [&](int32_t x, bool lower, Plane& p) {
        make_plane((lower ? below : above) + (x < 0 ? 0 : x < 32 ? 9 : 18), x & 31, p);
      },
      cells, active);
}

void likely_band_points_simd(const Sides& sides, const Sides& beyond, const CellRange& cells, BrickBits& active) {
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

HWY_EXPORT(band_points_simd);
HWY_EXPORT(likely_band_points_simd);

void band_points(const FacedBits* const* below, const FacedBits* const* above, const CellRange& cells,
                 BrickBits& active) {
  MOLMESH_DISPATCH(band_points_simd)(below, above, cells, active);
}
void likely_band_points(const Sides& sides, const Sides& beyond, const CellRange& cells, BrickBits& active) {
  MOLMESH_DISPATCH(likely_band_points_simd)(sides, beyond, cells, active);
}

} // namespace molmesh::density
#endif
