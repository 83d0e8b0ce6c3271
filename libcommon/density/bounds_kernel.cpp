// bounds_kernel.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/bounds_kernel.hpp"
#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/bounds_kernel.cpp"
#include <hwy/foreach_target.h>

#include "density/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

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

void upper_sums_simd(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& b, float decay,
                     bool scaled, float* out, float* log2_scale) {
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
    log2_scale[i] = base;
  }
}

void power_terms_simd(float* log2_sum, const float* exponent, int32_t n, float* term) {
  for (int32_t i = 0; i < n; i += lanes)
    hn::StoreU(exp2(hn::Mul(hn::LoadU(f, log2_sum + i), hn::LoadU(f, exponent + i))), f, term + i);
}

void log2_all_simd(float* v, int32_t n) {
  for (int32_t i = 0; i < n; i += lanes)
    hn::StoreU(log2(hn::LoadU(f, v + i)), f, v + i);
}

/// Of the atoms of the clusters list[n] at a block's middle, scaled by 2^-base: sum of the terms and their moments.
HWY_INLINE void sum_at_middle(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& b,
                              float decay, float base, float* total) {
  const V mx = hn::Set(f, b.middle[0]), my = hn::Set(f, b.middle[1]), mz = hn::Set(f, b.middle[2]),
          k = hn::Set(f, decay), scale = hn::Set(f, base);
  V w = hn::Zero(f), wx = w, wy = w, wz = w;
  for (int32_t i = 0; i < n; ++i)
    for (int32_t l = 0; l < 16; l += lanes) {
      const size_t a = 16 * static_cast<size_t>(list[i]) + static_cast<size_t>(l);
      const V x = hn::LoadU(f, &c.atom_x[a]), y = hn::LoadU(f, &c.atom_y[a]), z = hn::LoadU(f, &c.atom_z[a]);
      const V dx = hn::Sub(x, mx), dy = hn::Sub(y, my), dz = hn::Sub(z, mz);
      const V d2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
      const V e = exp2(hn::NegMulAdd(d2, k, hn::Sub(hn::LoadU(f, &c.atom_peak[a]), scale)));
      w = hn::Add(w, e);
      wx = hn::MulAdd(e, x, wx);
      wy = hn::MulAdd(e, y, wy);
      wz = hn::MulAdd(e, z, wz);
    }
  total[0] = hn::GetLane(hn::SumOfLanes(f, w));
  total[1] = hn::GetLane(hn::SumOfLanes(f, wx));
  total[2] = hn::GetLane(hn::SumOfLanes(f, wy));
  total[3] = hn::GetLane(hn::SumOfLanes(f, wz));
}

