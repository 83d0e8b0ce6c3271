// block_kernel.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/block_kernel.hpp"
#include <algorithm>

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

/// x: [8·n] factors of the x axis, yz: [64·n] products of the other two; what multiplies the power is `scale`, or a
/// row more when not direct.
template <bool direct, class Power>
HWY_INLINE void accumulate(const float* x, const float* yz, int32_t n, Power power, float scale, float* sum) {
  for (int32_t v0 = 0; v0 < 64; v0 += tile_v * lanes)
    for (int32_t i0 = 0; i0 < 8; i0 += tile_i) {
      V t[tile_i][tile_v];
      for (int32_t i = 0; i < tile_i; ++i)
        for (int32_t v = 0; v < tile_v; ++v)
          t[i][v] = hn::Zero(f);
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
      for (int32_t i = 0; i < tile_i; ++i) {
        const V xi = hn::Set(f, direct ? scale : x[8 * n + i0 + i]);
        for (int32_t v = 0; v < tile_v; ++v) {
          float* const to = sum + 64 * (i0 + i) + v0 + lanes * v;
          const V outer = direct ? xi : hn::Mul(xi, hn::LoadU(f, yz + 64 * n + v0 + lanes * v));
          hn::StoreU(hn::MulAdd(power(t[i][v]), outer, hn::LoadU(f, to)), f, to);
        }
      }
    }
}

/// log2 of what multiplies T^p everywhere. Half{} gives twice the square root.
HWY_INLINE float log2_scale(float p, float log2_term) {
  return p * log2_term - (p == 0.5f ? 1.0f : 0.0f);
}

/// The arguments of a row: of an atom, or of what multiplies a power.
struct Row {
  float constant, slope[3];
};

#if HWY_TARGET <= HWY_AVX3
/// Exponentials of two rows and products of their y and z factors, in registers: x and y of a row share one, the z
/// of both rows another. curvature: of every argument.
class Rows {
public:
  explicit Rows(float curvature) : q_(hn::Set(f, curvature)), low_(hn::FirstN(f, 8)) {
    for (int v = 0; v < 6; ++v)
      index_[v] = hn::SetTableIndices(f, order[v]);
    t_ = hn::Load(f, steps);
  }
  void atoms(const float* ax, const float* ay, const float* az, const float* ac, int32_t n, float* x,
             float* yz) const {
    for (int32_t a = 0; a < n; a += 2) { // one row too many is overwritten
      const V z = exp2(argument(az[a], az[a + 1], 0));
      write(exp2(argument(ax[a], ay[a], ac[a])), hn::TableLookupLanes(z, index_[4]), x + 8 * a, yz + 64 * a);
      write(exp2(argument(ax[a + 1], ay[a + 1], ac[a + 1])), hn::TableLookupLanes(z, index_[5]), x + 8 * a + 8,
            yz + 64 * a + 64);
    }
  }
  void one(const Row& r, float* x, float* yz) const {
    const V z = exp2(argument(r.slope[2], 0, 0));
    write(exp2(argument(r.slope[0], r.slope[1], r.constant)), hn::TableLookupLanes(z, index_[4]), x, yz);
  }

private:
  V pair(float low, float high) const { return hn::IfThenElse(low_, hn::Set(f, low), hn::Set(f, high)); }
  V argument(float low, float high, float low_constant) const {
    return hn::MulAdd(hn::MulAdd(q_, t_, pair(low, high)), t_, hn::IfThenElseZero(low_, hn::Set(f, low_constant)));
  }
  void write(V xy, V z, float* x, float* yz) const {
    hn::StoreU(hn::LowerHalf(xy), hn::Half<F>(), x);
    for (int v = 0; v < 4; ++v)
      hn::StoreU(hn::Mul(hn::TableLookupLanes(xy, index_[v]), z), f, yz + 16 * v);
  }
  // Of y for two j at a time; of z of either row.
  alignas(64) static constexpr int32_t order[6][16] = {
      {8, 8, 8, 8, 8, 8, 8, 8, 9, 9, 9, 9, 9, 9, 9, 9},
      {10, 10, 10, 10, 10, 10, 10, 10, 11, 11, 11, 11, 11, 11, 11, 11},
      {12, 12, 12, 12, 12, 12, 12, 12, 13, 13, 13, 13, 13, 13, 13, 13},
      {14, 14, 14, 14, 14, 14, 14, 14, 15, 15, 15, 15, 15, 15, 15, 15},
      {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7},
      {8, 9, 10, 11, 12, 13, 14, 15, 8, 9, 10, 11, 12, 13, 14, 15}};
  alignas(64) static constexpr float steps[16] = {-3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f,
                                                  -3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f};
  decltype(hn::SetTableIndices(f, order[0])) index_[6];
  V q_, t_;
  hn::Mask<F> low_;
};
#else
class Rows {
public:
  explicit Rows(float curvature) : q_(curvature) {}
  void atoms(const float* ax, const float* ay, const float* az, const float* ac, int32_t n, float* x,
             float* yz) const {
    for (int32_t a = 0; a < n; ++a)
      one({ac[a], {ax[a], ay[a], az[a]}}, x + 8 * a, yz + 64 * a);
  }
  void one(const Row& r, float* x, float* yz) const {
    float y[8];
    for (int32_t l = 0; l < 8; l += lanes8) {
      const auto t = hn::Add(hn::Iota(f8, static_cast<float>(l)), hn::Set(f8, -3.5f));
      const auto factor = [&](float slope, float constant) {
        return exp2(f8, hn::MulAdd(hn::MulAdd(hn::Set(f8, q_), t, hn::Set(f8, slope)), t, hn::Set(f8, constant)));
      };
      hn::StoreU(factor(r.slope[0], r.constant), f8, x + l);
      hn::StoreU(factor(r.slope[1], 0), f8, y + l);
    }
    for (int32_t l = 0; l < 8; l += lanes8) {
      const auto t = hn::Add(hn::Iota(f8, static_cast<float>(l)), hn::Set(f8, -3.5f));
      const auto z = exp2(f8, hn::Mul(hn::MulAdd(hn::Set(f8, q_), t, hn::Set(f8, r.slope[2])), t));
      for (int32_t j = 0; j < 8; ++j)
        hn::StoreU(hn::Mul(hn::Set(f8, y[j]), z), f8, yz + 8 * j + l);
    }
  }

private:
  using F8 = hn::CappedTag<float, 8>;
  static constexpr F8 f8{};
  static constexpr int32_t lanes8 = static_cast<int32_t>(HWY_MIN(8, HWY_LANES(float)));
  float q_;
};
#endif

