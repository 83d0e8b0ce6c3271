// parts.hpp — divides a mesh among threads: cells of a coarse lattice, or boxes of such cells.
// They stand for the METIS partition of section 5 of Liao et al. 2013; mesh/partition.hpp numbers the output alone.
#pragma once
#include "geom/vec.hpp"
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

/// Around points; at first around none.
struct PointBox {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void add(const PointBox& o) {
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], o.low[a]);
      high[a] = std::max(high[a], o.high[a]);
    }
  }
};

/// Parts are disjoint and convex: a triangle that stays in its part never meets one that stays in another.
struct Parts {
  std::vector<int32_t>
      owner; ///< [vertices] the part that a vertex began in or is reserved for; -1: none, or a free slot
  Vec3d low; ///< of all points, or of the boxes' surroundings
  double cell = 1;
  std::array<double, 3> offset{}; ///< in cells, in [0, 1)
  std::array<int64_t, 3> n{1, 1, 1};
  std::vector<int32_t> box_of; ///< [cells] the box that a cell belongs to, -1: none; empty: every cell is a part
  int32_t boxes = 0;

  /// Makes every cell over the box a part; owner stays. shift: another one moves the lattice. size: of the cells
  /// (Å), doubled until there are no more than `most`.
  void set_lattice(const PointBox& box, double size, int shift, double most);
  int32_t cells() const { return static_cast<int32_t>(n[0] * n[1] * n[2]); }
  int32_t count() const { return box_of.empty() ? cells() : boxes; }
  /// The cell at p; beyond the outermost ones, the nearest of them.
  Vec3i cell_at(Vec3d p) const {
    const auto on_axis = [this](double x, double first, size_t a) {
      return static_cast<int32_t>(std::clamp((x - first) / cell + offset[a], 0., double(n[a] - 1)));
    };
    return {on_axis(p.x, low.x, 0), on_axis(p.y, low.y, 1), on_axis(p.z, low.z, 2)};
  }
  int32_t number(Vec3i c) const {
    return (c.x * static_cast<int32_t>(n[1]) + c.y) * static_cast<int32_t>(n[2]) + c.z;
  }
  /// The part at p; -1: none.
  int32_t at(Vec3d p) const {
    const int32_t c = number(cell_at(p));
    return box_of.empty() ? c : box_of[c];
  }
  /// Adds a part: the cells up to `reach` from the one at p. False where one of them belongs to another part.
  bool add_box(Vec3d p, int32_t reach);
  bool owns(int32_t part, const std::array<int32_t, 4>& v) const {
    return owner[v[0]] == part && owner[v[1]] == part && owner[v[2]] == part && owner[v[3]] == part;
  }
};

} // namespace molmesh::optimize
