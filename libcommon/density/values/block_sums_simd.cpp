// block_sums_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/values/block_sums_simd.hpp"
#include "base/dispatch.hpp"
#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/values/block_sums_simd.cpp"
#include <hwy/foreach_target.h>

#include "density/values/powers-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

/// put(i, v, t): t = `least` + Σ x·yz over n rows, at point i of x and the points of yz from v on. x: [8·n] factors
/// of the x axis, yz: [64·n] products of the other two.
template <class T, class Put>
HWY_INLINE void for_sums(const T* x, const T* yz, int32_t n, T least, Put&& put) {
  constexpr Tag<T> d{};
  // Tiles of the 8 × 64 points that keep their sums in registers.
  constexpr int32_t wide = lanes_of<T>, tile_i = HWY_TARGET <= HWY_AVX3 ? 4 : 2, tile_v = wide == 1 ? 8 : 4;
  for (int32_t v0 = 0; v0 < 64; v0 += tile_v * wide)
    for (int32_t i0 = 0; i0 < 8; i0 += tile_i) {
      hn::Vec<Tag<T>> t[tile_i][tile_v];
      for (int32_t i = 0; i < tile_i; ++i)
        for (int32_t v = 0; v < tile_v; ++v)
          t[i][v] = hn::Set(d, least);
      for (int32_t a = 0; a < n; ++a) {
        hn::Vec<Tag<T>> row[tile_v];
        for (int32_t v = 0; v < tile_v; ++v)
          row[v] = hn::LoadU(d, yz + 64 * a + v0 + wide * v);
        for (int32_t i = 0; i < tile_i; ++i) {
          const auto xi = hn::Set(d, x[8 * a + i0 + i]);
          for (int32_t v = 0; v < tile_v; ++v)
            t[i][v] = hn::MulAdd(xi, row[v], t[i][v]);
        }
      }
      for (int32_t i = 0; i < tile_i; ++i)
        for (int32_t v = 0; v < tile_v; ++v)
          put(i0 + i, v0 + wide * v, t[i][v]);
    }
}

/// What multiplies the power is `scale`, and a row more when not direct.
template <bool direct, class T, class Power>
HWY_INLINE void accumulate(const T* x, const T* yz, int32_t n, Power power, T scale, T* sum) {
  constexpr Tag<T> d{};
  const auto everywhere = hn::Set(d, scale);
  for_sums(x, yz, n, T{0}, [&](int32_t i, int32_t v, hn::Vec<Tag<T>> t) {
    T* const to = sum + 64 * i + v;
    auto s = power(d, t);
    if (!direct)
      s = hn::Mul(s, hn::Mul(hn::Set(d, x[8 * n + i]), hn::LoadU(d, yz + 64 * n + v)));
    hn::StoreU(hn::MulAdd(s, everywhere, hn::LoadU(d, to)), d, to);
  });
}

/// Roots added to a sum at each point: to what is there, or as its first or last term. The last one's sum is
/// multiplied with the bend (BlockRows) and moved by `start`.
enum class Turn { first, any, last };
struct Roots {
  float* sum;
  const BlockRows<float>& rows;
  float start;

  /// y·factor at point i of x and the points of yz from v on.
  template <Turn turn>
  HWY_INLINE void put(int32_t i, int32_t v, V y, V factor) const {
    float* const to = sum + 64 * i + v;
    V all = turn == Turn::first ? hn::Mul(y, factor) : hn::MulAdd(y, factor, hn::LoadU(f, to));
    if constexpr (turn == Turn::last)
      all = hn::MulAdd(hn::Mul(hn::Set(f, rows.bend_x[i]), hn::LoadU(f, rows.bend_yz + v)), all, hn::Set(f, start));
    hn::StoreU(all, f, to);
  }
  /// S^½, the rows being S's. Exact: they are S/4's. The least keeps 0 from the reciprocal root.
  template <bool exact, Turn turn>
  HWY_INLINE void add(const float* x, const float* yz, int32_t n) const {
    for_sums(x, yz, n, 1e-36f, [&](int32_t i, int32_t v, V t) {
      const V r = hn::ApproximateReciprocalSqrt(t), y = exact ? hn::Mul(t, r) : t;
      put<turn>(i, v, y, exact ? hn::NegMulAdd(y, r, hn::Set(f, 3.0f)) : r);
    });
  }
  /// The same of one atom's row: the factors have roots of their own. scale: 2 where it is exact.
  template <Turn turn>
  HWY_INLINE void add_one(const float* x, const float* yz, float scale) const {
    constexpr hn::CappedTag<float, 8> d8{};
    HWY_ALIGN float along[8];
    for (size_t i = 0; i < 8; i += hn::Lanes(d8))
      hn::Store(hn::Mul(hn::Set(d8, scale), hn::Sqrt(hn::LoadU(d8, x + i))), d8, along + i);
    for (int32_t v = 0; v < 64; v += lanes) {
      const V across = hn::Sqrt(hn::LoadU(f, yz + v));
      for (int32_t i = 0; i < 8; ++i)
        put<turn>(i, v, hn::Set(f, along[i]), across);
    }
  }
  template <Turn turn>
  HWY_INLINE void add_unit(const BlockUnits& u, size_t s) const {
    const auto row = static_cast<size_t>(u.begin[s]);
    const int32_t atoms = u.begin[s + 1] - u.begin[s];
    const float *const x = &rows.x[8 * row], *const yz = &rows.yz[64 * row];
    if (atoms == 1)
      return add_one<turn>(x, yz, u.root[s] > 0 ? 2.0f : 1.0f);
    u.root[s] > 0 ? add<true, turn>(x, yz, atoms) : add<false, turn>(x, yz, atoms);
  }
};

