// block_kernel.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/block_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/block_kernel.cpp"
#include <hwy/foreach_target.h>

#include "density/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

struct One {
  HWY_INLINE V operator()(V t) const { return t; }
};
struct Half {
  HWY_INLINE V operator()(V t) const { return twice_square_root(t); } // half of it is in the last row
};
struct Two {
  HWY_INLINE V operator()(V t) const { return hn::Mul(t, t); }
};
struct Any {
  V p;
  HWY_INLINE V operator()(V t) const { return exp2(hn::Mul(p, log2(t))); }
};

/// Tiles of the 8 × 64 points that keep their sums in registers.
constexpr int32_t tile_i = lanes == 16 ? 4 : 2, tile_v = lanes == 1 ? 8 : 4;

/// put(i, v, t): t = `least` + Σ x·yz over n rows, at point i of x and the points of yz from v on. x: [8·n] factors
/// of the x axis, yz: [64·n] products of the other two.
template <class Put>
HWY_INLINE void for_sums(const float* x, const float* yz, int32_t n, float least, Put&& put) {
  for (int32_t v0 = 0; v0 < 64; v0 += tile_v * lanes)
    for (int32_t i0 = 0; i0 < 8; i0 += tile_i) {
      V t[tile_i][tile_v];
      for (int32_t i = 0; i < tile_i; ++i)
        for (int32_t v = 0; v < tile_v; ++v)
          t[i][v] = hn::Set(f, least);
      for (int32_t a = 0; a < n; ++a) {
        V row[tile_v];
        for (int32_t v = 0; v < tile_v; ++v)
          row[v] = hn::LoadU(f, yz + 64 * a + v0 + lanes * v);
        for (int32_t i = 0; i < tile_i; ++i) {
          const V xi = hn::Set(f, x[8 * a + i0 + i]);
          for (int32_t v = 0; v < tile_v; ++v)
            t[i][v] = hn::MulAdd(xi, row[v], t[i][v]);
        }
      }
      for (int32_t i = 0; i < tile_i; ++i)
        for (int32_t v = 0; v < tile_v; ++v)
          put(i0 + i, v0 + lanes * v, t[i][v]);
    }
}

/// What multiplies the power is `scale`, or a row more when not direct.
template <bool direct, class Power>
HWY_INLINE void accumulate(const float* x, const float* yz, int32_t n, Power power, float scale, float* sum) {
  for_sums(x, yz, n, 0, [&](int32_t i, int32_t v, V t) {
    const V xi = hn::Set(f, direct ? scale : x[8 * n + i]),
            outer = direct ? xi : hn::Mul(xi, hn::LoadU(f, yz + 64 * n + v));
    float* const to = sum + 64 * i + v;
    hn::StoreU(hn::MulAdd(power(t), outer, hn::LoadU(f, to)), f, to);
  });
}

/// sum += S^½, the rows being S's. Exact: they are S/4's. The least keeps 0 from the reciprocal root.
template <bool exact>
HWY_INLINE void accumulate_roots(const float* x, const float* yz, int32_t n, float* sum) {
  for_sums(x, yz, n, 1e-36f, [&](int32_t i, int32_t v, V t) {
    float* const to = sum + 64 * i + v;
    const V r = hn::ApproximateReciprocalSqrt(t), y = exact ? hn::Mul(t, r) : t,
            factor = exact ? hn::NegMulAdd(y, r, hn::Set(f, 3.0f)) : r;
    hn::StoreU(hn::MulAdd(y, factor, hn::LoadU(f, to)), f, to);
  });
}

template <bool direct>
HWY_INLINE void add_unit(const BlockUnits& u, const BlockRows& rows, int32_t n, float* sum) {
  const auto s = static_cast<size_t>(n);
  const auto row = static_cast<size_t>(u.begin[s] + (direct ? 0 : n));
  const int32_t atoms = u.begin[s + 1] - u.begin[s];
  const float *const x = &rows.x[8 * row], *const yz = &rows.yz[64 * row], p = u.exponent[s],
                     scale = direct ? rows.scale[s] : 1;
  if (direct && u.folded && p == 0.5f)
    u.root[s] > 0 ? accumulate_roots<true>(x, yz, atoms, sum) : accumulate_roots<false>(x, yz, atoms, sum);
  else if (p == 1.0f)
    accumulate<direct>(x, yz, atoms, One{}, scale, sum);
  else if (p == 0.5f)
    accumulate<direct>(x, yz, atoms, Half{}, scale, sum);
  else if (p == 2.0f)
    accumulate<direct>(x, yz, atoms, Two{}, scale, sum);
  else
    accumulate<direct>(x, yz, atoms, Any{hn::Set(f, p)}, scale, sum);
}

void add_units_simd(const BlockUnits& u, const BlockRows& rows, int32_t first, int32_t last, float* sum) {
  for (int32_t n = first; n < last; ++n)
    u.direct ? add_unit<true>(u, rows, n, sum) : add_unit<false>(u, rows, n, sum);
}

void sum_units_simd(const BlockUnits& u, const BlockRows& rows, float start, float* sum) {
  for (int32_t i = 0; i < 512; i += lanes)
    hn::StoreU(hn::Set(f, start), f, sum + i);
  add_units_simd(u, rows, 0, u.n, sum);
}

void raise_group_simd(float p, float* from, float* to) {
  for (int32_t i = 0; i < 512; i += lanes) {
    const V v = hn::LoadU(f, from + i), least = hn::Set(f, 1.2e-38f);
    const V power = hn::IfThenElseZero(hn::Gt(v, least), exp2(hn::Mul(hn::Set(f, p), log2(hn::Max(v, least)))));
    hn::StoreU(hn::Add(hn::LoadU(f, to + i), power), f, to + i);
    hn::StoreU(hn::Zero(f), f, from + i);
  }
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
HWY_EXPORT(sum_units_simd);
HWY_EXPORT(raise_group_simd);
HWY_EXPORT(rough_root_error_simd);
HWY_EXPORT(instruction_set_name);

void add_units(const BlockUnits& units, const BlockRows& rows, int32_t first, int32_t last, float* sum) {
  HWY_DYNAMIC_DISPATCH(add_units_simd)(units, rows, first, last, sum);
}
void sum_units(const BlockUnits& units, const BlockRows& rows, float start, float* sum) {
  HWY_DYNAMIC_DISPATCH(sum_units_simd)(units, rows, start, sum);
}
void raise_group(float p, float* from, float* to) {
  HWY_DYNAMIC_DISPATCH(raise_group_simd)(p, from, to);
}
float rough_root_error() {
  return HWY_DYNAMIC_DISPATCH(rough_root_error_simd)();
}
const char* instruction_set() {
  return HWY_DYNAMIC_DISPATCH(instruction_set_name)();
}

} // namespace molmesh::density
#endif
