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
typedef float V
    __attribute__((vector_size(sizeof(float) * lanes))); // star_element_quality's text is the device's too

HWY_INLINE void load(const float* from, V& v) {
  std::memcpy(&v, from, sizeof v);
}
HWY_INLINE hn::Vec<F> to_highway(const V& v) {
  return hn::Load(f, reinterpret_cast<const float*>(&v));
}

/// The fields of an element in the order of StarElementGroup.
HWY_INLINE void for_fields(StarElement<V>& s, int begin, int end, auto&& visit) {
  V* const at[StarElementGroup::fields] = {&s.ax, &s.ay, &s.az, &s.bx, &s.by, &s.bz, &s.cx, &s.cy,
                                           &s.cz, &s.nx, &s.ny, &s.nz, &s.r,  &s.ab, &s.bc, &s.ca};
  for (int k = begin; k < end; ++k)
    visit(k, *at[k]);
}

void make_star_elements_simd(const StarCorners& from, const Vec3d& origin, double inverse, StarElementGroup& to) {
  using D = hn::CappedTag<double, 8>;
  constexpr D d{};
  constexpr hn::Rebind<float, D> half{};
  for (int k = 0; k < StarCorners::fields; ++k)
    for (size_t l = 0; l < StarElementGroup::lanes; l += hn::Lanes(d)) {
      const auto p = hn::Sub(hn::Load(d, from.field[k] + l), hn::Set(d, origin[k % 3]));
      hn::StoreU(hn::DemoteTo(half, hn::Mul(p, hn::Set(d, inverse))), half, to.field[k] + l);
    }
  for (int l = 0; l < StarElementGroup::lanes; l += lanes) {
    StarElement<V> s;
    for_fields(s, 0, StarCorners::fields, [&](int k, V& v) { load(to.field[k] + l, v); });
    complete(s);
    for_fields(s, StarCorners::fields, StarElementGroup::fields,
               [&](int k, V& v) { hn::StoreU(to_highway(v), f, to.field[k] + l); });
  }
}

/// Qualities of elements from `first` on, a multiple of the lanes.
HWY_INLINE void evaluate(const StarView& s, int32_t first, const Vec3f& x, V& q) {
  const float* from = s.group[first / StarElementGroup::lanes].field[0] + first % StarElementGroup::lanes;
  StarElement<V> star_element;
  for_fields(star_element, 0, StarElementGroup::fields,
             [&](int k, V& v) { load(from + StarElementGroup::lanes * k, v); });
  star_element_quality(star_element, x.x, x.y, x.z, q, s.shape);
}

HWY_INLINE StarElement<float> one_element(const StarView& s, int32_t k) {
  const StarElementGroup& g = s.group[k / StarElementGroup::lanes];
  float field[StarElementGroup::fields];
  for (int i = 0; i < StarElementGroup::fields; ++i)
    field[i] = g.field[i][k % StarElementGroup::lanes];
  return std::bit_cast<StarElement<float>>(field);
}

HWY_INLINE uint32_t bits_of(hn::Mask<F> m) {
  uint8_t bits[8] = {};
  hn::StoreMaskBits(f, m, bits);
  uint32_t word;
  std::memcpy(&word, bits, 4);
  return word;
}

float worst_in_star_simd(const StarView& s, Vec3f x, float above) {
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

void star_qualities_simd(const StarView& s, Vec3f x, float* quality) {
  for (int32_t k = 0; k < s.count; k += lanes) {
    V q;
    evaluate(s, k, x, q);
    hn::StoreU(to_highway(q), f, quality + k);
  }
}

void judge_around_simd(const StarView& s, int32_t element, Vec3f x, float d, float (&out)[6]) {
  Places p;
  for (int k = 0; k < Places::most; ++k) {
    p.x[k] = k == 0 ? x.x + d : k == 1 ? x.x - d : x.x;
    p.y[k] = k == 2 ? x.y + d : k == 3 ? x.y - d : x.y;
    p.z[k] = k == 4 ? x.z + d : k == 5 ? x.z - d : x.z;
  }
  const StarElement<float> one = one_element(s, element);
  alignas(64) float all[Places::most];
  for (int32_t k = 0; k < 6; k += lanes) {
    V px, py, pz, q;
    load(p.x + k, px), load(p.y + k, py), load(p.z + k, pz);
    star_element_quality(one, px, py, pz, q, s.shape);
    hn::Store(to_highway(q), f, all + k);
  }
  std::copy_n(all, 6, out);
}

int first_place_above_simd(const StarView& s, const Places& places, int from, int n, float above, float& q) {
  constexpr int few = 2; // places left are asked about one by one: an element a lane takes two steps for a star
  for (int begin = from / lanes * lanes; begin < n; begin += lanes) {
    V x, y, z;
    load(places.x + begin, x), load(places.y + begin, y), load(places.z + begin, z);
    const auto ahead = [](int k) { return k <= 0 ? 0u : k >= lanes ? (1u << lanes) - 1 : (1u << k) - 1; };
    uint32_t left = ahead(n - begin) & ~ahead(from - begin);
    for (int32_t k = 0; k < s.count && std::popcount(left) > few; ++k) {
      V at;
      star_element_quality(one_element(s, s.order[k]), x, y, z, at, s.shape);
      left &= bits_of(hn::Gt(to_highway(at), hn::Set(f, above)));
      if (left == 0 && k > 0) { // decides next time too
        const int32_t decided = s.order[k];
        s.order[k] = s.order[k - 1];
        s.order[k - 1] = decided;
      }
    }
    for (; left; left &= left - 1) {
      const int k = begin + std::countr_zero(left);
      q = worst_in_star_simd(s, {places.x[k], places.y[k], places.z[k]}, above);
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

HWY_EXPORT(make_star_elements_simd);
HWY_EXPORT(worst_in_star_simd);
HWY_EXPORT(star_qualities_simd);
HWY_EXPORT(judge_around_simd);
HWY_EXPORT(first_place_above_simd);

void make_star_elements(const StarCorners& from, Vec3d origin, double inverse, StarElementGroup& to) {
  HWY_DYNAMIC_DISPATCH(make_star_elements_simd)(from, origin, inverse, to);
}
float worst_in_star(const StarView& s, Vec3f x, float above) {
  return HWY_DYNAMIC_DISPATCH(worst_in_star_simd)(s, x, above);
}
void star_qualities(const StarView& s, Vec3f x, float* quality) {
  HWY_DYNAMIC_DISPATCH(star_qualities_simd)(s, x, quality);
}
void judge_around(const StarView& s, int32_t element, Vec3f x, float d, float (&out)[6]) {
  HWY_DYNAMIC_DISPATCH(judge_around_simd)(s, element, x, d, out);
}
int first_place_above(const StarView& s, const Places& places, int from, int n, float above, float& q) {
  return HWY_DYNAMIC_DISPATCH(first_place_above_simd)(s, places, from, n, above, q);
}

} // namespace molmesh
#endif
