// bounds_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/culling/bounds_simd.hpp"
#include "base/dispatch.hpp"
#include <algorithm>
#include <cmath>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/culling/bounds_simd.cpp"
#include <hwy/foreach_target.h>

#include "density/values/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

constexpr double log2e = std::numbers::log2e;

/// Slots of one cluster of `count` atoms, from 16 of each of x, y, z and peak.
HWY_INLINE void place_cluster(const double* const* from, size_t count, const double* origin, float* const* to) {
#if HWY_TARGET != HWY_SCALAR
  constexpr hn::CappedTag<double, 8> d;
  constexpr hn::Rebind<float, hn::CappedTag<double, 8>> h;
  for (size_t a = 0; a < 16; a += lanes) {
    // Whole vectors: a load from two stores just made would have to wait for both.
    const auto floats = [&](int v, auto&& each) {
      const auto half = [&](size_t at) { return hn::DemoteTo(h, each(hn::LoadU(d, from[v] + at))); };
      return hn::Combine(f, half(a + lanes / 2), half(a));
    };
    for (int v = 0; v < 3; ++v)
      hn::StoreU(floats(v, [&](auto x) { return hn::Sub(x, hn::Set(d, origin[v])); }), f, to[v] + a);
    const auto used = hn::Lt(hn::Iota(f, static_cast<float>(a)), hn::Set(f, static_cast<float>(count)));
    const V peak = floats(3, [&](auto x) { return hn::Mul(x, hn::Set(d, log2e)); });
    hn::StoreU(hn::IfThenElse(used, peak, hn::Set(f, -1e30f)), f, to[3] + a);
  }
#else
  for (size_t a = 0; a < 16; ++a) {
    for (int v = 0; v < 3; ++v)
      to[v][a] = static_cast<float>(from[v][a] - origin[v]);
    to[3][a] = a < count ? static_cast<float>(log2e * from[3][a]) : -1e30f;
  }
#endif
}

void place_atoms_simd(const ClusteredAtoms& atoms, const int32_t* list, size_t n, const double* middle,
                      LocalClusters& to) {
  const double origin[3] = {middle[0], middle[1], middle[2]};
  float* slots[4] = {to.atom_x.data(), to.atom_y.data(), to.atom_z.data(), to.atom_peak.data()};
  for (size_t i = 0; i < n; ++i) {
    const auto c = static_cast<size_t>(list[i]), first = static_cast<size_t>(atoms.begin[c]),
               count = static_cast<size_t>(atoms.begin[c + 1]) - first;
    const double* from[4] = {atoms.x + first, atoms.y + first, atoms.z + first, atoms.peak + first};
    if (first + 16 <= atoms.atoms) {
      place_cluster(from, count, origin, slots);
    } else {
      double last[4][16] = {};
      for (int v = 0; v < 4; ++v)
        from[v] = std::copy_n(from[v], count, last[v]) - count;
      place_cluster(from, count, origin, slots);
    }
    for (float*& s : slots)
      s += 16;
  }
}

HWY_INLINE V distance_beyond(V lo, V hi, float middle, float half) {
  const V below = hn::Sub(lo, hn::Set(f, middle + half)), above = hn::Sub(hn::Set(f, middle - half), hi);
  return hn::Max(hn::Max(below, above), hn::Zero(f));
}

