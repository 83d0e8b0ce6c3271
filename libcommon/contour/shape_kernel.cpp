// shape_kernel.cpp — compiled once per instruction set by Highway's foreach_target.
#include "contour/shape_kernel.hpp"
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contour/shape_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace molmesh::contour {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<double, 8>;
constexpr F f{};
constexpr int lanes = static_cast<int>(HWY_MIN(8, HWY_LANES(double)));
typedef double V __attribute__((vector_size(sizeof(double) * lanes))); // the formulas' text is the device's too

void eight_least_sines_simd(const improve::EightElements& e, double (&least)[8]) {
  for (int l = 0; l < 8; l += lanes) {
    improve::Corners<V> p;
    for (int i = 0; i < 4; ++i) {
      std::memcpy(&p.x[i], e.x[i] + l, sizeof(V));
      std::memcpy(&p.y[i], e.y[i] + l, sizeof(V));
      std::memcpy(&p.z[i], e.z[i] + l, sizeof(V));
    }
    Sines<V> sines;
    begin_sines(p, sines);
    for (V& v : sines.length) {
      auto* const at = reinterpret_cast<double*>(&v);
      hn::Store(hn::Sqrt(hn::Load(f, at)), f, at);
    }
    V of;
    least_of(sines, of);
    std::memcpy(least + l, &of, sizeof(V));
  }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::contour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::contour {

HWY_EXPORT(eight_least_sines_simd);

void eight_least_sines(const improve::EightElements& e, double (&least)[8]) {
  HWY_DYNAMIC_DISPATCH(eight_least_sines_simd)(e, least);
}

} // namespace molmesh::contour
#endif
