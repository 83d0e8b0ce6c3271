// dispatch.hpp — calls the SIMD code for this machine's instruction set, without a call into Highway each time.
#pragma once
#include <hwy/targets.h>

namespace molmesh {
inline const hwy::ChosenTarget& chosen_target = hwy::GetChosenTarget();
} // namespace molmesh

/// HWY_DYNAMIC_DISPATCH, whose look at the chosen target is a function of a shared library: one part in sixty of a
/// search that calls nine kernels a block. In this namespace, after HWY_EXPORT; not while static variables start.
#if (HWY_TARGETS & (HWY_TARGETS - 1)) == 0
#define MOLMESH_DISPATCH(kernel) HWY_DYNAMIC_DISPATCH(kernel)
#else
#define MOLMESH_DISPATCH(kernel) (*HWY_DISPATCH_TABLE(kernel)[chosen_target.GetIndex()])
#endif
