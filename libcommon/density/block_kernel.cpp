// block_kernel.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/block_kernel.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/block_kernel.cpp"
#include <hwy/foreach_target.h>
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

template <size_t N>
HWY_INLINE V polynomial(V x, const float (&c)[N]) {
  V p = hn::Set(f, c[N - 1]);
  for (size_t i = N - 1; i-- > 0;)
    p = hn::MulAdd(p, x, hn::Set(f, c[i]));
  return p;
}

/// Chebyshev interpolant of 2^x on [-1/2, 1/2]: 1.0e-7.
HWY_INLINE V exp2(V x) {
  constexpr float c[] = {1.00000007545f, 0.69314718803f, 0.24022107485f,
                         0.05550357114f, 0.00967603192f, 0.00133908634f};
  x = hn::Min(hn::Max(x, hn::Set(f, -126.0f)), hn::Set(f, 127.0f));
  const V big = hn::Set(f, 12582912.0f), shifted = hn::Add(x, big); // 1.5·2^23: the sum's low bits are x rounded
  const V t = hn::Sub(x, hn::Sub(shifted, big));
  return hn::BitCast(f, hn::Add(hn::BitCast(I(), polynomial(t, c)), hn::ShiftLeft<23>(hn::BitCast(I(), shifted))));
}

/// x normal and positive. Chebyshev interpolant of log2(1 + t)/t on [√½ - 1, √2 - 1]: 1.9e-7.
HWY_INLINE V log2(V x) {
  constexpr float c[] = {1.44269499f, -0.72135293f, 0.48091671f, -0.36022518f,
                         0.28728888f, -0.24927182f, 0.23265258f, -0.14275973f};
  const auto bits = hn::BitCast(I(), x);
  const auto n = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(I(), 0x3f3504f3)));
  const V t = hn::Sub(hn::BitCast(f, hn::Sub(bits, hn::ShiftLeft<23>(n))), hn::Set(f, 1.0f));
  return hn::MulAdd(t, polynomial(t, c), hn::ConvertTo(f, n));
}

HWY_INLINE V square_root(V x) { // one Newton step on the machine's estimate: 3e-7
  const V r = hn::ApproximateReciprocalSqrt(x);
  const V half_xr = hn::Mul(hn::Mul(x, r), hn::Set(f, 0.5f));
  return hn::Mul(hn::Mul(x, r), hn::NegMulAdd(half_xr, r, hn::Set(f, 1.5f)));
}

HWY_INLINE V distance_beyond(V lo, V hi, float middle, float half) {
  const V below = hn::Sub(lo, hn::Set(f, middle + half)), above = hn::Sub(hn::Set(f, middle - half), hi);
  return hn::Max(hn::Max(below, above), hn::Zero(f));
}

int32_t near_clusters_simd(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& b,
                           int32_t* out) {
  int32_t found = 0;
  for (int32_t i = 0; i < n; i += lanes) {
    HWY_ALIGN int32_t index[lanes];
    for (int32_t l = 0; l < lanes; ++l)
      index[l] = list[std::min(i + l, n - 1)];
    const auto at = hn::Load(I(), index);
    const auto get = [&](const std::vector<float>& v) { return hn::GatherIndex(f, v.data(), at); };
    const V dx = distance_beyond(get(c.lo_x), get(c.hi_x), b.middle[0], b.half[0]);
    const V dy = distance_beyond(get(c.lo_y), get(c.hi_y), b.middle[1], b.half[1]);
    const V dz = distance_beyond(get(c.lo_z), get(c.hi_z), b.middle[2], b.half[2]);
    const V d2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    HWY_ALIGN float excess[lanes];
    hn::Store(hn::Sub(d2, get(c.cutoff2)), f, excess);
    for (int32_t l = 0; l < lanes && i + l < n; ++l) {
      out[found] = index[l];
      found += excess[l] < 0;
    }
  }
  return found;
}

/// log2 of the largest term any atom of the cluster can have at the point or box at squared distance d2.
HWY_INLINE float shift(const LocalClusters& c, int32_t k, const LocalBox& b, float decay, bool point) {
  const auto s = static_cast<size_t>(k);
  float d2 = 0;
  const float lo[3] = {c.lo_x[s], c.lo_y[s], c.lo_z[s]}, hi[3] = {c.hi_x[s], c.hi_y[s], c.hi_z[s]};
  for (int a = 0; a < 3; ++a) {
    const float half = point ? 0 : b.half[a];
    const float d = std::max({lo[a] - b.middle[a] - half, b.middle[a] - half - hi[a], 0.0f});
    d2 += d * d;
  }
  return c.peak[s] - decay * d2;
}

