// parts.cpp — the parts of threads: lattices over boxes, and boxes of their cells around points.
#include "optimize/mesh/parts.hpp"
#include <cmath>

namespace molmesh::optimize {

void Parts::set_lattice(const PointBox& box, double size, int shift, double most) {
  low = box.low;
  // Fractions of a cell that never line up again on all axes: every neighborhood lies inside some part soon.
  static constexpr double stride[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  for (int a = 0; a < 3; ++a)
    offset[a] = shift * stride[a] - std::floor(shift * stride[a]);
  const Vec3d extent = box.high - box.low;
  const auto cells_on = [&](int a) { return std::floor(extent[a] / size) + 2; };
  while (cells_on(0) * cells_on(1) * cells_on(2) > most)
    size *= 2;
  cell = size;
  box_of.clear();
  boxes = 0;
  for (int a = 0; a < 3; ++a)
    n[a] = static_cast<int64_t>(cells_on(a));
}

bool Parts::add_box(Vec3d p, int32_t reach) {
  box_of.resize(size_t(cells()), -1);
  Vec3i low_cell = cell_at(p), high_cell = low_cell;
  for (int a = 0; a < 3; ++a) {
    low_cell[a] = std::max(low_cell[a] - reach, 0);
    high_cell[a] = std::min(high_cell[a] + reach, static_cast<int32_t>(n[a]) - 1);
  }
  for (const bool take : {false, true})
    for (int32_t x = low_cell.x; x <= high_cell.x; ++x)
      for (int32_t y = low_cell.y; y <= high_cell.y; ++y)
        for (int32_t z = low_cell.z; z <= high_cell.z; ++z) {
          int32_t& box = box_of[number({x, y, z})];
          if (take)
            box = boxes;
          else if (box >= 0)
            return false;
        }
  ++boxes;
  return true;
}

} // namespace molmesh::optimize
