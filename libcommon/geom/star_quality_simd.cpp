// star_quality_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "geom/star_quality_simd.hpp"
#include <algorithm>
#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "geom/star_quality_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace molmesh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<float, 16>;
constexpr F f{};
constexpr int32_t lanes = static_cast<int32_t>(HWY_MIN(16, HWY_LANES(float)));
typedef float V __attribute__((vector_size(sizeof(float) * lanes))); // spoke_quality's text is the device's too

HWY_INLINE void load(const float* from, V& v) {
  std::memcpy(&v, from, sizeof v);
}
HWY_INLINE hn::Vec<F> to_highway(const V& v) {
  return hn::Load(f, reinterpret_cast<const float*>(&v));
}

/// The fields of a spoke in the order of SpokeGroup.
HWY_INLINE void for_fields(Spoke<V>& s, int begin, int end, auto&& visit) {
  V* const at[SpokeGroup::fields] = {&s.ax, &s.ay, &s.az, &s.bx, &s.by, &s.bz, &s.cx, &s.cy,
                                     &s.cz, &s.nx, &s.ny, &s.nz, &s.r,  &s.ab, &s.bc, &s.ca};
  for (int k = begin; k < end; ++k)
    visit(k, *at[k]);
}

void make_spokes_simd(const SpokeCorners& from, const Vec3d& origin, double inverse, SpokeGroup& to) {
  using D = hn::CappedTag<double, 8>;
  constexpr D d{};
  constexpr hn::Rebind<float, D> half{};
  for (int k = 0; k < SpokeCorners::fields; ++k)
    for (size_t l = 0; l < SpokeGroup::lanes; l += hn::Lanes(d)) {
      const auto p = hn::Sub(hn::Load(d, from.field[k] + l), hn::Set(d, origin[k % 3]));
      hn::StoreU(hn::DemoteTo(half, hn::Mul(p, hn::Set(d, inverse))), half, to.field[k] + l);
    }
  for (int l = 0; l < SpokeGroup::lanes; l += lanes) {
    Spoke<V> s;
    for_fields(s, 0, SpokeCorners::fields, [&](int k, V& v) { load(to.field[k] + l, v); });
    complete(s);
    for_fields(s, SpokeCorners::fields, SpokeGroup::fields,
               [&](int k, V& v) { hn::StoreU(to_highway(v), f, to.field[k] + l); });
  }
}

/// Spokes from `first` on, a multiple of the lanes.
HWY_INLINE void evaluate(const SpokesView& s, int32_t first, const Vec3f& x, V& q) {
  const float* from = s.group[first / SpokeGroup::lanes].field[0] + first % SpokeGroup::lanes;
  Spoke<V> spoke;
  for_fields(spoke, 0, SpokeGroup::fields, [&](int k, V& v) { load(from + SpokeGroup::lanes * k, v); });
  spoke_quality(spoke, x.x, x.y, x.z, q, s.shape);
}

HWY_INLINE Spoke<float> one_spoke(const SpokesView& s, int32_t k) {
  const SpokeGroup& g = s.group[k / SpokeGroup::lanes];
  float field[SpokeGroup::fields];
  for (int i = 0; i < SpokeGroup::fields; ++i)
    field[i] = g.field[i][k % SpokeGroup::lanes];
  return std::bit_cast<Spoke<float>>(field);
}

HWY_INLINE uint32_t bits_of(hn::Mask<F> m) {
  uint8_t bits[8] = {};
  hn::StoreMaskBits(f, m, bits);
  uint32_t word;
  std::memcpy(&word, bits, 4);
  return word;
}

float worst_spoke_simd(const SpokesView& s, Vec3f x, float above) {
  const int32_t chunks = (s.count + lanes - 1) / lanes;
  int32_t chunk = *s.decided / lanes;
  float w = 2;
  for (int32_t i = 0; i < chunks; ++i) {
    V q;
    evaluate(s, lanes * chunk, x, q);
    const float least = hn::GetLane(hn::MinOfLanes(f, to_highway(q)));
    w = least < w ? least : w;
    if (!(w > above)) {
      *s.decided = lanes * chunk;
      return w;
    }
    chunk = chunk + 1 < chunks ? chunk + 1 : 0;
  }
  return w;
}

