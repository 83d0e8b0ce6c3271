// morton.hpp — orders points along the Z-order (Morton) curve: 21 bits an axis, x in the lowest place.
#pragma once
#include "geom/vec.hpp"
#include <cstdint>

namespace molmesh {

/// Spreads the low 21 bits of v to every third bit.
MOLMESH_HD constexpr uint64_t morton_spread(uint32_t v) {
  uint64_t x = v & 0x1FFFFF;
  x = (x | x << 32) & 0x1F00000000FFFF;
  x = (x | x << 16) & 0x1F0000FF0000FF;
  x = (x | x << 8) & 0x100F00F00F00F00F;
  x = (x | x << 4) & 0x10C30C30C30C30C3;
  return (x | x << 2) & 0x1249249249249249;
}

MOLMESH_HD constexpr uint32_t morton_gather(uint64_t x) {
  x &= 0x1249249249249249;
  x = (x | x >> 2) & 0x10C30C30C30C30C3;
  x = (x | x >> 4) & 0x100F00F00F00F00F;
  x = (x | x >> 8) & 0x1F0000FF0000FF;
  x = (x | x >> 16) & 0x1F00000000FFFF;
  return static_cast<uint32_t>((x | x >> 32) & 0x1FFFFF);
}

/// Coordinates must be in [0, 2^21).
MOLMESH_HD constexpr uint64_t morton(Vec3i p) {
  return morton_spread(static_cast<uint32_t>(p.x)) | morton_spread(static_cast<uint32_t>(p.y)) << 1 |
         morton_spread(static_cast<uint32_t>(p.z)) << 2;
}

MOLMESH_HD constexpr Vec3i morton_point(uint64_t key) {
  return {static_cast<int32_t>(morton_gather(key)), static_cast<int32_t>(morton_gather(key >> 1)),
          static_cast<int32_t>(morton_gather(key >> 2))};
}

/// The places of one axis in a key.
MOLMESH_HD constexpr uint64_t morton_axis(int axis) {
  return uint64_t{0x1249249249249249} << axis;
}
/// The key of the point 2^level further along the axis, and of the one just before, which must be there.
MOLMESH_HD constexpr uint64_t morton_after(uint64_t key, int axis, int level) {
  const uint64_t m = morton_axis(axis);
  return (((key | ~m) + (uint64_t{1} << (3 * level + axis))) & m) | (key & ~m);
}
MOLMESH_HD constexpr uint64_t morton_before(uint64_t key, int axis) {
  const uint64_t m = morton_axis(axis);
  return (((key & m) - (uint64_t{1} << axis)) & m) | (key & ~m);
}

} // namespace molmesh
