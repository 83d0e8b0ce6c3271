// owner_borders.hpp — finds the nodes of the octree that a border between two domains of the molecule may cross.
#pragma once
#include "contour/octree/lattice.hpp"
#include "par/passes.hpp"
#include <cstdint>
#include <functional>
#include <vector>

namespace molmesh::contour {

/// Who owns a place, and ln of its share over the next one's.
struct Owner {
  int32_t owner;
  double lead;
};
/// Of places (Å). The lead is about linear over a few spacings where another owner is near.
using FindOwners = std::function<std::vector<Owner>(const std::vector<Vec3d>&)>;

/// Nodes of level 1 with a point inside, in words of 4³ nodes: those whose corners and middle have several owners,
/// or leads that vary by so much that another owner may come first between them. Found from larger nodes down, so
/// what an owner has in one place alone, smaller than 16 spacings, may be missed.
std::vector<par::KeyedWord> owner_borders(const Lattice& lattice, const FindOwners& owners);

} // namespace molmesh::contour