int32_t near_clusters_simd(const LocalClusters& c, int32_t n, const LocalBox& b, int32_t* out) {
  int32_t found = 0;
  for (int32_t i = 0; i < n; i += lanes) {
    const auto get = [&](const AlignedFloats& v) { return hn::LoadU(f, v.data() + i); };
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

/// decay·(squared distance along an axis) from an interval.
HWY_INLINE V fall(V at, float middle, float half, V decay) {
  const V d = hn::Max(hn::Sub(hn::Abs(hn::Sub(at, hn::Set(f, middle))), hn::Set(f, half)), hn::Zero(f));
  return hn::Mul(hn::Mul(d, d), decay);
}

/// log2 of the sum over one box of a unit's terms, however small.
HWY_INLINE float bound_scaled(const LocalClusters& brick, const int32_t* cluster, int32_t clusters,
                              const LocalBox& b, V k) {
  const auto log2_term = [&](size_t a) {
    V e = hn::LoadU(f, &brick.atom_peak[a]);
    e = hn::Sub(e, fall(hn::LoadU(f, &brick.atom_x[a]), b.middle[0], b.half[0], k));
    e = hn::Sub(e, fall(hn::LoadU(f, &brick.atom_y[a]), b.middle[1], b.half[1], k));
    return hn::Sub(e, fall(hn::LoadU(f, &brick.atom_z[a]), b.middle[2], b.half[2], k));
  };
  V largest = hn::Set(f, -1e30f), sum = hn::Zero(f);
  for_atoms(cluster, clusters, [&](size_t a) { largest = hn::Max(largest, log2_term(a)); });
  const V scale = hn::MaxOfLanes(f, largest);
  for_atoms(cluster, clusters, [&](size_t a) { sum = hn::Add(sum, exp2(hn::Sub(log2_term(a), scale))); });
  return hn::GetLane(hn::Add(scale, log2(hn::SumOfLanes(f, sum))));
}

/// The 2³ boxes that two intervals along each axis make (sides = 2), as octants are numbered; or one.
template <int sides>
HWY_INLINE void bound_boxes(const LocalClusters& brick, const NearUnits& u, const LocalBox* box, float decay,
                            bool scaled, float* log2_upper, int32_t stride) {
  constexpr int boxes = sides * sides * sides;
  const V k = hn::Set(f, decay);
  for (int32_t n = 0; n < u.n; ++n) {
    const int32_t begin = u.begin[n],
                  clusters = u.begin[static_cast<size_t>(n) + 1] - begin, *const cluster = u.cluster.data() + begin;
    if (scaled) {
      for (int b = 0; b < boxes; ++b)
        log2_upper[b * stride + n] = bound_scaled(brick, cluster, clusters, box[b], k);
      continue;
    }
    V sum[boxes];
    for (V& s : sum)
      s = hn::Zero(f);
    for_atoms(cluster, clusters, [&](size_t a) {
      V x[sides], y[sides], z[sides];
      const V ax = hn::LoadU(f, &brick.atom_x[a]), ay = hn::LoadU(f, &brick.atom_y[a]),
              az = hn::LoadU(f, &brick.atom_z[a]), peak = hn::LoadU(f, &brick.atom_peak[a]);
      for (int s = 0; s < sides; ++s) {
        x[s] = hn::Sub(peak, fall(ax, box[sides * sides * s].middle[0], box->half[0], k));
        y[s] = fall(ay, box[sides * s].middle[1], box->half[1], k);
        z[s] = fall(az, box[s].middle[2], box->half[2], k);
      }
      for (int i = 0; i < sides; ++i)
        for (int j = 0; j < sides; ++j) {
          const V xy = hn::Sub(x[i], y[j]);
          for (int l = 0; l < sides; ++l) {
            V& to = sum[sides * (sides * i + j) + l];
            to = hn::Add(to, exp2_above(hn::Sub(xy, z[l])));
          }
        }
    });
    for (int b = 0; b < boxes; ++b)
      log2_upper[b * stride + n] = hn::GetLane(hn::SumOfLanes(f, sum[b]));
  }
  for (int b = 0; b < boxes; ++b) {
    float* const v = log2_upper + b * stride;
    std::fill_n(v + u.n, 16, 1.0f);
    for (int32_t n = 0; n < u.n && !scaled; n += lanes)
      hn::StoreU(log2(hn::LoadU(f, v + n)), f, v + n);
  }
}

void bound_units_simd(const LocalClusters& brick, const NearUnits& u, const LocalBox& b, float decay, bool scaled,
                      float* log2_upper) {
  bound_boxes<1>(brick, u, &b, decay, scaled, log2_upper, 0);
}

void bound_octants_simd(const LocalClusters& brick, const NearUnits& u, const LocalBox* octant, float decay,
                        bool scaled, float* log2_upper, int32_t stride) {
  bound_boxes<2>(brick, u, octant, decay, scaled, log2_upper, stride);
}

float power_terms_simd(const float* log2_sum, const float* exponent, int32_t n, float* term) {
  V sum = hn::Zero(f);
  for (int32_t i = 0; i < n; i += lanes) {
    const auto used = hn::Lt(hn::Iota(f, static_cast<float>(i)), hn::Set(f, static_cast<float>(n)));
    const V t = exp2(hn::Min(hn::Mul(hn::LoadU(f, log2_sum + i), hn::LoadU(f, exponent + i)), hn::Set(f, 127.0f)));
    hn::StoreU(t, f, term + i);
    sum = hn::Add(sum, hn::IfThenElseZero(used, t));
  }
  return hn::GetLane(hn::SumOfLanes(f, sum));
}

double log2_of_sum_simd(const float* v, int32_t n) {
  const V none = hn::Set(f, -2e38f);
  const auto at = [&](int32_t i) {
    const auto used = hn::Lt(hn::Iota(f, static_cast<float>(i)), hn::Set(f, static_cast<float>(n)));
    return hn::IfThenElse(used, hn::LoadU(f, v + i), none);
  };
  V largest = none, sum = hn::Zero(f);
  for (int32_t i = 0; i < n; i += lanes)
    largest = hn::Max(largest, at(i));
  const V scale = hn::MaxOfLanes(f, largest);
  for (int32_t i = 0; i < n; i += lanes)
    sum = hn::Add(sum, exp2(hn::Sub(at(i), scale)));
  return double{hn::GetLane(scale)} + std::log2(double{hn::GetLane(hn::SumOfLanes(f, sum))});
}

/// Sum of those of v[n] that are at most `limit`; v holds n + 16.
HWY_INLINE float sum_up_to(const float* v, int32_t n, float limit) {
  V sum = hn::Zero(f);
  for (int32_t i = 0; i < n; i += lanes) {
    const V x = hn::LoadU(f, v + i);
    const auto used = hn::Lt(hn::Iota(f, static_cast<float>(i)), hn::Set(f, static_cast<float>(n)));
    sum = hn::Add(sum, hn::IfThenElseZero(hn::And(used, hn::Le(x, hn::Set(f, limit))), x));
  }
  return hn::GetLane(hn::SumOfLanes(f, sum));
}

/// The largest of a few thresholds that the budget allows; the last cannot fail.
int32_t keep_large_simd(const float* effect, int32_t n, float budget, int32_t* out, float* left) {
  constexpr float rounding = 1.001f;
  float limit = budget / std::max(1.0f, rounding * static_cast<float>(n));
  *left = 0;
  for (const float share : {0.7f, 0.5f, 0.35f, 0.25f, 0.18f, 0.12f, 0.08f, 0.05f})
    if (const float used = rounding * sum_up_to(effect, n, share * budget); used <= budget) {
      limit = share * budget;
      *left = budget - used;
      break;
    }
  int32_t found = 0;
  for (int32_t i = 0; i < n; i += lanes) {
    const auto used = hn::Lt(hn::Iota(f, static_cast<float>(i)), hn::Set(f, static_cast<float>(n)));
    const auto keep = hn::And(used, hn::Gt(hn::LoadU(f, effect + i), hn::Set(f, limit)));
    hn::StoreU(hn::Compress(hn::Iota(I(), i), hn::RebindMask(I(), keep)), I(), out + found);
    found += static_cast<int32_t>(hn::CountTrue(f, keep));
  }
  return found;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::density {

HWY_EXPORT(place_atoms_simd);
HWY_EXPORT(near_clusters_simd);
HWY_EXPORT(bound_units_simd);
HWY_EXPORT(bound_octants_simd);
HWY_EXPORT(power_terms_simd);
HWY_EXPORT(log2_of_sum_simd);
HWY_EXPORT(keep_large_simd);

void place_atoms(const ClusteredAtoms& from, const int32_t* list, size_t n, const double* middle,
                 LocalClusters& to) {
  MOLMESH_DISPATCH(place_atoms_simd)(from, list, n, middle, to);
}
int32_t near_clusters(const LocalClusters& c, int32_t n, const LocalBox& box, int32_t* out) {
  return MOLMESH_DISPATCH(near_clusters_simd)(c, n, box, out);
}
void bound_units(const LocalClusters& brick, const NearUnits& units, const LocalBox& box, float decay, bool scaled,
                 float* log2_upper) {
  MOLMESH_DISPATCH(bound_units_simd)(brick, units, box, decay, scaled, log2_upper);
}
void bound_octants(const LocalClusters& brick, const NearUnits& units, const LocalBox* octant, float decay,
                   bool scaled, float* log2_upper, int32_t stride) {
  MOLMESH_DISPATCH(bound_octants_simd)(brick, units, octant, decay, scaled, log2_upper, stride);
}
float power_terms(const float* log2_sum, const float* exponent, int32_t n, float* term) {
  return MOLMESH_DISPATCH(power_terms_simd)(log2_sum, exponent, n, term);
}
double log2_of_sum(const float* v, int32_t n) {
  return MOLMESH_DISPATCH(log2_of_sum_simd)(v, n);
}
int32_t keep_large(const float* effect, int32_t n, float budget, int32_t* out, float* left) {
  return MOLMESH_DISPATCH(keep_large_simd)(effect, n, budget, out, left);
}

} // namespace molmesh::density
#endif
