// dual_contouring.hpp — dual contouring: from the octree's leaves and the surface's samples to the elements.
// Sections 4.1 and 4.2 of Liao et al. 2013.
#pragma once
#include "contour/complex/complex.hpp"
#include "contour/elements/elements.hpp"
#include "contour/octree/lattice.hpp"
#include "contour/octree/leaves.hpp"
#include "contour/octree/octree.hpp"
#include <functional>
#include <string>

namespace molmesh::contour {

/// Kept by the caller as long as the complex.
struct DualInput {
  const Lattice& lattice;
  const Octree& tree;
  const Surface& surface;
  Side unmeshed; ///< as ComplexView has it
  int threads;
};
struct Dual {
  Complex complex;
  Elements elements;
  int64_t restored_points = 0;
};

/// Throws Error(failed) when the surface meets a wall that may not cut it.
Dual make_dual(const DualInput& input, const std::function<void(const std::string&)>& on_phase);

} // namespace molmesh::contour
