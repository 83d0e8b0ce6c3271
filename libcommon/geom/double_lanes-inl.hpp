// double_lanes-inl.hpp — up to eight doubles side by side, for formulas whose text is the device's too. Included
// once per instruction set by Highway's foreach_target.
#if defined(MOLMESH_DOUBLE_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef MOLMESH_DOUBLE_LANES
#undef MOLMESH_DOUBLE_LANES
#else
#define MOLMESH_DOUBLE_LANES
#endif
#include <cstdint>
#include <cstring>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace molmesh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F = hn::CappedTag<double, 8>;
constexpr F f{};
constexpr int lanes = static_cast<int>(HWY_MIN(8, HWY_LANES(double)));
typedef double V __attribute__((vector_size(sizeof(double) * lanes))); // the compiler's, which has operators
typedef uint64_t U __attribute__((vector_size(sizeof(double) * lanes)));

HWY_INLINE void load(const double* from, V& v) {
  std::memcpy(&v, from, sizeof v);
}
HWY_INLINE void store(const V& v, double* to) {
  std::memcpy(to, &v, sizeof v);
}
HWY_INLINE void take_root(V& v) {
  auto* const p = reinterpret_cast<double*>(&v);
  hn::Store(hn::Sqrt(hn::Load(f, p)), f, p);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh
HWY_AFTER_NAMESPACE();

#endif
