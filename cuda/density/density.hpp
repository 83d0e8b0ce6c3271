// density.hpp — computes the density on the GPU.
#pragma once
#include "cuda/par/backend.hpp"
#include "density/density.hpp"

namespace molmesh::cuda {

/// density::compute with the search on the GPU. options.atoms must not be kdtree: atoms are found through the boxes
/// of the molecule. In slabs where most_bytes of the GPU's memory (0: nine tenths of what is free) ask for it.
/// Throws Error(mode_unavailable) where there is no GPU.
Band compute_density(const Hierarchy& h, const density::Options& options, density::Counts& counts,
                     DeviceReport& report, int64_t most_bytes = 0);

} // namespace molmesh::cuda
