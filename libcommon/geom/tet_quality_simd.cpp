// tet_quality_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "geom/tet_quality_simd.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "geom/tet_quality_simd.cpp"
#include <hwy/foreach_target.h>

#include "geom/double_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh {
namespace HWY_NAMESPACE {
namespace {

using namespace molmesh::HWY_NAMESPACE;

void qualities_simd(const EightElements& e, float (&quality)[8], double shape) {
  for (int l = 0; l < 8; l += lanes) {
    Corners<V> p;
    e.load(l, p);
    V q;
    corners_quality(p, q, shape);
    const hn::Rebind<float, F> to;
    hn::StoreU(hn::DemoteTo(to, hn::Load(f, reinterpret_cast<const double*>(&q))), to, quality + l);
  }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh {

HWY_EXPORT(qualities_simd);

void qualities(const EightElements& e, float (&quality)[8], double shape) {
  HWY_DYNAMIC_DISPATCH(qualities_simd)(e, quality, shape);
}

} // namespace molmesh
#endif
