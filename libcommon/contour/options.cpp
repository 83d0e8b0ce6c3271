// options.cpp — the mesher's options as those of the octree.
#include "contour/options.hpp"
#include <utility>

namespace molmesh::contour {

RefineOptions refine_options(const Lattice& lattice, const Options& options, double grid_spacing, int halvings) {
  RefineOptions refine;
  refine.adapt = options.adapt.value_or(default_adapt(grid_spacing)) * (1 << halvings);
  refine.inside = options.meshed != Options::exterior;
  refine.outside = options.meshed != Options::interior;
  refine.layers = options.layers;
  if (!options.sizes.empty()) {
    SizedNodes sized = sized_nodes(lattice.view(), options.sizes);
    refine.divided = std::move(sized.divided);
    refine.loose = std::move(sized.loose);
  }
  if (options.owners) {
    refine.divided.resize(std::max<size_t>(1, refine.divided.size()));
    refine.divided[0] = united(refine.divided[0], owner_borders(lattice, options.owners));
  }
  return refine;
}

} // namespace molmesh::contour