void upper_bounds_simd(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& b, float decay,
                       bool scaled, float* out) {
  const V mx = hn::Set(f, b.middle[0]), my = hn::Set(f, b.middle[1]), mz = hn::Set(f, b.middle[2]);
  const V hx = hn::Set(f, b.half[0]), hy = hn::Set(f, b.half[1]), hz = hn::Set(f, b.half[2]);
  const V k = hn::Set(f, decay), zero = hn::Zero(f);
  const auto beyond = [zero](const float* v, V middle, V half) {
    return hn::Max(hn::Sub(hn::Abs(hn::Sub(hn::LoadU(f, v), middle)), half), zero);
  };
  for (int32_t i = 0; i < n; ++i) {
    const size_t first = 16 * static_cast<size_t>(list[i]);
    const float base = scaled ? shift(c, list[i], b, decay, false) : 0.0f;
    V sum = zero;
    for (int32_t l = 0; l < 16; l += lanes) {
      const size_t a = first + static_cast<size_t>(l);
      const V dx = beyond(&c.atom_x[a], mx, hx), dy = beyond(&c.atom_y[a], my, hy),
              dz = beyond(&c.atom_z[a], mz, hz);
      const V d2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
      sum = hn::Add(sum, exp2(hn::NegMulAdd(d2, k, hn::Sub(hn::LoadU(f, &c.atom_peak[a]), hn::Set(f, base)))));
    }
    out[i] = hn::GetLane(hn::SumOfLanes(f, sum));
  }
  std::fill_n(out + n, 16, 1.0f);
  for (int32_t i = 0; i < n; i += lanes)
    hn::StoreU(log2(hn::LoadU(f, out + i)), f, out + i);
  if (scaled)
    for (int32_t i = 0; i < n; ++i)
      out[i] += shift(c, list[i], b, decay, false);
}

bool take_unit_simd(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& b, float decay,
                    float log2_small, const AtomArguments& to, UnitMiddle& middle) {
  float base = -1e30f;
  for (int32_t i = 0; i < n; ++i)
    base = std::max(base, shift(c, list[i], b, decay, true));
  const V mx = hn::Set(f, b.middle[0]), my = hn::Set(f, b.middle[1]), mz = hn::Set(f, b.middle[2]);
  const V k = hn::Set(f, decay);
  const auto log2_term = [&](size_t a) {
    const V dx = hn::Sub(hn::LoadU(f, &c.atom_x[a]), mx), dy = hn::Sub(hn::LoadU(f, &c.atom_y[a]), my),
            dz = hn::Sub(hn::LoadU(f, &c.atom_z[a]), mz);
    const V d2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    return hn::NegMulAdd(d2, k, hn::LoadU(f, &c.atom_peak[a]));
  };
  V w = hn::Zero(f), wx = w, wy = w, wz = w;
  for (int32_t i = 0; i < n; ++i)
    for (int32_t l = 0; l < 16; l += lanes) {
      const size_t a = 16 * static_cast<size_t>(list[i]) + static_cast<size_t>(l);
      const V e = exp2(hn::Sub(log2_term(a), hn::Set(f, base)));
      w = hn::Add(w, e);
      wx = hn::MulAdd(e, hn::LoadU(f, &c.atom_x[a]), wx);
      wy = hn::MulAdd(e, hn::LoadU(f, &c.atom_y[a]), wy);
      wz = hn::MulAdd(e, hn::LoadU(f, &c.atom_z[a]), wz);
    }
  const V total = hn::SumOfLanes(f, w);
  if (hn::GetLane(total) < 1e-30f)
    return false;
  const V per_total = hn::Div(hn::Set(f, 1.0f), total);
  const V cx = hn::Mul(hn::SumOfLanes(f, wx), per_total), cy = hn::Mul(hn::SumOfLanes(f, wy), per_total),
          cz = hn::Mul(hn::SumOfLanes(f, wz), per_total), sum = hn::Add(log2(total), hn::Set(f, base));
  const V sx = hn::Set(f, 2 * decay * b.half[0] / 3.5f), sy = hn::Set(f, 2 * decay * b.half[1] / 3.5f),
          sz = hn::Set(f, 2 * decay * b.half[2] / 3.5f);
  V widest = hn::Zero(f);
  size_t kept = 0;
  for (int32_t i = 0; i < n; ++i)
    for (int32_t l = 0; l < 16; l += lanes) {
      const size_t a = 16 * static_cast<size_t>(list[i]) + static_cast<size_t>(l);
      const V x = hn::Mul(hn::Sub(hn::LoadU(f, &c.atom_x[a]), cx), sx),
              y = hn::Mul(hn::Sub(hn::LoadU(f, &c.atom_y[a]), cy), sy),
              z = hn::Mul(hn::Sub(hn::LoadU(f, &c.atom_z[a]), cz), sz);
      const V swing = hn::Mul(hn::Set(f, 3.5f), hn::Add(hn::Abs(x), hn::Add(hn::Abs(y), hn::Abs(z))));
      const V weight = hn::Sub(log2_term(a), sum);
      // Unused slots have a peak of -1e30: never kept.
      const auto keep =
          hn::And(hn::Ge(hn::Add(weight, swing), hn::Set(f, log2_small)), hn::Gt(weight, hn::Set(f, -1e29f)));
      widest = hn::Max(widest, hn::IfThenElseZero(keep, swing));
      hn::CompressBlendedStore(x, keep, f, to.x + kept);
      hn::CompressBlendedStore(y, keep, f, to.y + kept);
      hn::CompressBlendedStore(z, keep, f, to.z + kept);
      kept += hn::CompressBlendedStore(weight, keep, f, to.constant + kept);
    }
  middle = {hn::GetLane(sum),
            {hn::GetLane(cx), hn::GetLane(cy), hn::GetLane(cz)},
            hn::GetLane(hn::MaxOfLanes(f, widest)),
            static_cast<int32_t>(kept)};
  return true;
}

