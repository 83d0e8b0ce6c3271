// simd_math-inl.hpp — powers and logarithms to base 2 and square roots, in single and double precision, for the
// kernels. Included once per instruction set by Highway's foreach_target.
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
/// Vectors of at most 64 bytes.
template <class T>
using Tag = hn::CappedTag<T, 64 / sizeof(T)>;
template <class T>
constexpr int32_t lanes_of = static_cast<int32_t>(HWY_MIN(64 / sizeof(T), HWY_LANES(T)));
using F = Tag<float>;
using I = hn::RebindToSigned<F>;
using V = hn::Vec<F>;
constexpr F f{};
constexpr int32_t lanes = lanes_of<float>;

/// Of IEEE 754, and Chebyshev interpolants of 2^x on [-1/2, 1/2] (1.0e-7; 1.1e-12) and of log2(1 + t)/t on
/// [√½ - 1, √2 - 1] (1.9e-7; 4.8e-13).
template <class T>
struct Format;
template <>
struct Format<float> {
  static constexpr int digits = 23;
  static constexpr float least = -126, big = 12582912.0f; // 1.5·2^23: the low bits of a sum with it are x rounded
  static constexpr int32_t root_half = 0x3f3504f3;
  static constexpr float power[] = {1.00000007545f, 0.69314718803f, 0.24022107485f,
                                    0.05550357114f, 0.00967603192f, 0.00133908634f};
  static constexpr float logarithm[] = {1.44269499f, -0.72135293f, 0.48091671f, -0.36022518f,
                                        0.28728888f, -0.24927182f, 0.23265258f, -0.14275973f};
};
template <>
struct Format<double> {
  static constexpr int digits = 52;
  static constexpr double least = -1022, big = 6755399441055744.0;
  static constexpr int64_t root_half = 0x3fe6a09e667f3bcd;
  static constexpr double power[] = {1.0,
                                     0.69314718054593345,
                                     0.24022650695812988,
                                     0.05550410941205933,
                                     0.0096181291594025582,
                                     0.0013333450568000646,
                                     0.00015403455852453839,
                                     1.5310079402249297e-5,
                                     1.3255224878668817e-6};
  static constexpr double logarithm[] = {
      1.4426950408892767,   -0.72134752042302246, 0.48089834664680558,  -0.36067376647095918, 0.28853906307973646,
      -0.24044867672015177, 0.20609559789891455,  -0.18035239484640201, 0.16041922068856116,  -0.14408723643734013,
      0.12918126251416428,  -0.11999522531685417, 0.12624166234975335,  -0.12216563305671267, 0.06164348424505577};
};
template <class D>
using FormatOf = Format<hn::TFromD<D>>;

template <class D, class T, size_t N>
HWY_INLINE hn::Vec<D> polynomial(D d, hn::Vec<D> x, const T (&c)[N]) {
  auto p = hn::Set(d, c[N - 1]);
  for (size_t i = N - 1; i-- > 0;)
    p = hn::MulAdd(p, x, hn::Set(d, c[i]));
  return p;
}

/// x at most 127 (in double precision 1023); below -126 (-1022) it counts as that.
template <class D>
HWY_INLINE hn::Vec<D> exp2(D d, hn::Vec<D> x) {
  using Bits = FormatOf<D>;
  x = hn::Max(x, hn::Set(d, Bits::least));
#if HWY_TARGET <= HWY_AVX3
  constexpr int nearest = _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC;
  if constexpr (sizeof(hn::Vec<D>) == 64 && Bits::digits == 23) {
    const auto whole = _mm512_roundscale_ps(x.raw, nearest);
    return {_mm512_scalef_ps(polynomial(d, hn::Sub(x, hn::Vec<D>{whole}), Bits::power).raw, whole)};
  } else if constexpr (sizeof(hn::Vec<D>) == 64) {
    const auto whole = _mm512_roundscale_pd(x.raw, nearest);
    return {_mm512_scalef_pd(polynomial(d, hn::Sub(x, hn::Vec<D>{whole}), Bits::power).raw, whole)};
  }
#endif
  const hn::RebindToSigned<D> i;
  const auto big = hn::Set(d, Bits::big), shifted = hn::Add(x, big);
  const auto t = hn::Sub(x, hn::Sub(shifted, big));
  return hn::BitCast(d, hn::Add(hn::BitCast(i, polynomial(d, t, Bits::power)),
                                hn::ShiftLeft<Bits::digits>(hn::BitCast(i, shifted))));
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

/// x normal and positive.
template <class D>
HWY_INLINE hn::Vec<D> log2(D d, hn::Vec<D> x) {
  using Bits = FormatOf<D>;
  const hn::RebindToSigned<D> i;
  const auto bits = hn::BitCast(i, x);
  const auto n = hn::ShiftRight<Bits::digits>(hn::Sub(bits, hn::Set(i, Bits::root_half)));
  const auto t =
      hn::Sub(hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<Bits::digits>(n))), hn::Set(d, hn::TFromD<D>{1}));
  return hn::MulAdd(t, polynomial(d, t, Bits::logarithm), hn::ConvertTo(d, n));
}
HWY_INLINE V log2(V x) {
  return log2(f, x);
}

/// use(a) for the first of every `lanes` atoms in the slots of clusters.
template <class Use>
HWY_INLINE void for_atoms(const int32_t* cluster, int32_t clusters, Use&& use) {
  for (int32_t c = 0; c < clusters; ++c)
    for (size_t a = 16 * static_cast<size_t>(cluster[c]), end = a + 16; a < end; a += lanes)
      use(a);
}

/// From the machine's estimate: in single precision one Newton step, 3e-7; in double one of third order, 1e-12.
template <class D>
HWY_INLINE hn::Vec<D> twice_square_root(D d, hn::Vec<D> x) {
  if constexpr (FormatOf<D>::digits == 23) {
    const auto r = hn::ApproximateReciprocalSqrt(x), xr = hn::Mul(x, r);
    return hn::Mul(xr, hn::NegMulAdd(xr, r, hn::Set(d, 3.0f)));
  } else {
#if HWY_TARGET <= HWY_AVX3
    const hn::Vec<D> r{_mm512_rsqrt14_pd(x.raw)}, xr = hn::Mul(x, r);
    const auto e = hn::NegMulAdd(xr, r, hn::Set(d, 1.0));
    return hn::Mul(xr, hn::MulAdd(e, hn::MulAdd(e, hn::Set(d, 0.75), hn::Set(d, 1.0)), hn::Set(d, 2.0)));
#else
    const auto r = hn::Sqrt(x);
    return hn::Add(r, r);
#endif
  }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();
#endif
