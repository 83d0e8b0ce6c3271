// classify_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/values/classify_simd.hpp"
#include "base/dispatch.hpp"
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/values/classify_simd.cpp"
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

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::density {

HWY_EXPORT(round_values_simd);
HWY_EXPORT(classify_points_simd);

void round_values(float* v, int bits) {
  MOLMESH_DISPATCH(round_values_simd)(v, bits);
}
void classify_points(float* v, int bits, Limits near, Limits far, SideWords near_words, SideWords far_words) {
  MOLMESH_DISPATCH(classify_points_simd)(v, bits, near, far, near_words, far_words);
}

} // namespace molmesh::density
#endif
