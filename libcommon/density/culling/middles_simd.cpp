// middles_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/culling/middles_simd.hpp"
#include "base/dispatch.hpp"
#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/culling/middles_simd.cpp"
#include <hwy/foreach_target.h>

#include "density/values/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

void unit_middles_simd(const BlockUnits& u, const LocalBox& b, float decay, UnitMiddles& to) {
  for (int32_t n = 0; n < u.n; ++n) {
    const auto s = static_cast<size_t>(n);
    V w = hn::Zero(f), wx = w, wy = w, wz = w;
    for (int32_t a = u.begin[s]; a < u.begin[s + 1]; a += lanes) {
      const auto used = hn::Lt(hn::Iota(f, static_cast<float>(a - u.begin[s])),
                               hn::Set(f, static_cast<float>(u.begin[s + 1] - u.begin[s])));
      const V e = hn::IfThenElseZero(used, exp2(hn::LoadU(f, u.atom_constant.data() + a)));
      w = hn::Add(w, e);
      wx = hn::Add(hn::IfThenElseZero(used, hn::Mul(e, hn::LoadU(f, u.atom_x.data() + a))), wx);
      wy = hn::Add(hn::IfThenElseZero(used, hn::Mul(e, hn::LoadU(f, u.atom_y.data() + a))), wy);
      wz = hn::Add(hn::IfThenElseZero(used, hn::Mul(e, hn::LoadU(f, u.atom_z.data() + a))), wz);
    }
    const float total = hn::GetLane(hn::SumOfLanes(f, w)), per = 3.5f / (2 * decay * total);
    to.log2_sum[s] = total;
    to.x[s] = (u.direct ? b.middle[0] : u.x[s]) + per / b.half[0] * hn::GetLane(hn::SumOfLanes(f, wx));
    to.y[s] = (u.direct ? b.middle[1] : u.y[s]) + per / b.half[1] * hn::GetLane(hn::SumOfLanes(f, wy));
    to.z[s] = (u.direct ? b.middle[2] : u.z[s]) + per / b.half[2] * hn::GetLane(hn::SumOfLanes(f, wz));
  }
  std::fill_n(to.log2_sum.begin() + u.n, 16, 1.0f);
  for (int32_t n = 0; n < u.n; n += lanes)
    hn::StoreU(hn::Add(log2(hn::LoadU(f, to.log2_sum.data() + n)), hn::LoadU(f, u.log2_factor.data() + n)), f,
               to.log2_sum.data() + n);
}

void sum_of_powers_simd(int32_t n, const float* exponent, const float* log2_sum, const float* x, const float* y,
                        const float* z, const LocalBox& b, float decay, float* value, float* gradient) {
  V sum = hn::Zero(f), gx = sum, gy = sum, gz = sum;
  for (int32_t u = 0; u < n; u += lanes) {
    const V p = hn::LoadU(f, exponent + u);
    const auto used = hn::Lt(hn::Iota(f, static_cast<float>(u)), hn::Set(f, static_cast<float>(n)));
    const V e = hn::IfThenElseZero(used, exp2(hn::Min(hn::Mul(p, hn::LoadU(f, log2_sum + u)), hn::Set(f, 100.0f)))),
            ep = hn::Mul(e, p);
    sum = hn::Add(sum, e);
    gx = hn::MulAdd(ep, hn::Sub(hn::LoadU(f, x + u), hn::Set(f, b.middle[0])), gx);
    gy = hn::MulAdd(ep, hn::Sub(hn::LoadU(f, y + u), hn::Set(f, b.middle[1])), gy);
    gz = hn::MulAdd(ep, hn::Sub(hn::LoadU(f, z + u), hn::Set(f, b.middle[2])), gz);
  }
  *value = hn::GetLane(hn::SumOfLanes(f, sum));
  gradient[0] = 2 * decay * hn::GetLane(hn::SumOfLanes(f, gx));
  gradient[1] = 2 * decay * hn::GetLane(hn::SumOfLanes(f, gy));
  gradient[2] = 2 * decay * hn::GetLane(hn::SumOfLanes(f, gz));
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::density {

HWY_EXPORT(unit_middles_simd);
HWY_EXPORT(sum_of_powers_simd);

void unit_middles(const BlockUnits& units, const LocalBox& block, float decay, UnitMiddles& to) {
  MOLMESH_DISPATCH(unit_middles_simd)(units, block, decay, to);
}
void sum_of_powers(int32_t n, const float* exponent, const float* log2_sum, const float* x, const float* y,
                   const float* z, const LocalBox& block, float decay, float* value, float* gradient) {
  MOLMESH_DISPATCH(sum_of_powers_simd)(n, exponent, log2_sum, x, y, z, block, decay, value, gradient);
}

} // namespace molmesh::density
#endif
