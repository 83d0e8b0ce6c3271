// hilbert.hpp — orders points along the Hilbert curve: neighbors on it are neighbors in space.
// After J. Skilling, Programming the Hilbert curve, AIP Conf. Proc. 707 (2004).
#pragma once
#include "geom/morton.hpp"

namespace molmesh {

/// Place of p on the curve through the cube of 2^bits points an axis; coordinates in [0, 2^bits), bits ≤ 21.
constexpr uint64_t hilbert(Vec3i p, int bits) {
  uint32_t x[3] = {static_cast<uint32_t>(p.x), static_cast<uint32_t>(p.y), static_cast<uint32_t>(p.z)};
  // Each octant's lower bits are turned as the curve runs through it: no branches, their sides are anyone's guess.
  for (int bit = bits - 1; bit > 0; --bit)
    for (uint32_t& axis : x) {
      const uint32_t lower = (uint32_t{1} << bit) - 1, high = -(axis >> bit & 1),
                     swapped = (x[0] ^ axis) & lower & ~high;
      x[0] ^= (lower & high) | swapped;
      axis ^= swapped;
    }
  x[1] ^= x[0]; // a Gray code of the octants
  x[2] ^= x[1];
  uint32_t odd = 0;
  for (int bit = bits - 1; bit > 0; --bit)
    odd ^= ((uint32_t{1} << bit) - 1) & -(x[2] >> bit & 1);
  const auto place = [&](int a) { return static_cast<int32_t>(x[a] ^ odd); };
  return morton({place(2), place(1), place(0)});
}

} // namespace molmesh
