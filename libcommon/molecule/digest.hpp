// digest.hpp — a number that tells hierarchies apart by what their field is made of.
#pragma once
#include "molecule/hierarchy.hpp"
#include <cstdint>

namespace molmesh {

/// Of the atoms' places and radii, the groups and their exponents and weights, and the bodies; not of names and
/// charges. 64 bits: two structures by chance have the same once in 10^19.
uint64_t digest(const Hierarchy& h);

/// Goes on with another value.
constexpr uint64_t digest(uint64_t so_far, uint64_t value) {
  uint64_t x = (so_far ^ value) * 0x9E3779B97F4A7C15u; // as in MurmurHash3's end
  x = (x ^ x >> 32) * 0xD6E8FEB86659FD93u;
  return x ^ x >> 32;
}

} // namespace molmesh