/// The same of a power that is taken factor by factor where there is one row alone: of 72 numbers, not of 512.
template <bool direct, class T, class Power>
HWY_INLINE void accumulate_power(const T* x, const T* yz, int32_t n, Power power, T scale, T* sum) {
  if (n > 1)
    return accumulate<direct>(x, yz, n, power, scale, sum);
  constexpr Tag<T> d{};
  constexpr int32_t wide = lanes_of<T>;
  HWY_ALIGN T along[HWY_MAX(8, wide)] = {};
  std::copy_n(x, 8, along);
  for (int32_t i = 0; i < 8; i += wide)
    hn::Store(hn::Mul(hn::Set(d, scale), power(d, hn::Load(d, along + i))), d, along + i);
  if (!direct)
    for (int32_t i = 0; i < 8; ++i)
      along[i] *= x[8 + i];
  for (int32_t v = 0; v < 64; v += wide) {
    auto across = power(d, hn::LoadU(d, yz + v));
    if (!direct)
      across = hn::Mul(across, hn::LoadU(d, yz + 64 + v));
    for (int32_t i = 0; i < 8; ++i) {
      T* const to = sum + 64 * i + v;
      hn::StoreU(hn::MulAdd(hn::Set(d, along[i]), across, hn::LoadU(d, to)), d, to);
    }
  }
}

template <bool direct, class T>
HWY_INLINE void add_unit(const UnitsOf<T>& u, const BlockRows<T>& rows, size_t s, T* sum) {
  const size_t row = static_cast<size_t>(u.begin[s]) + (direct ? 0 : s);
  const int32_t atoms = u.begin[s + 1] - u.begin[s];
  const T *const x = &rows.x[8 * row], *const yz = &rows.yz[64 * row], p = u.exponent[s], scale = rows.scale[s];
  if (p == 1)
    accumulate<direct>(x, yz, atoms, One{}, scale, sum);
  else if (p == T{0.5})
    accumulate<direct>(x, yz, atoms, Half{}, scale, sum);
  else if (p == 2)
    accumulate<direct>(x, yz, atoms, Two{}, scale, sum);
  else
    with_power(p, [&](auto power) { accumulate_power<direct>(x, yz, atoms, power, scale, sum); });
}

HWY_INLINE bool is_folded_root(const BlockUnits& u, size_t s) {
  return u.folded && u.exponent[s] == 0.5f;
}

void add_units_simd(const BlockUnits& u, const BlockRows<float>& rows, int32_t first, int32_t last, float* sum) {
  for (auto s = static_cast<size_t>(first); s < static_cast<size_t>(last); ++s)
    if (is_folded_root(u, s))
      Roots{sum, rows, 0}.add_unit<Turn::any>(u, s);
    else
      u.direct ? add_unit<true>(u, rows, s, sum) : add_unit<false>(u, rows, s, sum);
}

void add_exact_units_simd(const ExactUnits& u, const BlockRows<double>& rows, int32_t first, int32_t last,
                          double* sum) {
  for (auto s = static_cast<size_t>(first); s < static_cast<size_t>(last); ++s)
    add_unit<false>(u, rows, s, sum);
}

