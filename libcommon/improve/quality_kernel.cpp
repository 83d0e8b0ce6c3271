// quality_kernel.cpp — compiled once per instruction set by Highway's foreach_target.
#include "improve/quality_kernel.hpp"
#include <cstring>

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
constexpr F f{};
constexpr int lanes = static_cast<int>(HWY_MIN(8, HWY_LANES(double)));
typedef double V __attribute__((vector_size(sizeof(double) * lanes))); // tet_quality's text is the device's too

void qualities_simd(const EightElements& e, float (&quality)[8], double shape) {
  for (int l = 0; l < 8; l += lanes) {
    Corners<V> p;
    for (int i = 0; i < 4; ++i) {
      std::memcpy(&p.x[i], e.x[i] + l, sizeof(V));
      std::memcpy(&p.y[i], e.y[i] + l, sizeof(V));
      std::memcpy(&p.z[i], e.z[i] + l, sizeof(V));
    }
    V q;
    corners_quality(p, q, shape);
    const hn::Rebind<float, F> to;
    hn::StoreU(hn::DemoteTo(to, hn::Load(f, reinterpret_cast<const double*>(&q))), to, quality + l);
  }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::improve
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::improve {

HWY_EXPORT(qualities_simd);

void qualities(const EightElements& e, float (&quality)[8], double shape) {
  HWY_DYNAMIC_DISPATCH(qualities_simd)(e, quality, shape);
}

} // namespace molmesh::improve
#endif
