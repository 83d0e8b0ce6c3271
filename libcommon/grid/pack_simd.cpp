// pack_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "grid/pack_simd.hpp"
#include "base/dispatch.hpp"
#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "grid/pack_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace molmesh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
#if HWY_TARGET <= HWY_AVX2
using F = hn::CappedTag<float, 16>;
constexpr F f{};
constexpr int32_t lanes = static_cast<int32_t>(HWY_MIN(16, HWY_LANES(float)));
#endif

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
} // namespace molmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh {

HWY_EXPORT(pack_active_simd);
HWY_EXPORT(pack_part_simd);

int32_t pack_active(const float* v, const uint64_t* active, float* out) {
  return MOLMESH_DISPATCH(pack_active_simd)(v, active, out);
}
int32_t pack_part(const float* packed, const uint64_t* stored, const uint64_t* active, float* out) {
  return MOLMESH_DISPATCH(pack_part_simd)(packed, stored, active, out);
}

} // namespace molmesh
#endif
