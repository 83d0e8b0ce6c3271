// lanes.hpp — formulas that work on one place, or on several with one in each SIMD lane. Host and device.
// In them V is double or one of the compiler's vectors, whose bits are the scalar's, lane by lane. Vectors come and
// go by reference: what they look like as arguments depends on the processor. Square roots, which compilers have no
// operator for, are left to the caller.
#pragma once
#include "base/hd.hpp"

namespace molmesh {

template <class V>
MOLMESH_HD __attribute__((always_inline)) inline void squared_length(const V (&v)[3], V& out) {
  out = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

} // namespace molmesh
