// logs_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "isosurface/logs_simd.hpp"
#include "base/log.hpp"
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "isosurface/logs_simd.cpp"
#include <hwy/foreach_target.h>

#include "geom/double_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh {
namespace HWY_NAMESPACE {
namespace {

using namespace molmesh::HWY_NAMESPACE;

constexpr hn::Rebind<float, F> single{};

void log_ratios_simd(const float* value, uint64_t active, double isovalue, float* out) {
  const auto unknown = hn::Set(single, std::numeric_limits<float>::quiet_NaN());
  for (int l = 0; l < 64; l += lanes) {
    const uint8_t bits[8] = {static_cast<uint8_t>(active >> l & ((1u << lanes) - 1))};
    if (bits[0] == 0) {
      hn::StoreU(unknown, single, out + l);
      continue;
    }
    const auto v = hn::LoadU(single, value + l);
    V ratio, log;
    hn::Store(hn::PromoteTo(f, v), f, reinterpret_cast<double*>(&ratio));
    ratio = ratio / isovalue;
    portable_logs<V, U>(ratio, log); // anything where a value is not positive
    const auto rounded = hn::DemoteTo(single, hn::Load(f, reinterpret_cast<const double*>(&log)));
    const auto known = hn::And(hn::LoadMaskBits(single, bits), hn::Gt(v, hn::Zero(single)));
    hn::StoreU(hn::IfThenElse(known, rounded, unknown), single, out + l);
  }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh {

HWY_EXPORT(log_ratios_simd);

void log_ratios(const float* value, uint64_t active, double isovalue, float* out) {
  HWY_DYNAMIC_DISPATCH(log_ratios_simd)(value, active, isovalue, out);
}

} // namespace molmesh
#endif
