// tail.hpp — bounds a field far from its surface, for those who have the band alone.
#pragma once
#include "grid/block_grid.hpp"
#include "grid/tail.hpp"
#include "molecule/hierarchy.hpp"

namespace molmesh::density {

/// Of the field that `h` has with that decay rate, seen on that grid (docs/theory/field.md §8). Not known where an
/// atom, or a body without atoms whose skin is thinner than half the diagonal of a cell, may slip through the grid.
Tail tail(const Hierarchy& h, double decay, double isovalue, const GridFrame& frame);

} // namespace molmesh::density
