// refinement.hpp — which octree nodes must have children: where the surface needs its fine cells.
#pragma once
#include "contour/lattice.hpp"
#include "contour/surface_cells.hpp"
#include "contour/surface_sample.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::contour {

struct RefineOptions {
  /// Allowed distance of a cell's fine surface from its mean plane, in fine spacings; 0: every surface cell stays
  /// fine and so does every cell of the grid in the regions below.
  double adapt = 0;
  bool inside = true, outside = true; ///< regions to mesh
};

/// A node has children where merging its surface cells is not allowed (see merging.hpp), and where the surface
/// passes close to a face with children behind. Keeps references.
class Refinement {
public:
  Refinement(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
             const std::vector<SurfaceSample>& samples, const RefineOptions& options, int threads);
  /// nodes: those of this level (Morton keys shifted right by 3·level) that have children already; appends all that
  /// must have them too, some perhaps twice.
  void operator()(int level, std::vector<uint64_t>& nodes) const;

private:
  void spread(int level, const std::vector<int64_t>& begin, std::vector<uint64_t>& nodes) const;
  const Lattice& lattice_;
  const std::vector<SurfaceCell>& cells_;
  const std::vector<SurfaceSample>& samples_;
  RefineOptions options_;
  int threads_;
  std::vector<int8_t> merged_;
};

} // namespace molmesh::contour
