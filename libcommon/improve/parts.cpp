// parts.cpp — boxes of cells around points.
#include "improve/parts.hpp"

namespace molmesh::improve {

bool Parts::add_box(Vec3d p, int32_t reach) {
  box_of.resize(size_t(cells()), -1);
  Vec3i low_cell = cell_at(p), high_cell = low_cell;
  for (int a = 0; a < 3; ++a) {
    low_cell[a] = std::max(low_cell[a] - reach, 0);
    high_cell[a] = std::min(high_cell[a] + reach, static_cast<int32_t>(n[size_t(a)]) - 1);
  }
  for (const bool take : {false, true})
    for (int32_t x = low_cell.x; x <= high_cell.x; ++x)
      for (int32_t y = low_cell.y; y <= high_cell.y; ++y)
        for (int32_t z = low_cell.z; z <= high_cell.z; ++z) {
          int32_t& box = box_of[size_t(number({x, y, z}))];
          if (take)
            box = boxes;
          else if (box >= 0)
            return false;
        }
  ++boxes;
  return true;
}

} // namespace molmesh::improve
