// density.hpp — hier2density --mode cuda.
#pragma once
#include "cuda/par/backend.hpp"
#include "density/density.hpp"

namespace molmesh::cuda {

/// density::compute with the search on the GPU. options.atoms must not be kdtree: atoms are found through the boxes
/// of the molecule. Throws Error(mode_unavailable) where there is no GPU.
density::Band compute_density(const Hierarchy& h, const density::Options& options, density::Counts& counts,
                              DeviceReport& report);

} // namespace molmesh::cuda
