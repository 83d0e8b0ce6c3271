// dual.hpp — from the octree's leaves to the elements: complex, grid points that go back, elements.
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
  Side unasked; ///< as ComplexView has it
  int threads;
};
struct Dual {
  Complex complex;
  Elements elements;
  int64_t restored_points = 0;
};

/// Throws Error(failed) when the surface meets a wall that was not asked to cut it.
Dual make_dual(const DualInput& input, const std::function<void(const std::string&)>& on_phase);

} // namespace molmesh::contour
