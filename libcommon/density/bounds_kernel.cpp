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

int32_t near_clusters_simd(const LocalClusters& c, int32_t n, const LocalBox& b, int32_t* out) {
  int32_t found = 0;
  for (int32_t i = 0; i < n; i += lanes) {
    const auto get = [&](const std::vector<float>& v) { return hn::LoadU(f, v.data() + i); };
    const V dx = distance_beyond(get(c.lo_x), get(c.hi_x), b.middle[0], b.half[0]);
    const V dy = distance_beyond(get(c.lo_y), get(c.hi_y), b.middle[1], b.half[1]);
    const V dz = distance_beyond(get(c.lo_z), get(c.hi_z), b.middle[2], b.half[2]);
    const V d2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    HWY_ALIGN float excess[lanes];
    hn::Store(hn::Sub(d2, get(c.cutoff2)), f, excess);
    for (int32_t l = 0; l < lanes && i + l < n; ++l) {
      out[found] = i + l;
      found += excess[l] < 0;
    }
  }
  return found;
}

void bound_units_simd(const NearUnits& u, const LocalBox& b, float decay, bool scaled, float* log2_upper) {
  const V mx = hn::Set(f, b.middle[0]), my = hn::Set(f, b.middle[1]), mz = hn::Set(f, b.middle[2]);
  const V hx = hn::Set(f, b.half[0]), hy = hn::Set(f, b.half[1]), hz = hn::Set(f, b.half[2]);
  const V k = hn::Set(f, decay), zero = hn::Zero(f);
  const auto beyond = [zero](const float* v, V middle, V half) {
    return hn::Max(hn::Sub(hn::Abs(hn::Sub(hn::LoadU(f, v), middle)), half), zero);
  };
  const auto log2_term = [&](size_t a) {
    const V dx = beyond(&u.atom_x[a], mx, hx), dy = beyond(&u.atom_y[a], my, hy), dz = beyond(&u.atom_z[a], mz, hz);
    const V d2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    return hn::NegMulAdd(d2, k, hn::LoadU(f, &u.atom_peak[a]));
  };
  for (int32_t n = 0; n < u.n; ++n) {
    const size_t begin = 16 * static_cast<size_t>(u.begin[static_cast<size_t>(n)]),
                 end = 16 * static_cast<size_t>(u.begin[static_cast<size_t>(n) + 1]);
    V scale = zero;
    if (scaled) {
      V largest = hn::Set(f, -1e30f);
      for (size_t a = begin; a < end; a += lanes)
        largest = hn::Max(largest, log2_term(a));
      scale = hn::MaxOfLanes(f, largest);
    }
    V sum = zero;
    for (size_t a = begin; a < end; a += lanes)
      sum = hn::Add(sum, exp2(hn::Sub(log2_term(a), scale)));
    sum = hn::SumOfLanes(f, sum);
    log2_upper[n] = hn::GetLane(scaled ? hn::Add(scale, log2(sum)) : sum);
  }
  std::fill_n(log2_upper + u.n, 16, 1.0f);
  if (!scaled)
    for (int32_t n = 0; n < u.n; n += lanes)
      hn::StoreU(log2(hn::LoadU(f, log2_upper + n)), f, log2_upper + n);
}

void power_terms_simd(const float* log2_sum, const float* exponent, int32_t n, float* term) {
  for (int32_t i = 0; i < n; i += lanes)
    hn::StoreU(exp2(hn::Min(hn::Mul(hn::LoadU(f, log2_sum + i), hn::LoadU(f, exponent + i)), hn::Set(f, 127.0f))),
               f, term + i);
}

float sum_up_to_simd(const float* v, int32_t n, float limit) {
  V sum = hn::Zero(f);
  for (int32_t i = 0; i < n; i += lanes) {
    const V x = hn::LoadU(f, v + i);
    const auto used = hn::Lt(hn::Iota(f, static_cast<float>(i)), hn::Set(f, static_cast<float>(n)));
    sum = hn::Add(sum, hn::IfThenElseZero(hn::And(used, hn::Le(x, hn::Set(f, limit))), x));
  }
  return hn::GetLane(hn::SumOfLanes(f, sum));
}

