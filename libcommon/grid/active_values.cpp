// active_values.cpp — counts bits and compares values, block by block.
#include "grid/active_values.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <bit>
#include <limits>

namespace molmesh {

ActiveValues active_values(const BlockGrid& grid, int threads) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  ActiveValues all = par::reduce(
      static_cast<int64_t>(grid.active.size()), threads, ActiveValues{0, infinity, -infinity},
      [&](int64_t w) {
        ActiveValues of{0, infinity, -infinity};
        for (uint64_t left = grid.active[w]; left != 0; left &= left - 1) {
          const float value = grid.value[64 * w + std::countr_zero(left)];
          ++of.count;
          of.least = std::min(of.least, value);
          of.most = std::max(of.most, value);
        }
        return of;
      },
      [](const ActiveValues& a, const ActiveValues& b) {
        return ActiveValues{a.count + b.count, std::min(a.least, b.least), std::max(a.most, b.most)};
      });
  return all.count > 0 ? all : ActiveValues{};
}

} // namespace molmesh
