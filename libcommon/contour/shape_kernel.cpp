// shape_kernel.cpp — compiled once per instruction set by Highway's foreach_target.
#include "contour/shape_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contour/shape_kernel.cpp"
#include <hwy/foreach_target.h>

#include "geom/double_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::contour {
namespace HWY_NAMESPACE {
namespace {

using namespace molmesh::HWY_NAMESPACE;

void eight_least_sines_simd(const improve::EightElements& e, double (&least)[8]) {
  for (int l = 0; l < 8; l += lanes) {
    improve::Corners<V> p;
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

void eight_least_sines(const improve::EightElements& e, double (&least)[8]) {
  HWY_DYNAMIC_DISPATCH(eight_least_sines_simd)(e, least);
}

} // namespace molmesh::contour
#endif
