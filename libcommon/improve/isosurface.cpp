// isosurface.cpp — log G of the active points.
#include "improve/isosurface.hpp"
#include "par/par.hpp"
#include <cmath>
#include <limits>

namespace molmesh::improve {

Isosurface::Isosurface(const BlockGrid& grid, int threads)
    : frame_(grid.frame), index_(grid), log_(grid.value.size()) {
  const double iso = grid.info.isovalue;
  par::for_n(static_cast<int64_t>(grid.active.size()), threads, 64, [&](int64_t w) {
    const uint64_t bits = grid.active[static_cast<size_t>(w)];
    for (int b = 0; b < 64; ++b) {
      const size_t s = static_cast<size_t>(64 * w + b);
      log_[s] = bits >> b & 1 && grid.value[s] > 0 ? static_cast<float>(std::log(grid.value[s] / iso))
                                                   : std::numeric_limits<float>::quiet_NaN();
    }
  });
}

} // namespace molmesh::improve
