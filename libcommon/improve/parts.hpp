// parts.hpp — the parts of one pass: cells of a coarse lattice, each with the vertices in it when the pass began.
#pragma once
#include "geom/vec.hpp"
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace molmesh::improve {

/// Cells are disjoint and convex: what keeps to its own never meets what keeps to another.
struct Parts {
  std::vector<int32_t> owner; ///< [vertices] cell it began in, or is reserved for; -1: a free slot
  Vec3d low;                  ///< of all points
  double cell = 1;
  std::array<double, 3> offset{}; ///< in cells, in [0, 1)
  std::array<int64_t, 3> n{1, 1, 1};

  int32_t count() const { return static_cast<int32_t>(n[0] * n[1] * n[2]); }
  /// The cell at p; beyond the outermost ones, the nearest of them.
  int32_t at(Vec3d p) const {
    const auto on_axis = [this](double x, double first, size_t a) {
      return static_cast<int32_t>(std::clamp((x - first) / cell + offset[a], 0., double(n[a] - 1)));
    };
    const auto rows = static_cast<int32_t>(n[1]), columns = static_cast<int32_t>(n[2]);
    return (on_axis(p.x, low.x, 0) * rows + on_axis(p.y, low.y, 1)) * columns + on_axis(p.z, low.z, 2);
  }
  bool owns(int32_t part, const std::array<int32_t, 4>& v) const {
    return owner[size_t(v[0])] == part && owner[size_t(v[1])] == part && owner[size_t(v[2])] == part &&
           owner[size_t(v[3])] == part;
  }
};

} // namespace molmesh::improve
