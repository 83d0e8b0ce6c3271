// axis_factors_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/values/axis_factors_simd.hpp"
#include "base/dispatch.hpp"
#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/values/axis_factors_simd.cpp"
#include <hwy/foreach_target.h>

#include "density/values/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

template <class T>
struct Bend {
  explicit Bend(T c) : curvature(c) {}
  T curvature;
};

/// Rows of as many atoms as a vector holds.
template <class T>
class Rows {
public:
  using D = Tag<T>;
  using V = hn::Vec<D>;
  Rows(V x, V y, V z, V constant_x, V constant_yz) {
    hn::Store(x, D(), x_);
    hn::Store(y, D(), y_);
    hn::Store(z, D(), z_);
    hn::Store(constant_x, D(), constant_x_);
    hn::Store(constant_yz, D(), constant_yz_);
  }
  template <bool bent>
  void write(int32_t row, const Bend<T>& bend, T* x, T* yz) const {
    T y[8];
    const auto q = hn::Set(d8, bent ? bend.curvature : 0);
    const auto factors = [&](int32_t l, T slope, T constant) {
      const auto t = hn::Add(hn::Iota(d8, static_cast<T>(l)), hn::Set(d8, T{-3.5}));
      return exp2(d8, hn::MulAdd(hn::MulAdd(q, t, hn::Set(d8, slope)), t, hn::Set(d8, constant)));
    };
    for (int32_t l = 0; l < 8; l += lanes8) {
      hn::StoreU(factors(l, x_[row], constant_x_[row]), d8, x + l);
      hn::StoreU(factors(l, y_[row], 0), d8, y + l);
    }
    for (int32_t l = 0; l < 8; l += lanes8) {
      const auto z = factors(l, z_[row], constant_yz_[row]);
      for (int32_t j = 0; j < 8; ++j)
        hn::StoreU(hn::Mul(hn::Set(d8, y[j]), z), d8, yz + 8 * j + l);
    }
  }

private:
  using D8 = hn::CappedTag<T, 8>;
  static constexpr D8 d8{};
  static constexpr int32_t lanes8 = HWY_MIN(8, lanes_of<T>);
  HWY_ALIGN T x_[lanes_of<T>], y_[lanes_of<T>], z_[lanes_of<T>], constant_x_[lanes_of<T>],
      constant_yz_[lanes_of<T>];
};

#if HWY_TARGET <= HWY_AVX3
/// What bends the exponents of a row: 2^(curvature·t²) along x, and y times z.
template <>
struct Bend<float> {
  explicit Bend(float curvature) {
    alignas(64) static constexpr float steps[16] = {-3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f,
                                                    -3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f};
    alignas(64) static constexpr int32_t pair[16] = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1};
    const V t = hn::Load(f, steps), bend = exp2(hn::Mul(hn::Set(f, curvature), hn::Mul(t, t)));
    x = _mm512_castps512_ps256(bend.raw);
    for (int32_t v = 0; v < 4; ++v)
      yz[v] = hn::Mul(bend, hn::TableLookupLanes(
                                bend, hn::IndicesFromVec(f, hn::Add(hn::Load(I(), pair), hn::Set(I(), 2 * v)))));
  }
  __m256 x;
  V yz[4];
};

/// Rows of 16 atoms. An exponent that is linear along an axis makes a geometric series: its terms r^(i - 4) are
/// products of r, r² and r⁻⁴, of those that the bits of i choose.
template <>
class Rows<float> {
public:
  Rows(V x, V y, V z, V constant_x, V constant_yz) {
    const V half = hn::Set(f, 0.5f);
    hn::Store(exp2(hn::MulAdd(half, x, constant_x)), f, start_x_);
    hn::Store(exp2(hn::MulAdd(half, hn::Add(y, z), constant_yz)), f, start_yz_);
    keep_powers(x, x_);
    keep_powers(y, y_);
    keep_powers(z, z_);
  }
  template <bool bent>
  void write(int32_t row, const Bend<float>& bend, float* x, float* yz) const {
    __m256 tx = _mm256_set1_ps(start_x_[row]);
    tx = _mm256_mask_mul_ps(tx, 0xaa, tx, _mm256_set1_ps(x_[0][row]));
    tx = _mm256_mask_mul_ps(tx, 0xcc, tx, _mm256_set1_ps(x_[1][row]));
    tx = _mm256_mask_mul_ps(tx, 0x0f, tx, _mm256_set1_ps(x_[2][row]));
    _mm256_storeu_ps(x, bent ? _mm256_mul_ps(tx, bend.x) : tx);
    __m512 t[4]; // of y two j at a time
    __m512 tz = _mm512_set1_ps(start_yz_[row]);
    tz = _mm512_mask_mul_ps(tz, 0xaaaa, tz, _mm512_set1_ps(z_[0][row]));
    tz = _mm512_mask_mul_ps(tz, 0xcccc, tz, _mm512_set1_ps(z_[1][row]));
    tz = _mm512_mask_mul_ps(tz, 0x0f0f, tz, _mm512_set1_ps(z_[2][row]));
    t[2] = _mm512_mask_mul_ps(tz, 0xff00, tz, _mm512_set1_ps(y_[0][row]));
    t[3] = _mm512_mul_ps(t[2], _mm512_set1_ps(y_[1][row]));
    t[0] = _mm512_mul_ps(t[2], _mm512_set1_ps(y_[2][row]));
    t[1] = _mm512_mul_ps(t[3], _mm512_set1_ps(y_[2][row]));
    for (int32_t v = 0; v < 4; ++v)
      _mm512_storeu_ps(yz + 16 * v, bent ? _mm512_mul_ps(t[v], bend.yz[v].raw) : t[v]);
  }

private:
  static void keep_powers(V slope, float (&to)[3][16]) {
    const V r = exp2(slope);
    hn::Store(r, f, to[0]);
    hn::Store(hn::Mul(r, r), f, to[1]);
    hn::Store(exp2(hn::Mul(hn::Set(f, -4.0f), slope)), f, to[2]);
  }
  HWY_ALIGN float start_x_[16], start_yz_[16], x_[3][16], y_[3][16], z_[3][16];
};
#endif

