// simd_math-inl.hpp — powers and logarithms to base 2 in single precision, for the kernels. Included once per
// instruction set by Highway's foreach_target.
#if defined(MOLMESH_DENSITY_SIMD_MATH) == defined(HWY_TARGET_TOGGLE)
#ifdef MOLMESH_DENSITY_SIMD_MATH
#undef MOLMESH_DENSITY_SIMD_MATH
#else
#define MOLMESH_DENSITY_SIMD_MATH
#endif
#include <cstdint>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 16>;
using I = hn::RebindToSigned<F>;
using V = hn::Vec<F>;
constexpr F f{};
constexpr int32_t lanes = static_cast<int32_t>(HWY_MIN(16, HWY_LANES(float)));

template <class D, size_t N>
HWY_INLINE hn::Vec<D> polynomial(D d, hn::Vec<D> x, const float (&c)[N]) {
  auto p = hn::Set(d, c[N - 1]);
  for (size_t i = N - 1; i-- > 0;)
    p = hn::MulAdd(p, x, hn::Set(d, c[i]));
  return p;
}

/// Chebyshev interpolant of 2^x on [-1/2, 1/2]: 1.0e-7. x at most 127; below -126 it counts as -126.
template <class D>
HWY_INLINE hn::Vec<D> exp2(D d, hn::Vec<D> x) {
  constexpr float c[] = {1.00000007545f, 0.69314718803f, 0.24022107485f,
                         0.05550357114f, 0.00967603192f, 0.00133908634f};
  x = hn::Max(x, hn::Set(d, -126.0f));
#if HWY_TARGET <= HWY_AVX3
  if constexpr (hn::MaxLanes(D()) == 16) {
    const auto whole = _mm512_roundscale_ps(x.raw, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
    return hn::Vec<D>{_mm512_scalef_ps(polynomial(d, hn::Sub(x, hn::Vec<D>{whole}), c).raw, whole)};
  }
#endif
  const hn::RebindToSigned<D> i;
  const auto big = hn::Set(d, 12582912.0f), shifted = hn::Add(x, big); // 1.5·2^23: the sum's low bits are x rounded
  const auto t = hn::Sub(x, hn::Sub(shifted, big));
  return hn::BitCast(d, hn::Add(hn::BitCast(i, polynomial(d, t, c)), hn::ShiftLeft<23>(hn::BitCast(i, shifted))));
}
HWY_INLINE V exp2(V x) {
  return exp2(f, x);
}

/// Between 2^x and 1.062·2^x, the chord from one whole power to the next, but for 2e-4 of it by rounding. x at most
/// 127; below -126 it counts as -126.
HWY_INLINE V exp2_above(V x) {
  constexpr float big = 6144.0f; // 1.5·2^12: the sum's low bits are x in units of 2^-11
  const V shifted = hn::Add(hn::Max(x, hn::Set(f, -126.0f)), hn::Set(f, big));
  constexpr uint32_t bias = (127u << 23) - (0x45c00000u << 12);
  return hn::BitCast(
      f, hn::Add(hn::ShiftLeft<12>(hn::BitCast(I(), shifted)), hn::Set(I(), static_cast<int32_t>(bias))));
}

/// x normal and positive. Chebyshev interpolant of log2(1 + t)/t on [√½ - 1, √2 - 1]: 1.9e-7.
HWY_INLINE V log2(V x) {
  constexpr float c[] = {1.44269499f, -0.72135293f, 0.48091671f, -0.36022518f,
                         0.28728888f, -0.24927182f, 0.23265258f, -0.14275973f};
  const auto bits = hn::BitCast(I(), x);
  const auto n = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(I(), 0x3f3504f3)));
  const V t = hn::Sub(hn::BitCast(f, hn::Sub(bits, hn::ShiftLeft<23>(n))), hn::Set(f, 1.0f));
  return hn::MulAdd(t, polynomial(f, t, c), hn::ConvertTo(f, n));
}

/// use(a) for the first of every `lanes` atoms in the slots of clusters.
template <class Use>
HWY_INLINE void for_atoms(const int32_t* cluster, int32_t clusters, Use&& use) {
  for (int32_t c = 0; c < clusters; ++c)
    for (size_t a = 16 * static_cast<size_t>(cluster[c]), end = a + 16; a < end; a += lanes)
      use(a);
}

HWY_INLINE V twice_square_root(V x) { // one Newton step on the machine's estimate: 3e-7
  const V r = hn::ApproximateReciprocalSqrt(x), xr = hn::Mul(x, r);
  return hn::Mul(xr, hn::NegMulAdd(xr, r, hn::Set(f, 3.0f)));
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();
#endif
