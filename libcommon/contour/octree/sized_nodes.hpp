// sized_nodes.hpp — sizes that cells are asked to have near given places, as sets of octree nodes.
#pragma once
#include "contour/octree/lattice.hpp"
#include "par/passes.hpp"
#include <vector>

namespace molmesh::contour {

/// Cells that meet the ball have edges of at most `size`.
struct SizeBall {
  Vec3d center;        ///< Å
  double radius, size; ///< Å; size: at least the spacing, or there are no such cells
};

/// [level - 1], words of 4³ nodes, ascending: RefineOptions::divided and loose.
struct SizedNodes {
  std::vector<std::vector<par::KeyedWord>> divided, loose;
};

/// Sets of nodes, ascending, as one.
std::vector<par::KeyedWord> united(const std::vector<par::KeyedWord>& a, const std::vector<par::KeyedWord>& b);

/// divided: the smallest nodes that meet a ball and are larger than its size allows; balance divides the larger
/// ones. loose: the nodes in a ball, by their middle, of no more than its size. Where balls overlap the smallest
/// size holds.
SizedNodes sized_nodes(const LatticeView& lattice, const std::vector<SizeBall>& balls);

} // namespace molmesh::contour