/// Middles of units; false when single precision cannot tell or would overflow.
bool find_middles(const LocalClusters& c, const int32_t* list, const LocalBox& b, float decay, bool scaled,
                  BlockUnits& to) {
  const float least = 1e-30f;
  for (int32_t u = 0; u < to.n; ++u) {
    const auto s = static_cast<size_t>(u);
    const UnitRange r = to.range[s];
    const int32_t n = r.end - r.begin;
    float total[4], base = 0;
    if (!scaled)
      sum_at_middle(c, list + r.begin, n, b, decay, 0, total);
    if (scaled || total[0] < least) {
      base = -1e30f;
      for (int32_t i = r.begin; i < r.end; ++i)
        base = std::max(base, shift(c, list[i], b, decay, true));
      sum_at_middle(c, list + r.begin, n, b, decay, base, total);
      if (total[0] < least)
        return false;
    }
    to.log2_sum[s] = total[0];
    to.x[s] = total[1];
    to.y[s] = total[2];
    to.z[s] = total[3];
    to.log2_scale[s] = base;
  }
  const auto pad = static_cast<size_t>(to.n);
  for (std::vector<float>* v : {&to.log2_sum, &to.x, &to.y, &to.z, &to.log2_scale, &to.exponent})
    std::fill_n(v->begin() + static_cast<std::ptrdiff_t>(pad), 16, 1.0f);
  V farthest = hn::Zero(f);
  const V k = hn::Set(f, 2 * decay);
  for (int32_t u = 0; u < to.n; u += lanes) {
    const V total = hn::LoadU(f, &to.log2_sum[static_cast<size_t>(u)]), per = hn::Div(hn::Set(f, 1.0f), total);
    V away = hn::Zero(f);
    int axis = 0;
    for (std::vector<float>* v : {&to.x, &to.y, &to.z}) {
      float* const at = &(*v)[static_cast<size_t>(u)];
      const V center = hn::Mul(hn::LoadU(f, at), per);
      hn::StoreU(center, f, at);
      away = hn::MulAdd(hn::Set(f, b.half[axis]), hn::Abs(hn::Sub(center, hn::Set(f, b.middle[axis]))), away);
      ++axis;
    }
    float* const sum = &to.log2_sum[static_cast<size_t>(u)];
    hn::StoreU(hn::Add(log2(total), hn::LoadU(f, &to.log2_scale[static_cast<size_t>(u)])), f, sum);
    away = hn::Mul(hn::Mul(away, k), hn::LoadU(f, &to.exponent[static_cast<size_t>(u)]));
    const auto used = hn::Lt(hn::Iota(f, static_cast<float>(u)), hn::Set(f, static_cast<float>(to.n)));
    farthest = hn::Max(farthest, hn::IfThenElseZero(used, away));
  }
  return hn::GetLane(hn::MaxOfLanes(f, farthest)) <= log2_range;
}

bool take_units_simd(const LocalClusters& c, const int32_t* list, const LocalBox& b, float decay, float within,
                     bool scaled, BlockUnits& to) {
  if (!find_middles(c, list, b, decay, scaled, to))
    return false;
  const V mx = hn::Set(f, b.middle[0]), my = hn::Set(f, b.middle[1]), mz = hn::Set(f, b.middle[2]),
          k = hn::Set(f, decay);
  const V sx = hn::Set(f, 2 * decay * b.half[0] / 3.5f), sy = hn::Set(f, 2 * decay * b.half[1] / 3.5f),
          sz = hn::Set(f, 2 * decay * b.half[2] / 3.5f);
  V widest = hn::Zero(f);
  size_t kept = 0;
  for (int32_t u = 0; u < to.n; ++u) {
    const auto s = static_cast<size_t>(u);
    const UnitRange r = to.range[s];
    // T ≥ 1, so atoms whose terms of T together stay below η are at most η of the sum (field.md §4).
    const float small = within > 0 ? std::log2(within / static_cast<float>(16 * (r.end - r.begin))) : -1e30f;
    const V cx = hn::Set(f, to.x[s]), cy = hn::Set(f, to.y[s]), cz = hn::Set(f, to.z[s]),
            sum = hn::Set(f, to.log2_sum[s]), least = hn::Set(f, small);
    for (int32_t i = r.begin; i < r.end; ++i)
      for (int32_t l = 0; l < 16; l += lanes) {
        const size_t a = 16 * static_cast<size_t>(list[i]) + static_cast<size_t>(l);
        const V ax = hn::LoadU(f, &c.atom_x[a]), ay = hn::LoadU(f, &c.atom_y[a]), az = hn::LoadU(f, &c.atom_z[a]);
        const V dx = hn::Sub(ax, mx), dy = hn::Sub(ay, my), dz = hn::Sub(az, mz);
        const V d2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
        const V weight = hn::Sub(hn::NegMulAdd(d2, k, hn::LoadU(f, &c.atom_peak[a])), sum);
        const V x = hn::Mul(hn::Sub(ax, cx), sx), y = hn::Mul(hn::Sub(ay, cy), sy),
                z = hn::Mul(hn::Sub(az, cz), sz);
        const V swing = hn::Mul(hn::Set(f, 3.5f), hn::Add(hn::Abs(x), hn::Add(hn::Abs(y), hn::Abs(z))));
        // Unused slots have a peak of -1e30: never kept.
        const auto keep = hn::And(hn::Ge(hn::Add(weight, swing), least), hn::Gt(weight, hn::Set(f, -1e29f)));
        widest = hn::Max(widest, hn::IfThenElseZero(keep, swing));
        hn::StoreU(hn::Compress(x, keep), f, &to.atom_x[kept]);
        hn::StoreU(hn::Compress(y, keep), f, &to.atom_y[kept]);
        hn::StoreU(hn::Compress(z, keep), f, &to.atom_z[kept]);
        hn::StoreU(hn::Compress(weight, keep), f, &to.atom_constant[kept]);
        kept += hn::CountTrue(f, keep);
      }
    to.begin[s + 1] = static_cast<int32_t>(kept);
  }
  return hn::GetLane(hn::MaxOfLanes(f, widest)) <= log2_range;
}

