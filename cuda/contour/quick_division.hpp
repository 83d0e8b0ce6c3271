// quick_division.hpp — quotients rounded as IEEE 754 demands, with one test for underflow and overflow after many
// divisions instead of a branch at each.
#pragma once
#include "base/hd.hpp"

namespace molmesh::cuda {

/// What star_element_quality divides by, which is positive: its bits are right where holds() is true in the end.
class QuickDivision {
public:
  MOLMESH_HD void invert(float x, float& out) {
    note(x);
#ifdef __CUDA_ARCH__
    out = reciprocal(x);
#else
    out = 1 / x;
#endif
  }
  MOLMESH_HD void divide(float a, float x, float& out) {
    note(x);
#ifdef __CUDA_ARCH__
    const float r = reciprocal(x), first = a * r, second = __fmaf_rn(r, __fmaf_rn(-x, first, a), first);
    out = __fmaf_rn(r, __fmaf_rn(-x, second, a), second);
#else
    out = a / x;
#endif
  }
  MOLMESH_HD bool holds() const {
    return least_ > 1e-30f && largest_ < 1e30f;
  }

private:
#ifdef __CUDA_ARCH__
  /// The steps that the compiler takes for 1 / x where no exponent is at the end of its range.
  __device__ static float reciprocal(float x) {
    float r;
    asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(r) : "f"(x));
    return __fmaf_rn(r, __fmaf_rn(-x, r, 1.0f), r);
  }
#endif
  MOLMESH_HD void note(float x) {
    least_ = x < least_ ? x : least_;
    largest_ = x > largest_ ? x : largest_;
  }
  float least_ = 1, largest_ = 1;
};

} // namespace molmesh::cuda