void make_rows_simd(const BlockUnits& u, const BlockShape& b, BlockRows& rows) {
  float *const x = rows.x.data(), *const yz = rows.yz.data();
  if (u.direct)
    return Rows(b.curvature)
        .atoms(u.atom_x.data(), u.atom_y.data(), u.atom_z.data(), u.atom_constant.data(),
               u.begin[static_cast<size_t>(u.n)], x, yz);
  const Rows make(0);
  for (int32_t n = 0; n < u.n; ++n) {
    const auto s = static_cast<size_t>(n), a = static_cast<size_t>(u.begin[s]), row = a + s;
    const int32_t atoms = u.begin[s + 1] - u.begin[s];
    make.atoms(&u.atom_x[a], &u.atom_y[a], &u.atom_z[a], &u.atom_constant[a], atoms, x + 8 * row, yz + 64 * row);
    const size_t last = row + static_cast<size_t>(atoms);
    const float p = u.exponent[s];
    Rows(p * b.curvature)
        .one({log2_scale(p, u.log2_term[s]),
              {p * b.slope * (u.x[s] - b.middle[0]), p * b.slope * (u.y[s] - b.middle[1]),
               p * b.slope * (u.z[s] - b.middle[2])}},
             x + 8 * last, yz + 64 * last);
  }
}

template <bool direct>
HWY_INLINE void add_unit(const BlockUnits& u, const BlockRows& rows, int32_t n, float* sum) {
  const auto s = static_cast<size_t>(n);
  const auto row = static_cast<size_t>(u.begin[s] + (direct ? 0 : n));
  const int32_t atoms = u.begin[s + 1] - u.begin[s];
  const float *const x = rows.x.data() + 8 * row, *const yz = rows.yz.data() + 64 * row, p = u.exponent[s],
                     scale = direct ? hn::GetLane(exp2(hn::Set(f, log2_scale(p, u.log2_term[s])))) : 1;
  if (p == 1.0f)
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

void raise_group_simd(float p, float* from, float* to) {
  for (int32_t i = 0; i < 512; i += lanes) {
    const V v = hn::LoadU(f, from + i), least = hn::Set(f, 1.2e-38f);
    const V power = hn::IfThenElseZero(hn::Gt(v, least), exp2(hn::Mul(hn::Set(f, p), log2(hn::Max(v, least)))));
    hn::StoreU(hn::Add(hn::LoadU(f, to + i), power), f, to + i);
    hn::StoreU(hn::Zero(f), f, from + i);
  }
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

HWY_EXPORT(make_rows_simd);
HWY_EXPORT(add_units_simd);
HWY_EXPORT(raise_group_simd);
HWY_EXPORT(instruction_set_name);

void make_rows(const BlockUnits& units, const BlockShape& shape, BlockRows& rows) {
  HWY_DYNAMIC_DISPATCH(make_rows_simd)(units, shape, rows);
}
void add_units(const BlockUnits& units, const BlockRows& rows, int32_t first, int32_t last, float* sum) {
  HWY_DYNAMIC_DISPATCH(add_units_simd)(units, rows, first, last, sum);
}
void raise_group(float p, float* from, float* to) {
  HWY_DYNAMIC_DISPATCH(raise_group_simd)(p, from, to);
}
const char* instruction_set() {
  return HWY_DYNAMIC_DISPATCH(instruction_set_name)();
}

} // namespace molmesh::density
#endif
