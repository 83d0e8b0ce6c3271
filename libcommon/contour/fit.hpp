// fit.hpp — the finest mesh of at most so many elements that a grid gives.
#pragma once
#include "contour/plan.hpp"
#include "mesh/tet_mesh.hpp"
#include <functional>

namespace molmesh::contour {

/// Of a mesh's elements to the planned ones: what most have at the most, and what uniform cells have.
inline constexpr double usual_ratio = 1.03, least_ratio = 0.7;

/// How fine an octree is.
struct Fineness {
  double adapt = 0; ///< as Options, > 0
  int layers = 1;   ///< as Options
};

/// A member of a family of octrees in order: the tolerance falls, then layers become more.
struct Fit {
  Fineness fineness;
  Leaves leaves;
  double elements = 0;                   ///< planned
  bool coarsest = false, finest = false; ///< nothing of the family is coarser, or finer
};

/// Of the octrees that are planned to have at most `most` elements, about the largest; the coarsest where none has.
/// Throws nothing. Options::adapt and layers of the counter do not matter.
Fit fit(const LeafCounter& counter, const BlockGrid& grid, Options::Meshed meshed, double most);

/// Makes a mesh of at most `most` elements, and of at least 0.7 of them where the grid has so many: fits octrees,
/// makes the mesh (`make`, of options with another tolerance and layers), and fits once more where it is off its
/// plan. Same mesh for any number of threads. fitted: what it was made with; elements of the mesh. An empty mesh:
/// even the coarsest has more elements, fitted.elements.
TetMesh fitted_mesh(const LeafCounter& counter, const BlockGrid& grid, const Options& options, int64_t most,
                    const std::function<TetMesh(const Options&)>& make, Fit& fitted);

} // namespace molmesh::contour