/// log2 of the atoms' terms at a point.
struct TermsAt {
  V x, y, z, k;
  HWY_INLINE V operator()(V ax, V ay, V az, V peak) const {
    const V dx = hn::Sub(ax, x), dy = hn::Sub(ay, y), dz = hn::Sub(az, z);
    return hn::NegMulAdd(hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))), k, peak);
  }
};

bool take_units_simd(const NearUnits& from, const int32_t* list, int32_t n, const LocalBox& b, float decay,
                     float within, BlockUnits& to) {
  const TermsAt middle{hn::Set(f, b.middle[0]), hn::Set(f, b.middle[1]), hn::Set(f, b.middle[2]),
                       hn::Set(f, decay)};
  const V sx = hn::Set(f, 2 * decay * b.half[0] / 3.5f), sy = hn::Set(f, 2 * decay * b.half[1] / 3.5f),
          sz = hn::Set(f, 2 * decay * b.half[2] / 3.5f);
  const float log2_within = within > 0 ? std::log2(within / 16) : -1e30f;
  V widest = hn::Zero(f);
  size_t kept = 0;
  for (int32_t u = 0; u < n; ++u) {
    const auto s = static_cast<size_t>(u), at = static_cast<size_t>(list[u]);
    const size_t begin = 16 * static_cast<size_t>(from.begin[at]),
                 end = 16 * static_cast<size_t>(from.begin[at + 1]);
    const auto log2_term = [&](size_t a) {
      return middle(hn::LoadU(f, &from.atom_x[a]), hn::LoadU(f, &from.atom_y[a]), hn::LoadU(f, &from.atom_z[a]),
                    hn::LoadU(f, &from.atom_peak[a]));
    };
    // The atom with the largest term in the middle: of T its term is 1 everywhere (field.md §4).
    V largest = hn::Set(f, -2e30f), where = hn::Zero(f);
    for (size_t a = begin; a < end; a += lanes) {
      const V term = log2_term(a);
      const auto more = hn::Gt(term, largest);
      largest = hn::IfThenElse(more, term, largest);
      where = hn::IfThenElse(more, hn::Set(f, static_cast<float>(a - begin)), where);
    }
    const V log2_largest = hn::MaxOfLanes(f, largest);
    const intptr_t lane = hn::FindFirstTrue(f, hn::Eq(largest, log2_largest));
    size_t first = begin + static_cast<size_t>(lane);
    if (end - begin > static_cast<size_t>(lanes)) {
      HWY_ALIGN float offset[lanes];
      hn::Store(where, f, offset);
      first += static_cast<size_t>(offset[lane]);
    }
    to.exponent[s] = from.exponent[at];
    to.log2_term[s] = hn::GetLane(log2_largest);
    to.x[s] = from.atom_x[first];
    to.y[s] = from.atom_y[first];
    to.z[s] = from.atom_z[first];
    // T ≥ 1, so atoms whose terms of T together stay below η are at most η of the sum.
    const float slots = static_cast<float>(end - begin) / 16;
    const V least = hn::Set(f, slots == 1 ? log2_within : log2_within - std::log2(slots));
    const V cx = hn::Set(f, to.x[s]), cy = hn::Set(f, to.y[s]), cz = hn::Set(f, to.z[s]);
    for (size_t a = begin; a < end; a += lanes) {
      const V ax = hn::LoadU(f, &from.atom_x[a]), ay = hn::LoadU(f, &from.atom_y[a]),
              az = hn::LoadU(f, &from.atom_z[a]);
      const V weight = hn::Sub(middle(ax, ay, az, hn::LoadU(f, &from.atom_peak[a])), log2_largest);
      V x = hn::Mul(hn::Sub(ax, cx), sx), y = hn::Mul(hn::Sub(ay, cy), sy), z = hn::Mul(hn::Sub(az, cz), sz);
      V swing = hn::Mul(hn::Set(f, 3.5f), hn::Add(hn::Abs(x), hn::Add(hn::Abs(y), hn::Abs(z))));
      // Unused slots have a peak of -1e30: never kept.
      const auto keep = hn::And(hn::Ge(hn::Add(weight, swing), least), hn::Gt(weight, hn::Set(f, -1e29f)));
      if (to.direct) {
        x = hn::Mul(hn::Sub(ax, middle.x), sx);
        y = hn::Mul(hn::Sub(ay, middle.y), sy);
        z = hn::Mul(hn::Sub(az, middle.z), sz);
        swing = hn::MulAdd(hn::Set(f, 3.5f), hn::Add(hn::Abs(x), hn::Add(hn::Abs(y), hn::Abs(z))), weight);
      }
      widest = hn::Max(widest, hn::IfThenElseZero(keep, swing));
      hn::StoreU(hn::Compress(x, keep), f, &to.atom_x[kept]);
      hn::StoreU(hn::Compress(y, keep), f, &to.atom_y[kept]);
      hn::StoreU(hn::Compress(z, keep), f, &to.atom_z[kept]);
      hn::StoreU(hn::Compress(weight, keep), f, &to.atom_constant[kept]);
      kept += hn::CountTrue(f, keep);
    }
    to.begin[s + 1] = static_cast<int32_t>(kept);
  }
  to.n = n;
  for (std::vector<float>* v : {&to.exponent, &to.log2_term, &to.x, &to.y, &to.z})
    std::fill_n(v->begin() + n, 16, 0.0f);
  const V twice = hn::Set(f, 2 * decay);
  const float bend = decay * (b.half[0] * b.half[0] + b.half[1] * b.half[1] + b.half[2] * b.half[2]);
  for (int32_t u = 0; u < n; u += lanes) {
    V away = hn::Zero(f);
    int axis = 0;
    for (const std::vector<float>* v : {&to.x, &to.y, &to.z}) {
      const V center = hn::LoadU(f, v->data() + u);
      away = hn::MulAdd(hn::Set(f, b.half[axis]), hn::Abs(hn::Sub(center, hn::Set(f, b.middle[axis]))), away);
      ++axis;
    }
    away = to.direct ? hn::MulAdd(away, twice, hn::Set(f, bend))
                     : hn::Mul(hn::Mul(away, twice), hn::LoadU(f, to.exponent.data() + u));
    const auto used = hn::Lt(hn::Iota(f, static_cast<float>(u)), hn::Set(f, static_cast<float>(n)));
    widest = hn::Max(widest, hn::IfThenElseZero(used, away));
  }
  return hn::GetLane(hn::MaxOfLanes(f, widest)) <= log2_range;
}

