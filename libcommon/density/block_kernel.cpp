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
  const V n = hn::Round(x);
  const auto scale = hn::ShiftLeft<23>(hn::ConvertTo(I(), n));
  return hn::BitCast(f, hn::Add(hn::BitCast(I(), polynomial(hn::Sub(x, n), c)), scale));
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

void log2_add(const float* base, float* v, int32_t n) {
  for (int32_t i = 0; i < n; i += lanes)
    hn::StoreU(hn::Add(hn::LoadU(f, base + i), log2(hn::LoadU(f, v + i))), f, v + i);
}

void upper_bounds_simd(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& b, float decay,
                       float* out) {
  std::vector<float>& base = []() -> std::vector<float>& {
    static thread_local std::vector<float> v;
    return v;
  }();
  base.assign(static_cast<size_t>(n) + 16, 0.0f);
  for (int32_t i = 0; i < n; ++i) {
    const size_t first = 16 * static_cast<size_t>(list[i]);
    const float s = shift(c, list[i], b, decay, false);
    V sum = hn::Zero(f);
    for (int32_t l = 0; l < 16; l += lanes) {
      const size_t a = first + static_cast<size_t>(l);
      const auto beyond = [&](const std::vector<float>& v, int axis) {
        const V d = hn::Abs(hn::Sub(hn::LoadU(f, &v[a]), hn::Set(f, b.middle[axis])));
        return hn::Max(hn::Sub(d, hn::Set(f, b.half[axis])), hn::Zero(f));
      };
      const V dx = beyond(c.atom_x, 0), dy = beyond(c.atom_y, 1), dz = beyond(c.atom_z, 2);
      const V d2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
      sum = hn::Add(
          sum, exp2(hn::NegMulAdd(d2, hn::Set(f, decay), hn::Sub(hn::LoadU(f, &c.atom_peak[a]), hn::Set(f, s)))));
    }
    base[static_cast<size_t>(i)] = s;
    out[i] = hn::GetLane(hn::SumOfLanes(f, sum));
  }
  std::fill_n(out + n, 16, 1.0f);
  log2_add(base.data(), out, n);
}

void middle_sums_simd(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& b, float decay,
                      float* sum, float* x, float* y, float* z) {
  std::vector<float>& base = []() -> std::vector<float>& {
    static thread_local std::vector<float> v;
    return v;
  }();
  base.assign(static_cast<size_t>(n) + 16, 0.0f);
  for (int32_t i = 0; i < n; ++i) {
    const size_t first = 16 * static_cast<size_t>(list[i]);
    const float s = shift(c, list[i], b, decay, true);
    V w = hn::Zero(f), wx = w, wy = w, wz = w;
    for (int32_t l = 0; l < 16; l += lanes) {
      const size_t a = first + static_cast<size_t>(l);
      const V px = hn::LoadU(f, &c.atom_x[a]), py = hn::LoadU(f, &c.atom_y[a]), pz = hn::LoadU(f, &c.atom_z[a]);
      const V dx = hn::Sub(px, hn::Set(f, b.middle[0])), dy = hn::Sub(py, hn::Set(f, b.middle[1])),
              dz = hn::Sub(pz, hn::Set(f, b.middle[2]));
      const V d2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
      const V e = exp2(hn::NegMulAdd(d2, hn::Set(f, decay), hn::Sub(hn::LoadU(f, &c.atom_peak[a]), hn::Set(f, s))));
      w = hn::Add(w, e);
      wx = hn::MulAdd(e, px, wx);
      wy = hn::MulAdd(e, py, wy);
      wz = hn::MulAdd(e, pz, wz);
    }
    const float total = hn::GetLane(hn::SumOfLanes(f, w));
    base[static_cast<size_t>(i)] = s;
    sum[i] = total;
    x[i] = hn::GetLane(hn::SumOfLanes(f, wx)) / total;
    y[i] = hn::GetLane(hn::SumOfLanes(f, wy)) / total;
    z[i] = hn::GetLane(hn::SumOfLanes(f, wz)) / total;
  }
  std::fill_n(sum + n, 16, 1.0f);
  log2_add(base.data(), sum, n);
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

void add_unit_simd(const UnitArguments& u, float* scratch, float* sum) {
  const int32_t n = u.atoms;
  float* const x = scratch;                                  // 24·(n + 1), then to a multiple of 16
  float* const yz = scratch + (24 * (n + 1) + 15) / 16 * 16; // 64·(n + 1)
  const auto axis = [](float* to, float a, float b, float c) {
    for (int32_t i = 0; i < 8; ++i) {
      const float t = static_cast<float>(i) - 3.5f;
      to[i] = (c * t + b) * t + a;
    }
  };
  const auto arguments = [&](int32_t row, const AxisArguments& g, float c) {
    axis(x + 24 * row, g.constant, g.x, c);
    axis(x + 24 * row + 8, 0, g.y, c);
    axis(x + 24 * row + 16, 0, g.z, c);
  };
  for (int32_t a = 0; a < n; ++a)
    arguments(a, u.atom[a], 0);
  arguments(n, u.outer, u.curvature);
  std::fill(x + 24 * (n + 1), yz, 0.0f);
  exp2_all_simd(x, static_cast<int32_t>(yz - x));
  for (int32_t a = 0; a <= n; ++a)
    for (int32_t j = 0; j < 8; ++j)
      for (int32_t k = 0; k < 8; ++k)
        yz[64 * a + 8 * j + k] = x[24 * a + 8 + j] * x[24 * a + 16 + k];
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

void classify_points_simd(const float* v, float lower, float upper, uint64_t* below, uint64_t* above) {
#if HWY_TARGET <= HWY_AVX2
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
  for (int32_t s = 0; s < 512; s += lanes)
    out += hn::CompressBlendedStore(hn::LoadU(f, v + s), hn::LoadMaskBits(f, bits + s / 8), f, out);
#else
  for (int32_t s = 0; s < 512; ++s)
    if (active[s >> 6] >> (s & 63) & 1)
      *out++ = v[s];
#endif
  return static_cast<int32_t>(out - begin);
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
HWY_EXPORT(middle_sums_simd);
HWY_EXPORT(exp2_all_simd);
HWY_EXPORT(add_unit_simd);
HWY_EXPORT(raise_group_simd);
HWY_EXPORT(classify_points_simd);
HWY_EXPORT(pack_active_simd);
HWY_EXPORT(instruction_set_name);

int32_t near_clusters(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& box, int32_t* out) {
  return HWY_DYNAMIC_DISPATCH(near_clusters_simd)(c, list, n, box, out);
}
void upper_bounds(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& box, float decay,
                  float* out) {
  HWY_DYNAMIC_DISPATCH(upper_bounds_simd)(c, list, n, box, decay, out);
}
void middle_sums(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& box, float decay,
                 float* sum, float* x, float* y, float* z) {
  HWY_DYNAMIC_DISPATCH(middle_sums_simd)(c, list, n, box, decay, sum, x, y, z);
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
void classify_points(const float* v, float lower, float upper, uint64_t* below, uint64_t* above) {
  HWY_DYNAMIC_DISPATCH(classify_points_simd)(v, lower, upper, below, above);
}
int32_t pack_active(const float* v, const uint64_t* active, float* out) {
  return HWY_DYNAMIC_DISPATCH(pack_active_simd)(v, active, out);
}
const char* instruction_set() {
  return HWY_DYNAMIC_DISPATCH(instruction_set_name)();
}

} // namespace molmesh::density
#endif