void judge_spokes_simd(const SpokesView& s, Vec3f x, float* quality) {
  for (int32_t k = 0; k < s.count; k += lanes) {
    V q;
    evaluate(s, k, x, q);
    hn::StoreU(to_highway(q), f, quality + k);
  }
}

void judge_around_simd(const SpokesView& s, int32_t spoke, Vec3f x, float d, float (&out)[6]) {
  Places p;
  for (int k = 0; k < Places::most; ++k) {
    p.x[k] = k == 0 ? x.x + d : k == 1 ? x.x - d : x.x;
    p.y[k] = k == 2 ? x.y + d : k == 3 ? x.y - d : x.y;
    p.z[k] = k == 4 ? x.z + d : k == 5 ? x.z - d : x.z;
  }
  const Spoke<float> one = one_spoke(s, spoke);
  alignas(64) float all[Places::most];
  for (int32_t k = 0; k < 6; k += lanes) {
    V px, py, pz, q;
    load(p.x + k, px), load(p.y + k, py), load(p.z + k, pz);
    spoke_quality(one, px, py, pz, q, s.shape);
    hn::Store(to_highway(q), f, all + k);
  }
  std::copy_n(all, 6, out);
}

int first_place_above_simd(const SpokesView& s, const Places& places, int from, int n, float above, float& q) {
  constexpr int few = 2; // places left are asked about one by one: an element a lane takes two steps for a star
  for (int begin = from / lanes * lanes; begin < n; begin += lanes) {
    V x, y, z;
    load(places.x + begin, x), load(places.y + begin, y), load(places.z + begin, z);
    const auto ahead = [](int k) { return k <= 0 ? 0u : k >= lanes ? (1u << lanes) - 1 : (1u << k) - 1; };
    uint32_t left = ahead(n - begin) & ~ahead(from - begin);
    for (int32_t k = 0; k < s.count && std::popcount(left) > few; ++k) {
      V at;
      spoke_quality(one_spoke(s, s.order[k]), x, y, z, at, s.shape);
      left &= bits_of(hn::Gt(to_highway(at), hn::Set(f, above)));
      if (left == 0 && k > 0) { // decides next time too
        const int32_t decided = s.order[k];
        s.order[k] = s.order[k - 1];
        s.order[k - 1] = decided;
      }
    }
    for (; left; left &= left - 1) {
      const int k = begin + std::countr_zero(left);
      q = worst_spoke_simd(s, {places.x[k], places.y[k], places.z[k]}, above);
      if (q > above)
        return k;
    }
  }
  return n;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh {

HWY_EXPORT(make_spokes_simd);
HWY_EXPORT(worst_spoke_simd);
HWY_EXPORT(judge_spokes_simd);
HWY_EXPORT(judge_around_simd);
HWY_EXPORT(first_place_above_simd);

void make_spokes(const SpokeCorners& from, Vec3d origin, double inverse, SpokeGroup& to) {
  HWY_DYNAMIC_DISPATCH(make_spokes_simd)(from, origin, inverse, to);
}
float worst_spoke(const SpokesView& s, Vec3f x, float above) {
  return HWY_DYNAMIC_DISPATCH(worst_spoke_simd)(s, x, above);
}
void judge_spokes(const SpokesView& s, Vec3f x, float* quality) {
  HWY_DYNAMIC_DISPATCH(judge_spokes_simd)(s, x, quality);
}
void judge_around(const SpokesView& s, int32_t spoke, Vec3f x, float d, float (&out)[6]) {
  HWY_DYNAMIC_DISPATCH(judge_around_simd)(s, spoke, x, d, out);
}
int first_place_above(const SpokesView& s, const Places& places, int from, int n, float above, float& q) {
  return HWY_DYNAMIC_DISPATCH(first_place_above_simd)(s, places, from, n, above, q);
}

} // namespace molmesh
#endif