void exp2_all_simd(float* v, int32_t n) {
  for (int32_t i = 0; i < n; i += lanes)
    hn::StoreU(exp2(hn::LoadU(f, v + i)), f, v + i);
}

struct One {
  HWY_INLINE V operator()(V t) const { return t; }
};
struct Half {
  HWY_INLINE V operator()(V t) const { return square_root(t); }
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

/// x: [24·(n + 1)] factors by axis, yz: [64·(n + 1)] their products; the last row multiplies the power.
template <class Power>
HWY_INLINE void accumulate(const float* x, const float* yz, int32_t n, Power power, float* sum) {
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
          const V xi = hn::Set(f, x[24 * a + i0 + i]);
          for (int32_t v = 0; v < tile_v; ++v)
            t[i][v] = hn::MulAdd(xi, row[v], t[i][v]);
        }
      }
      for (int32_t i = 0; i < tile_i; ++i) {
        const V xi = hn::Set(f, x[24 * n + i0 + i]);
        for (int32_t v = 0; v < tile_v; ++v) {
          float* const to = sum + 64 * (i0 + i) + v0 + lanes * v;
          const V outer = hn::Mul(xi, hn::LoadU(f, yz + 64 * n + v0 + lanes * v));
          hn::StoreU(hn::MulAdd(power(t[i][v]), outer, hn::LoadU(f, to)), f, to);
        }
      }
    }
}

/// yz[64 r + 8 j + k] = y_j·z_k of row r, whose factors of y and z lie at x + 24 r + 8.
void multiply_axes(const float* x, int32_t rows, float* yz) {
  if constexpr (lanes == 16) {
    HWY_ALIGN int32_t index[5][16]; // of y for two j at a time; of z
    for (int32_t l = 0; l < 16; ++l) {
      for (int32_t v = 0; v < 4; ++v)
        index[v][l] = 2 * v + l / 8;
      index[4][l] = 8 + l % 8;
    }
    const auto y0 = hn::SetTableIndices(f, index[0]), y1 = hn::SetTableIndices(f, index[1]),
               y2 = hn::SetTableIndices(f, index[2]), y3 = hn::SetTableIndices(f, index[3]),
               zz = hn::SetTableIndices(f, index[4]);
    for (int32_t r = 0; r < rows; ++r, yz += 64) {
      const V both = hn::LoadU(f, x + 24 * r + 8), z = hn::TableLookupLanes(both, zz);
      hn::StoreU(hn::Mul(hn::TableLookupLanes(both, y0), z), f, yz);
      hn::StoreU(hn::Mul(hn::TableLookupLanes(both, y1), z), f, yz + 16);
      hn::StoreU(hn::Mul(hn::TableLookupLanes(both, y2), z), f, yz + 32);
      hn::StoreU(hn::Mul(hn::TableLookupLanes(both, y3), z), f, yz + 48);
    }
  } else {
    using F8 = hn::CappedTag<float, 8>;
    constexpr F8 f8{};
    constexpr int32_t lanes8 = static_cast<int32_t>(HWY_MIN(8, HWY_LANES(float)));
    for (int32_t r = 0; r < rows; ++r)
      for (int32_t l = 0; l < 8; l += lanes8) {
        const auto z = hn::LoadU(f8, x + 24 * r + 16 + l);
        for (int32_t j = 0; j < 8; ++j)
          hn::StoreU(hn::Mul(hn::Set(f8, x[24 * r + 8 + j]), z), f8, yz + 64 * r + 8 * j + l);
      }
  }
}

