// lane_sums_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "label/lane_sums_simd.hpp"
#include "base/dispatch.hpp"
#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "label/lane_sums_simd.cpp"
#include <hwy/foreach_target.h>

#include "density/values/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::density { // where the powers and logarithms are
namespace HWY_NAMESPACE {
namespace {

using D = Tag<double>;
using VD = hn::Vec<D>;
constexpr D d{};
constexpr int32_t wide = HWY_MIN(label::lanes, lanes_of<double>);

void sum_lane_atoms_simd(const label::LaneAtoms& atoms, const int32_t* begin, int32_t sums, double decay,
                         const label::LanePlaces& p, AlignedVector<double>& scratch, double* log2_sum) {
  const VD k = hn::Set(d, decay);
  for (int32_t v = 0; v < label::lanes; v += wide) {
    const VD x = hn::Load(d, p.x + v), y = hn::Load(d, p.y + v), z = hn::Load(d, p.z + v);
    for (int32_t s = 0; s < sums; ++s) {
      const auto first = static_cast<size_t>(begin[s]), n = static_cast<size_t>(begin[s + 1]) - first;
      if (scratch.size() < label::lanes * n)
        scratch.resize(label::lanes * n);
      VD top = hn::Set(d, -1e300);
      for (size_t i = 0; i < n; ++i) {
        const size_t a = first + i;
        const VD dx = hn::Sub(hn::Set(d, atoms.x[a]), x), dy = hn::Sub(hn::Set(d, atoms.y[a]), y),
                 dz = hn::Sub(hn::Set(d, atoms.z[a]), z);
        const VD d2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
        const VD term = hn::NegMulAdd(k, d2, hn::Set(d, atoms.peak[a]));
        hn::Store(term, d, &scratch[wide * i]);
        top = hn::Max(top, term);
      }
      VD sum = hn::Zero(d);
      for (size_t i = 0; i < n; ++i)
        sum = hn::Add(sum, exp2(d, hn::Sub(hn::Load(d, &scratch[wide * i]), top)));
      hn::StoreU(hn::Add(top, log2(d, sum)), d, log2_sum + label::lanes * s + v);
    }
  }
}

void sum_lane_powers_simd(const double* below, const double* exponent, const int32_t* begin, int32_t sums,
                          double* log2_sum) {
  for (int32_t v = 0; v < label::lanes; v += wide)
    for (int32_t s = 0; s < sums; ++s) {
      const auto term = [&](int32_t i) {
        return hn::Mul(hn::Set(d, exponent[i]), hn::LoadU(d, below + label::lanes * i + v));
      };
      VD top = term(begin[s]), sum = hn::Zero(d);
      for (int32_t i = begin[s] + 1; i < begin[s + 1]; ++i)
        top = hn::Max(top, term(i));
      for (int32_t i = begin[s]; i < begin[s + 1]; ++i)
        sum = hn::Add(sum, exp2(d, hn::Sub(term(i), top)));
      hn::StoreU(hn::Add(top, log2(d, sum)), d, log2_sum + label::lanes * s + v);
    }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::density {
HWY_EXPORT(sum_lane_atoms_simd);
HWY_EXPORT(sum_lane_powers_simd);
namespace {
void atoms(const label::LaneAtoms& a, const int32_t* begin, int32_t sums, double decay, const label::LanePlaces& p,
           AlignedVector<double>& scratch, double* log2_sum) {
  MOLMESH_DISPATCH(sum_lane_atoms_simd)(a, begin, sums, decay, p, scratch, log2_sum);
}
void powers(const double* below, const double* exponent, const int32_t* begin, int32_t sums, double* log2_sum) {
  MOLMESH_DISPATCH(sum_lane_powers_simd)(below, exponent, begin, sums, log2_sum);
}
} // namespace
} // namespace molmesh::density

namespace molmesh::label {
void sum_lane_atoms(const LaneAtoms& a, const int32_t* begin, int32_t sums, double decay, const LanePlaces& p,
                    AlignedVector<double>& scratch, double* log2_sum) {
  density::atoms(a, begin, sums, decay, p, scratch, log2_sum);
}
void sum_lane_powers(const double* below, const double* exponent, const int32_t* begin, int32_t sums,
                     double* log2_sum) {
  density::powers(below, exponent, begin, sums, log2_sum);
}
} // namespace molmesh::label
#endif