void sum_of_powers_simd(const BlockUnits& units, const LocalBox& b, float decay, float* value, float* gradient) {
  V sum = hn::Zero(f), gx = sum, gy = sum, gz = sum;
  for (int32_t u = 0; u < units.n; u += lanes) {
    const auto s = static_cast<size_t>(u);
    const V p = hn::LoadU(f, &units.exponent[s]);
    const auto used = hn::Lt(hn::Iota(f, static_cast<float>(u)), hn::Set(f, static_cast<float>(units.n)));
    const V e = hn::IfThenElseZero(used, exp2(hn::Mul(p, hn::LoadU(f, &units.log2_sum[s])))), ep = hn::Mul(e, p);
    sum = hn::Add(sum, e);
    gx = hn::MulAdd(ep, hn::Sub(hn::LoadU(f, &units.x[s]), hn::Set(f, b.middle[0])), gx);
    gy = hn::MulAdd(ep, hn::Sub(hn::LoadU(f, &units.y[s]), hn::Set(f, b.middle[1])), gy);
    gz = hn::MulAdd(ep, hn::Sub(hn::LoadU(f, &units.z[s]), hn::Set(f, b.middle[2])), gz);
  }
  *value = hn::GetLane(hn::SumOfLanes(f, sum));
  gradient[0] = 2 * decay * hn::GetLane(hn::SumOfLanes(f, gx));
  gradient[1] = 2 * decay * hn::GetLane(hn::SumOfLanes(f, gy));
  gradient[2] = 2 * decay * hn::GetLane(hn::SumOfLanes(f, gz));
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::density {

HWY_EXPORT(near_clusters_simd);
HWY_EXPORT(upper_sums_simd);
HWY_EXPORT(power_terms_simd);
HWY_EXPORT(log2_all_simd);
HWY_EXPORT(take_units_simd);
HWY_EXPORT(sum_of_powers_simd);

int32_t near_clusters(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& box, int32_t* out) {
  return HWY_DYNAMIC_DISPATCH(near_clusters_simd)(c, list, n, box, out);
}
void upper_sums(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& box, float decay,
                bool scaled, float* out, float* log2_scale) {
  HWY_DYNAMIC_DISPATCH(upper_sums_simd)(c, list, n, box, decay, scaled, out, log2_scale);
}
void power_terms(float* log2_sum, const float* exponent, int32_t n, float* term) {
  HWY_DYNAMIC_DISPATCH(power_terms_simd)(log2_sum, exponent, n, term);
}
void log2_all(float* v, int32_t n) {
  HWY_DYNAMIC_DISPATCH(log2_all_simd)(v, n);
}
bool take_units(const LocalClusters& c, const int32_t* list, const LocalBox& block, float decay, float within,
                bool scaled, BlockUnits& units) {
  return HWY_DYNAMIC_DISPATCH(take_units_simd)(c, list, block, decay, within, scaled, units);
}
void sum_of_powers(const BlockUnits& units, const LocalBox& block, float decay, float* value, float* gradient) {
  HWY_DYNAMIC_DISPATCH(sum_of_powers_simd)(units, block, decay, value, gradient);
}

} // namespace molmesh::density
#endif
