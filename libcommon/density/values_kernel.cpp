// values_kernel.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/values_kernel.hpp"
#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/values_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 16>;
constexpr F f{};
constexpr int32_t lanes = static_cast<int32_t>(HWY_MIN(16, HWY_LANES(float)));

void round_values_simd(float* v, int bits) {
  const hn::Rebind<uint32_t, F> i;
  const auto half = hn::Set(i, uint32_t{1} << (bits - 1)), mask = hn::Set(i, ~uint32_t{0} << bits);
  for (int32_t s = 0; s < 512; s += lanes)
    hn::StoreU(hn::BitCast(f, hn::And(hn::Add(hn::BitCast(i, hn::LoadU(f, v + s)), half), mask)), f, v + s);
}

void classify_points_simd(const float* v, float lower, float upper, uint64_t* below, uint64_t* above) {
#if HWY_TARGET <= HWY_AVX2
  using V = hn::Vec<F>;
  uint8_t b[64 + 8], a[64 + 8];
  for (int32_t s = 0; s < 512; s += lanes) {
    const V x = hn::LoadU(f, v + s);
    hn::StoreMaskBits(f, hn::Lt(x, hn::Set(f, lower)), b + s / 8);
    hn::StoreMaskBits(f, hn::Gt(x, hn::Set(f, upper)), a + s / 8);
  }
  std::memcpy(below, b, 64);
  std::memcpy(above, a, 64);
#else
  for (int32_t w = 0; w < 8; ++w) {
    below[w] = above[w] = 0;
    for (int32_t s = 0; s < 64; ++s) {
      below[w] |= uint64_t{v[64 * w + s] < lower} << s;
      above[w] |= uint64_t{v[64 * w + s] > upper} << s;
    }
  }
#endif
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

int32_t keep_active_simd(float* v, const uint64_t* stored, const uint64_t* active) {
  float *const begin = v, *out = v;
  for (int32_t w = 0; w < 8; ++w) {
    const uint64_t all = stored[w], kept = active[w];
    const auto count = static_cast<size_t>(std::popcount(all));
    if (all == kept) {
      if (out != v)
        std::memmove(out, v, count * sizeof(float));
      v += count;
      out += count;
      continue;
    }
#if HWY_TARGET <= HWY_AVX2
    uint64_t keep = _pext_u64(kept, all);
    for (size_t i = 0; i < count; i += lanes, keep = lanes < 64 ? keep >> lanes : 0) {
      uint8_t bits[8]; // LoadMaskBits may read eight bytes
      std::memcpy(bits, &keep, 8);
      const auto mask = hn::And(hn::LoadMaskBits(f, bits), hn::FirstN(f, count - i));
      hn::CompressBlendedStore(hn::LoadU(f, v + i), mask, f, out);
      out += hn::CountTrue(f, mask);
    }
    v += count;
#else
    for (uint64_t left = all; left; left &= left - 1, ++v) {
      *out = *v;
      out += (kept & left & -left) != 0;
    }
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
HWY_EXPORT(keep_active_simd);

void round_values(float* v, int bits) {
  HWY_DYNAMIC_DISPATCH(round_values_simd)(v, bits);
}
void classify_points(const float* v, float lower, float upper, uint64_t* below, uint64_t* above) {
  HWY_DYNAMIC_DISPATCH(classify_points_simd)(v, lower, upper, below, above);
}
int32_t pack_active(const float* v, const uint64_t* active, float* out) {
  return HWY_DYNAMIC_DISPATCH(pack_active_simd)(v, active, out);
}
int32_t keep_active(float* v, const uint64_t* stored, const uint64_t* active) {
  return HWY_DYNAMIC_DISPATCH(keep_active_simd)(v, stored, active);
}

} // namespace molmesh::density
#endif
