// active_values.hpp — how many values a density grid holds near the surface, and their range.
#pragma once
#include "grid/block_grid.hpp"

namespace molmesh {

struct ActiveValues {
  int64_t count = 0;
  float least = 0, most = 0; ///< G; 0 where there is none
};

/// Same result at any number of threads.
ActiveValues active_values(const BlockGrid& grid, int threads);

} // namespace molmesh
