// point_sets_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/band/point_sets_simd.hpp"
#include "base/dispatch.hpp"
#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/band/point_sets_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

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

void words_from_rows_simd(const BrickBits& rows, BrickWords& words) {
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

void rows_from_words_simd(const BrickWords& words, BrickBits& rows) {
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

/// Here, since the machine's instruction for it is one of the set's.
int64_t count_points_simd(const BrickWords& words) {
  int64_t n = 0;
  for (const auto& block : words.word)
    for (const uint64_t word : block)
      n += std::popcount(word);
  return n;
}

using U = hn::CappedTag<uint64_t, 8>;
constexpr U u{};
constexpr size_t lanes = HWY_MIN(8, HWY_LANES(uint64_t));

/// Bit b: part(b, i), of words i and after of block b, is not zero somewhere.
template <class Part>
HWY_INLINE uint64_t blocks_where(Part&& part) {
  uint64_t blocks = 0;
  for (size_t b = 0; b < blocks_a_brick; ++b) {
    auto all = hn::Zero(u);
    for (size_t i = 0; i < 8; i += lanes)
      all = hn::Or(all, part(b, i));
    blocks |= uint64_t{!hn::AllTrue(u, hn::Eq(all, hn::Zero(u)))} << b;
  }
  return blocks;
}

uint64_t blocks_of_simd(const BrickWords& set) {
  return blocks_where([&](size_t b, size_t i) { return hn::LoadU(u, set.word[b] + i); });
}

uint64_t blocks_of_rest_simd(const BrickWords& set, const BrickWords& other) {
  return blocks_where([&](size_t b, size_t i) {
    return hn::AndNot(hn::LoadU(u, other.word[b] + i), hn::LoadU(u, set.word[b] + i));
  });
}

uint64_t blocks_of_inner_simd(const BrickWords& set) {
  // What is left of the words of a row of blocks along x: without the first, all, all, without the last.
  alignas(64) static constexpr uint64_t all = ~uint64_t{0},
                                        along_x[4][8] = {{0, all, all, all, all, all, all, all},
                                                         {all, all, all, all, all, all, all, all},
                                                         {all, all, all, all, all, all, all, all},
                                                         {all, all, all, all, all, all, all, 0}};
  static constexpr uint64_t along_y[4] = {all << 8, all, all, all >> 8},
                            along_z[4] = {all / 255 * 254, all, all, all / 255 * 127};
  return blocks_where([&](size_t b, size_t i) {
    const auto inner = hn::Set(u, along_y[b >> 2 & 3] & along_z[b & 3]);
    return hn::And(hn::And(hn::Load(u, along_x[b >> 4] + i), inner), hn::LoadU(u, set.word[b] + i));
  });
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
HWY_EXPORT(blocks_of_simd);
HWY_EXPORT(blocks_of_rest_simd);
HWY_EXPORT(blocks_of_inner_simd);

void rows_from_words(const BrickWords& words, BrickBits& rows) {
  MOLMESH_DISPATCH(rows_from_words_simd)(words, rows);
}
void words_from_rows(const BrickBits& rows, BrickWords& words) {
  MOLMESH_DISPATCH(words_from_rows_simd)(rows, words);
}
int64_t count_points(const BrickWords& words) {
  return MOLMESH_DISPATCH(count_points_simd)(words);
}
uint64_t blocks_of(const BrickWords& set) {
  return MOLMESH_DISPATCH(blocks_of_simd)(set);
}
uint64_t blocks_of_rest(const BrickWords& set, const BrickWords& other) {
  return MOLMESH_DISPATCH(blocks_of_rest_simd)(set, other);
}
uint64_t blocks_of_inner(const BrickWords& set) {
  return MOLMESH_DISPATCH(blocks_of_inner_simd)(set);
}
void faced_from_words(const BrickWords& words, FacedBits& to) {
  rows_from_words(words, to);
  // The lowest bits of a word's bytes.
  const auto column = [](uint64_t v) { return (v & ~uint64_t{0} / 255) * 0x0102040810204080 >> 56; };
  for (int x = 0; x < brick_edge; ++x) {
    uint64_t low = 0, high = 0;
    for (int by = 0; by < brick_blocks; ++by) {
      const uint64_t(*const row)[8] = &words.word[16 * (x >> 3) + 4 * by];
      low |= column(row[0][x & 7]) << 8 * by;
      high |= column(row[brick_blocks - 1][x & 7] >> 7) << 8 * by;
    }
    to.z_face[0][x] = static_cast<uint32_t>(low);
    to.z_face[1][x] = static_cast<uint32_t>(high);
    to.y_face[0][x] = to.row[x][0];
    to.y_face[1][x] = to.row[x][brick_edge - 1];
  }
}

} // namespace molmesh::density
#endif
