// shape_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "contour/elements/shape_simd.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contour/elements/shape_simd.cpp"
#include <hwy/foreach_target.h>

#include "geom/double_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::contour {
namespace HWY_NAMESPACE {
namespace {

using namespace molmesh::HWY_NAMESPACE;

void eight_least_sines_simd(const EightElements& e, double (&least)[8]) {
  for (int l = 0; l < 8; l += lanes) {
    Corners<V> p;
    e.load(l, p);
    Sines<V> sines;
    begin_sines(p, sines);
    for (V& v : sines.length)
      take_root(v);
    V of;
    least_of(sines, of);
    store(of, least + l);
  }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::contour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::contour {

HWY_EXPORT(eight_least_sines_simd);

void eight_least_sines(const EightElements& e, double (&least)[8]) {
  HWY_DYNAMIC_DISPATCH(eight_least_sines_simd)(e, least);
}

} // namespace molmesh::contour
#endif
