// quality_kernel.cpp — compiled once per instruction set by Highway's foreach_target.
#include "improve/quality_kernel.hpp"
#include "improve/quality.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "improve/quality_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace molmesh::improve {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<double, 8>;
using V = decltype(hn::Zero(F()).raw); // the compiler's own: tet_quality's text is the scalar's and the device's
constexpr F f{};
constexpr int lanes = static_cast<int>(HWY_MIN(8, HWY_LANES(double)));

void qualities_simd(const EightElements& e, float (&quality)[8]) {
  for (int l = 0; l < 8; l += lanes) {
    Corners<V> p;
    for (int i = 0; i < 4; ++i) {
      p.x[i] = hn::Load(f, e.x[i] + l).raw;
      p.y[i] = hn::Load(f, e.y[i] + l).raw;
      p.z[i] = hn::Load(f, e.z[i] + l).raw;
    }
    V q;
    corners_quality(p, q);
    const hn::Rebind<float, F> to;
    hn::StoreU(hn::DemoteTo(to, hn::Vec<F>{q}), to, quality + l);
  }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::improve
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::improve {

HWY_EXPORT(qualities_simd);

void qualities(const EightElements& e, float (&quality)[8]) {
  HWY_DYNAMIC_DISPATCH(qualities_simd)(e, quality);
}

} // namespace molmesh::improve
#endif