/// Rows of all atoms: one after the other when direct, else with room for one more after those of each unit.
template <bool direct, bool bent, class T>
HWY_INLINE void make_atom_rows(const UnitsOf<T>& u, T curvature, T* x, T* yz) {
  constexpr Tag<T> d{};
  const Bend<T> bend(curvature);
  const int32_t atoms = u.begin[u.n];
  size_t unit = 0;
  for (int32_t a = 0; a < atoms; a += lanes_of<T>) {
    const auto get = [&](const AlignedVector<T>& v) { return hn::LoadU(d, v.data() + a); };
    // Half in either factor: what is lost by one that is too small is small itself.
    const auto constant = get(u.atom_constant), share = hn::Mul(constant, hn::Set(d, direct ? T{0.5} : T{1}));
    const Rows<T> rows(get(u.atom_x), get(u.atom_y), get(u.atom_z), share, hn::Sub(constant, share));
    for (int32_t l = 0; l < std::min(lanes_of<T>, atoms - a); ++l) {
      if (!direct)
        unit += a + l == u.begin[unit + 1];
      const auto row = static_cast<size_t>(a + l) + unit;
      rows.template write<bent>(l, bend, x + 8 * row, yz + 64 * row);
    }
  }
}

/// The last row of each unit: what multiplies its power, but for the scale.
template <class T>
HWY_INLINE void make_unit_rows(const UnitsOf<T>& u, const BlockShape<T>& b, T* x, T* yz) {
  constexpr Tag<T> d{};
  for (int32_t n = 0; n < u.n; n += lanes_of<T>) {
    const auto slope = hn::Mul(hn::LoadU(d, u.exponent.data() + n), hn::Set(d, b.slope));
    const auto along = [&](const AlignedVector<T>& center, int axis) {
      return hn::Mul(slope, hn::Sub(hn::LoadU(d, center.data() + n), hn::Set(d, b.middle[axis])));
    };
    const Rows<T> rows(along(u.x, 0), along(u.y, 1), along(u.z, 2), hn::Zero(d), hn::Zero(d));
    for (int32_t l = 0; l < std::min(lanes_of<T>, u.n - n); ++l) {
      const auto unit = static_cast<size_t>(n + l);
      const size_t row = static_cast<size_t>(u.begin[unit + 1]) + unit;
      rows.template write<true>(l, Bend<T>(u.exponent[unit] * b.curvature), x + 8 * row, yz + 64 * row);
    }
  }
}

template <class T>
HWY_INLINE void make_rows_of(const UnitsOf<T>& u, bool direct, const BlockShape<T>& b, BlockRows<T>& rows) {
  constexpr Tag<T> d{};
  T *const x = rows.x.data(), *const yz = rows.yz.data();
  if (direct) {
    make_atom_rows<true, true>(u, b.curvature, x, yz);
  } else {
    make_atom_rows<false, false>(u, T{0}, x, yz);
    make_unit_rows(u, b, x, yz);
  }
  for (int32_t n = 0; n < u.n; n += lanes_of<T>) {
    // Half{} gives twice the square root.
    const auto p = hn::LoadU(d, u.exponent.data() + n),
               roots = hn::IfThenElseZero(hn::Eq(p, hn::Set(d, T{0.5})), hn::Set(d, T{1}));
    hn::StoreU(exp2(d, hn::MulSub(p, hn::LoadU(d, u.log2_term.data() + n), roots)), d, rows.scale.data() + n);
  }
}

/// All blocks of a grid have the same.
void make_bend(float curvature, BlockRows<float>& rows) {
  if (rows.bent_by == curvature)
    return;
  rows.bent_by = curvature;
  const V zero = hn::Zero(f);
  Rows<float>(zero, zero, zero, zero, zero)
      .write<true>(0, Bend<float>(0.5f * curvature), rows.bend_x, rows.bend_yz);
}

void make_rows_simd(const BlockUnits& u, const BlockShape<float>& b, BlockRows<float>& rows) {
  if (u.roots) {
    make_bend(b.curvature, rows);
    return make_atom_rows<true, false>(u, b.curvature, rows.x.data(), rows.yz.data());
  }
  make_rows_of(u, u.direct, b, rows);
}
void make_exact_rows_simd(const ExactUnits& u, const BlockShape<double>& b, BlockRows<double>& rows) {
  make_rows_of(u, false, b, rows);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::density {

HWY_EXPORT(make_rows_simd);
HWY_EXPORT(make_exact_rows_simd);

void make_rows(const BlockUnits& units, const BlockShape<float>& shape, BlockRows<float>& rows) {
  MOLMESH_DISPATCH(make_rows_simd)(units, shape, rows);
}
void make_rows(const ExactUnits& units, const BlockShape<double>& shape, BlockRows<double>& rows) {
  MOLMESH_DISPATCH(make_exact_rows_simd)(units, shape, rows);
}

} // namespace molmesh::density
#endif