void add_unit_simd(const UnitArguments& u, float* scratch, float* sum) {
  const int32_t n = u.atoms;
  float* const x = scratch;                                  // 24·(n + 1), then to a multiple of 16
  float* const yz = scratch + (24 * (n + 1) + 15) / 16 * 16; // 64·(n + 1)
  using F8 = hn::CappedTag<float, 8>;
  constexpr F8 f8{};
  constexpr int32_t lanes8 = static_cast<int32_t>(HWY_MIN(8, HWY_LANES(float)));
  for (int32_t l = 0; l < 8; l += lanes8) {
    const auto t = hn::Add(hn::Iota(f8, static_cast<float>(l)), hn::Set(f8, -3.5f));
    for (int32_t a = 0; a < n; ++a) {
      hn::StoreU(hn::MulAdd(hn::Set(f8, u.atom.x[a]), t, hn::Set(f8, u.atom.constant[a])), f8, x + 24 * a + l);
      hn::StoreU(hn::Mul(hn::Set(f8, u.atom.y[a]), t), f8, x + 24 * a + 8 + l);
      hn::StoreU(hn::Mul(hn::Set(f8, u.atom.z[a]), t), f8, x + 24 * a + 16 + l);
    }
    for (int32_t axis = 0; axis < 3; ++axis) {
      const auto slope = hn::MulAdd(hn::Set(f8, u.curvature), t, hn::Set(f8, u.slope[axis]));
      hn::StoreU(hn::MulAdd(slope, t, hn::Set(f8, axis == 0 ? u.constant : 0.0f)), f8, x + 24 * n + 8 * axis + l);
    }
  }
  std::fill(x + 24 * (n + 1), yz, 0.0f);
  exp2_all_simd(x, static_cast<int32_t>(yz - x));
  multiply_axes(x, n + 1, yz);
  if (u.exponent == 1.0f)
    accumulate(x, yz, n, One{}, sum);
  else if (u.exponent == 0.5f)
    accumulate(x, yz, n, Half{}, sum);
  else if (u.exponent == 2.0f)
    accumulate(x, yz, n, Two{}, sum);
  else
    accumulate(x, yz, n, Any{hn::Set(f, u.exponent)}, sum);
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

HWY_EXPORT(near_clusters_simd);
HWY_EXPORT(upper_bounds_simd);
HWY_EXPORT(take_unit_simd);
HWY_EXPORT(exp2_all_simd);
HWY_EXPORT(add_unit_simd);
HWY_EXPORT(raise_group_simd);
HWY_EXPORT(instruction_set_name);

int32_t near_clusters(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& box, int32_t* out) {
  return HWY_DYNAMIC_DISPATCH(near_clusters_simd)(c, list, n, box, out);
}
void upper_bounds(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& box, float decay,
                  bool scaled, float* out) {
  HWY_DYNAMIC_DISPATCH(upper_bounds_simd)(c, list, n, box, decay, scaled, out);
}
bool take_unit(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& block, float decay,
               float log2_small, const AtomArguments& to, UnitMiddle& middle) {
  return HWY_DYNAMIC_DISPATCH(take_unit_simd)(c, list, n, block, decay, log2_small, to, middle);
}
void exp2_all(float* v, int32_t n) {
  HWY_DYNAMIC_DISPATCH(exp2_all_simd)(v, n);
}
void add_unit(const UnitArguments& unit, float* scratch, float* sum) {
  HWY_DYNAMIC_DISPATCH(add_unit_simd)(unit, scratch, sum);
}
void raise_group(float p, float* from, float* to) {
  HWY_DYNAMIC_DISPATCH(raise_group_simd)(p, from, to);
}
const char* instruction_set() {
  return HWY_DYNAMIC_DISPATCH(instruction_set_name)();
}

} // namespace molmesh::density
#endif