void unit_middles_simd(const BlockUnits& u, const LocalBox& b, float decay, UnitMiddles& to) {
  for (int32_t n = 0; n < u.n; ++n) {
    const auto s = static_cast<size_t>(n);
    V w = hn::Zero(f), wx = w, wy = w, wz = w;
    for (int32_t a = u.begin[s]; a < u.begin[s + 1]; a += lanes) {
      const auto used = hn::Lt(hn::Iota(f, static_cast<float>(a - u.begin[s])),
                               hn::Set(f, static_cast<float>(u.begin[s + 1] - u.begin[s])));
      const V e = hn::IfThenElseZero(used, exp2(hn::LoadU(f, u.atom_constant.data() + a)));
      w = hn::Add(w, e);
      wx = hn::Add(hn::IfThenElseZero(used, hn::Mul(e, hn::LoadU(f, u.atom_x.data() + a))), wx);
      wy = hn::Add(hn::IfThenElseZero(used, hn::Mul(e, hn::LoadU(f, u.atom_y.data() + a))), wy);
      wz = hn::Add(hn::IfThenElseZero(used, hn::Mul(e, hn::LoadU(f, u.atom_z.data() + a))), wz);
    }
    const float total = hn::GetLane(hn::SumOfLanes(f, w)), per = 3.5f / (2 * decay * total);
    to.log2_sum[s] = total;
    to.x[s] = (u.direct ? b.middle[0] : u.x[s]) + per / b.half[0] * hn::GetLane(hn::SumOfLanes(f, wx));
    to.y[s] = (u.direct ? b.middle[1] : u.y[s]) + per / b.half[1] * hn::GetLane(hn::SumOfLanes(f, wy));
    to.z[s] = (u.direct ? b.middle[2] : u.z[s]) + per / b.half[2] * hn::GetLane(hn::SumOfLanes(f, wz));
  }
  std::fill_n(to.log2_sum.begin() + u.n, 16, 1.0f);
  for (int32_t n = 0; n < u.n; n += lanes)
    hn::StoreU(hn::Add(log2(hn::LoadU(f, to.log2_sum.data() + n)), hn::LoadU(f, u.log2_term.data() + n)), f,
               to.log2_sum.data() + n);
}

