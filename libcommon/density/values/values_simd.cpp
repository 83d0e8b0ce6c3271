// values_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/values/values_simd.hpp"
#include "base/dispatch.hpp"
#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/values/values_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 16>;
using V = hn::Vec<F>;
constexpr F f{};
constexpr int32_t lanes = static_cast<int32_t>(HWY_MIN(16, HWY_LANES(float)));

struct Round {
  explicit Round(int bits)
      : half(hn::Set(i, bits > 0 ? uint32_t{1} << (bits - 1) : 0)), mask(hn::Set(i, ~uint32_t{0} << bits)) {}
  HWY_INLINE V operator()(V v) const { return hn::BitCast(f, hn::And(hn::Add(hn::BitCast(i, v), half), mask)); }
  static constexpr hn::Rebind<uint32_t, F> i{};
  const hn::Vec<hn::Rebind<uint32_t, F>> half, mask;
};

void round_values_simd(float* v, int bits) {
  const Round round(bits);
  for (int32_t s = 0; s < 512; s += lanes)
    hn::StoreU(round(hn::LoadU(f, v + s)), f, v + s);
}

/// Bit l of the result: lane l.
HWY_INLINE uint64_t bits_of(hn::Mask<F> m) {
#if HWY_TARGET <= HWY_AVX3
  return m.raw;
#elif HWY_TARGET <= HWY_AVX2
  return static_cast<uint32_t>(_mm256_movemask_ps(m.raw));
#else
  uint8_t bits[8] = {};
  hn::StoreMaskBits(f, m, bits);
  uint64_t word;
  std::memcpy(&word, bits, 8);
  return word;
#endif
}

void classify_points_simd(float* v, int bits, Limits near, Limits far, SideWords near_words, SideWords far_words) {
  const Round round(bits);
  const V lower = hn::Set(f, near.lower), upper = hn::Set(f, near.upper), far_lower = hn::Set(f, far.lower),
          far_upper = hn::Set(f, far.upper);
  for (int32_t w = 0; w < 8; ++w) {
    uint64_t below = 0, above = 0, far_below = 0, far_above = 0;
    for (int32_t s = 0; s < 64; s += lanes) {
      const V x = round(hn::LoadU(f, v + 64 * w + s));
      hn::StoreU(x, f, v + 64 * w + s);
      below |= bits_of(hn::Lt(x, lower)) << s;
      above |= bits_of(hn::Gt(x, upper)) << s;
      far_below |= bits_of(hn::Lt(x, far_lower)) << s;
      far_above |= bits_of(hn::Gt(x, far_upper)) << s;
    }
    near_words.below[w] = below;
    near_words.above[w] = above;
    far_words.below[w] = far_below;
    far_words.above[w] = far_above;
  }
}

int32_t pack_active_simd(const float* v, const uint64_t* active, float* out) {
  float* const begin = out;
#if HWY_TARGET <= HWY_AVX2
  uint8_t bits[64 + 8] = {}; // LoadMaskBits may read eight bytes
  std::memcpy(bits, active, 64);
  for (int32_t s = 0; s < 512; s += lanes) {
    const auto keep = hn::LoadMaskBits(f, bits + s / 8);
    hn::StoreU(hn::Compress(hn::LoadU(f, v + s), keep), f, out);
    out += hn::CountTrue(f, keep);
  }
#else
  for (int32_t s = 0; s < 512; ++s)
    if (active[s >> 6] >> (s & 63) & 1)
      *out++ = v[s];
#endif
  return static_cast<int32_t>(out - begin);
}

int32_t pack_part_simd(const float* packed, const uint64_t* stored, const uint64_t* active, float* out) {
  float* const begin = out;
  for (int32_t w = 0; w < 8; ++w) {
    const uint64_t all = stored[w], kept = active[w];
#if HWY_TARGET <= HWY_AVX2
    const auto count = static_cast<size_t>(std::popcount(all));
    uint64_t keep = _pext_u64(kept, all);
    for (size_t i = 0; i < count; i += lanes, keep >>= lanes) {
      uint8_t bits[8]; // LoadMaskBits may read eight bytes
      std::memcpy(bits, &keep, 8);
      const auto mask = hn::LoadMaskBits(f, bits);
      // Not a compressing store: on Zen 4 one takes a hundred cycles and more.
      hn::StoreU(hn::Compress(hn::LoadU(f, packed + i), mask), f, out);
      out += hn::CountTrue(f, mask);
    }
    packed += count;
#else
    for (uint64_t left = all; left; left &= left - 1, ++packed)
      if (kept & left & -left)
        *out++ = *packed;
#endif
  }
  return static_cast<int32_t>(out - begin);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::density {

HWY_EXPORT(round_values_simd);
HWY_EXPORT(classify_points_simd);
HWY_EXPORT(pack_active_simd);
HWY_EXPORT(pack_part_simd);

void round_values(float* v, int bits) {
  MOLMESH_DISPATCH(round_values_simd)(v, bits);
}
void classify_points(float* v, int bits, Limits near, Limits far, SideWords near_words, SideWords far_words) {
  MOLMESH_DISPATCH(classify_points_simd)(v, bits, near, far, near_words, far_words);
}
int32_t pack_active(const float* v, const uint64_t* active, float* out) {
  return MOLMESH_DISPATCH(pack_active_simd)(v, active, out);
}
int32_t pack_part(const float* packed, const uint64_t* stored, const uint64_t* active, float* out) {
  return MOLMESH_DISPATCH(pack_part_simd)(packed, stored, active, out);
}

} // namespace molmesh::density
#endif
