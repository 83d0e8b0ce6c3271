// powers-inl.hpp — what raises sums to a power, in single and double precision, for the kernels. Included once per
// instruction set by Highway's foreach_target.
#if defined(MOLMESH_DENSITY_POWERS) == defined(HWY_TARGET_TOGGLE)
#ifdef MOLMESH_DENSITY_POWERS
#undef MOLMESH_DENSITY_POWERS
#else
#define MOLMESH_DENSITY_POWERS
#endif
#include "density/values/power_table.hpp"
#include "density/values/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

struct One {
  template <class D, class V>
  HWY_INLINE V operator()(D, V t) const {
    return t;
  }
};
struct Half {
  template <class D, class V>
  HWY_INLINE V operator()(D d, V t) const {
    return twice_square_root(d, t); // half of it is in the scale
  }
};
struct Two {
  template <class D, class V>
  HWY_INLINE V operator()(D, V t) const {
    return hn::Mul(t, t);
  }
};
template <class T>
struct Any {
  T p;
  template <class D, class V>
  HWY_INLINE V operator()(D d, V t) const {
    return exp2(d, hn::Mul(hn::Set(d, p), log2(d, t)));
  }
};

#if HWY_TARGET <= HWY_AVX3
/// x^p by tables: half the instructions of a logarithm and its exponential.
class Tabled {
public:
  static bool holds(float p) { return p > 0 && p < 1; }
  explicit Tabled(float p) : Tabled(power_table(p)) {}
  HWY_INLINE V operator()(F, V x) const {
    const auto bits = _mm512_castps_si512(x.raw); // of a table's index the lowest four bits count
    const V m{_mm512_getmant_ps(x.raw, _MM_MANT_NORM_1_2, _MM_MANT_SIGN_zero)},
        low{_mm512_permutexvar_ps(_mm512_srli_epi32(bits, 23), low_.raw)},
        high{_mm512_permutexvar_ps(_mm512_srli_epi32(bits, 27), high_.raw)};
    return hn::Mul(polynomial(f, m, polynomial_), hn::Mul(low, high));
  }

private:
  explicit Tabled(const PowerTable& t) : low_(hn::Load(f, t.low)), high_(hn::LoadU(f, t.high)) {
    for (size_t i = 0; i < PowerTable::terms; ++i)
      polynomial_[i] = t.polynomial[i];
  }
  V low_, high_;
  float polynomial_[PowerTable::terms];
};
class TabledExactly {
public:
  explicit TabledExactly(double p) : t_(exact_power_table(p)) {}
  HWY_INLINE hn::Vec<Tag<double>> operator()(Tag<double> d, hn::Vec<Tag<double>> x) const {
    const auto bits = _mm512_castpd_si512(x.raw);
    const auto of_16 = [&](const double* table, unsigned shift) {
      return hn::Vec<Tag<double>>{
          _mm512_permutex2var_pd(_mm512_load_pd(table), _mm512_srli_epi64(bits, shift), _mm512_load_pd(table + 8))};
    };
    const hn::Vec<Tag<double>> m{_mm512_getmant_pd(x.raw, _MM_MANT_NORM_1_2, _MM_MANT_SIGN_zero)},
        high{_mm512_permutexvar_pd(_mm512_srli_epi64(bits, 60), _mm512_load_pd(t_.high))};
    const auto r = hn::MulSub(m, of_16(t_.inverse, 48), hn::Set(d, 1.0));
    return hn::Mul(hn::Mul(polynomial(d, r, t_.polynomial), of_16(t_.middle, 48)),
                   hn::Mul(hn::Mul(high, of_16(t_.mid, 56)), of_16(t_.low, 52)));
  }

private:
  const ExactPowerTable& t_;
};
#else
struct TabledExactly : Any<double> {
  explicit TabledExactly(double exponent) : Any<double>{exponent} {}
};
/// Narrower vectors have no tables of 16 numbers.
struct Tabled : Any<float> {
  static bool holds(float) { return false; }
  explicit Tabled(float exponent) : Any<float>{exponent} {}
};
#endif

/// use(x^p).
template <class Use>
HWY_INLINE void with_power(float p, Use&& use) {
  Tabled::holds(p) ? use(Tabled(p)) : use(Any<float>{p});
}
template <class Use>
HWY_INLINE void with_power(double p, Use&& use) {
  Tabled::holds(static_cast<float>(p)) && p < 1 ? use(TabledExactly(p)) : use(Any<double>{p});
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();
#endif