void sum_of_powers_simd(int32_t n, const float* exponent, const float* log2_sum, const float* x, const float* y,
                        const float* z, const LocalBox& b, float decay, float* value, float* gradient) {
  V sum = hn::Zero(f), gx = sum, gy = sum, gz = sum;
  for (int32_t u = 0; u < n; u += lanes) {
    const V p = hn::LoadU(f, exponent + u);
    const auto used = hn::Lt(hn::Iota(f, static_cast<float>(u)), hn::Set(f, static_cast<float>(n)));
    const V e = hn::IfThenElseZero(used, exp2(hn::Min(hn::Mul(p, hn::LoadU(f, log2_sum + u)), hn::Set(f, 100.0f)))),
            ep = hn::Mul(e, p);
    sum = hn::Add(sum, e);
    gx = hn::MulAdd(ep, hn::Sub(hn::LoadU(f, x + u), hn::Set(f, b.middle[0])), gx);
    gy = hn::MulAdd(ep, hn::Sub(hn::LoadU(f, y + u), hn::Set(f, b.middle[1])), gy);
    gz = hn::MulAdd(ep, hn::Sub(hn::LoadU(f, z + u), hn::Set(f, b.middle[2])), gz);
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
HWY_EXPORT(bound_units_simd);
HWY_EXPORT(power_terms_simd);
HWY_EXPORT(sum_up_to_simd);
HWY_EXPORT(take_units_simd);
HWY_EXPORT(unit_middles_simd);
HWY_EXPORT(sum_of_powers_simd);

int32_t near_clusters(const LocalClusters& c, int32_t n, const LocalBox& box, int32_t* out) {
  return HWY_DYNAMIC_DISPATCH(near_clusters_simd)(c, n, box, out);
}
void bound_units(const NearUnits& units, const LocalBox& box, float decay, bool scaled, float* log2_upper) {
  HWY_DYNAMIC_DISPATCH(bound_units_simd)(units, box, decay, scaled, log2_upper);
}
void power_terms(const float* log2_sum, const float* exponent, int32_t n, float* term) {
  HWY_DYNAMIC_DISPATCH(power_terms_simd)(log2_sum, exponent, n, term);
}
float sum_up_to(const float* v, int32_t n, float limit) {
  return HWY_DYNAMIC_DISPATCH(sum_up_to_simd)(v, n, limit);
}
bool take_units(const NearUnits& from, const int32_t* list, int32_t n, const LocalBox& block, float decay,
                float within, BlockUnits& to) {
  return HWY_DYNAMIC_DISPATCH(take_units_simd)(from, list, n, block, decay, within, to);
}
void unit_middles(const BlockUnits& units, const LocalBox& block, float decay, UnitMiddles& to) {
  HWY_DYNAMIC_DISPATCH(unit_middles_simd)(units, block, decay, to);
}
void sum_of_powers(int32_t n, const float* exponent, const float* log2_sum, const float* x, const float* y,
                   const float* z, const LocalBox& block, float decay, float* value, float* gradient) {
  HWY_DYNAMIC_DISPATCH(sum_of_powers_simd)(n, exponent, log2_sum, x, y, z, block, decay, value, gradient);
}

} // namespace molmesh::density
#endif