template <class T>
HWY_INLINE void fill(T start, T* sum) {
  constexpr Tag<T> d{};
  for (int32_t i = 0; i < 512; i += lanes_of<T>)
    hn::StoreU(hn::Set(d, start), d, sum + i);
}

void sum_units_simd(const BlockUnits& u, const BlockRows<float>& rows, float start, float* sum) {
  if (!u.roots) {
    fill(start, sum);
    return add_units_simd(u, rows, 0, u.n, sum);
  }
  const auto n = static_cast<size_t>(u.n);
  const Roots roots{sum, rows, start};
  roots.add_unit<Turn::first>(u, 0);
  for (size_t s = 1; s < n - 1; ++s)
    roots.add_unit<Turn::any>(u, s);
  roots.add_unit<Turn::last>(u, n - 1);
}

void sum_exact_units_simd(const ExactUnits& u, const BlockRows<double>& rows, double start, double* sum) {
  fill(start, sum);
  add_exact_units_simd(u, rows, 0, u.n, sum);
}

template <class T, class Power>
HWY_INLINE void raise(Power power, T* from, T* to) {
  constexpr Tag<T> d{};
  const auto least = hn::Set(d, std::numeric_limits<T>::min());
  for (int32_t i = 0; i < 512; i += lanes_of<T>) {
    const auto v = hn::LoadU(d, from + i);
    hn::StoreU(hn::Add(hn::LoadU(d, to + i), hn::IfThenElseZero(hn::Gt(v, least), power(d, hn::Max(v, least)))), d,
               to + i);
    hn::StoreU(hn::Zero(d), d, from + i);
  }
}

/// 2^shift · x^p.
template <class T>
struct Shifted {
  T p, shift;
  template <class D, class V>
  HWY_INLINE V operator()(D d, V x) const {
    return exp2(d, hn::MulAdd(hn::Set(d, p), log2(d, x), hn::Set(d, shift)));
  }
};

void raise_group_simd(float p, float shift, float* from, float* to) {
  if (shift == 0 && Tabled::holds(p))
    raise(Tabled(p), from, to);
  else
    raise(Shifted<float>{p, shift}, from, to);
}
void raise_exact_group_simd(double p, double shift, double* from, double* to) {
  if (shift == 0 && Tabled::holds(static_cast<float>(p)) && p < 1)
    raise(TabledExactly(p), from, to);
  else
    raise(Shifted<double>{p, shift}, from, to);
}

float rough_root_error_simd() {
  return HWY_TARGET <= HWY_AVX3 ? 6.2e-5f : 1.0f; // 2^-14
}

const char* instruction_set_name() {
  return hwy::TargetName(HWY_TARGET);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::density {

HWY_EXPORT(add_units_simd);
HWY_EXPORT(add_exact_units_simd);
HWY_EXPORT(sum_units_simd);
HWY_EXPORT(sum_exact_units_simd);
HWY_EXPORT(raise_group_simd);
HWY_EXPORT(raise_exact_group_simd);
HWY_EXPORT(rough_root_error_simd);
HWY_EXPORT(instruction_set_name);

void add_units(const BlockUnits& units, const BlockRows<float>& rows, int32_t first, int32_t last, float* sum) {
  MOLMESH_DISPATCH(add_units_simd)(units, rows, first, last, sum);
}
void add_units(const ExactUnits& units, const BlockRows<double>& rows, int32_t first, int32_t last, double* sum) {
  MOLMESH_DISPATCH(add_exact_units_simd)(units, rows, first, last, sum);
}
void sum_units(const BlockUnits& units, const BlockRows<float>& rows, float start, float* sum) {
  MOLMESH_DISPATCH(sum_units_simd)(units, rows, start, sum);
}
void sum_units(const ExactUnits& units, const BlockRows<double>& rows, double start, double* sum) {
  MOLMESH_DISPATCH(sum_exact_units_simd)(units, rows, start, sum);
}
void raise_group(float p, float shift, float* from, float* to) {
  MOLMESH_DISPATCH(raise_group_simd)(p, shift, from, to);
}
void raise_group(double p, double shift, double* from, double* to) {
  MOLMESH_DISPATCH(raise_exact_group_simd)(p, shift, from, to);
}
float rough_root_error() {
  return MOLMESH_DISPATCH(rough_root_error_simd)();
}
const char* instruction_set() {
  return MOLMESH_DISPATCH(instruction_set_name)();
}

} // namespace molmesh::density
#endif
