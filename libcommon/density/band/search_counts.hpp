// search_counts.hpp — counts what a search did, for the report.
#pragma once
#include <cstdint>

namespace molmesh::density {

struct SearchCounts {
  int64_t blocks_visited = 0, blocks_evaluated = 0;
  int64_t group_visits = 0, atom_visits = 0; ///< groups and atoms summed, once a block
  int64_t active_points = 0;
};

} // namespace molmesh::density
