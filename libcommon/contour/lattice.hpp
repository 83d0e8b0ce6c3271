// lattice.hpp — the grid points that the octree divides: their values, and their positions up to the outer box.
#pragma once
#include "density/block_grid.hpp"
#include "geom/vec.hpp"
#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace molmesh::contour {

/// What --box asks for.
struct BoxRequest {
  enum Kind { automatic, tight, factor, corners } kind = automatic;
  double scale = 0;   ///< factor: times the surface's own extents, about its centre
  Vec3d lower, upper; ///< corners: Å; met to the last bit
};

/// A lattice as plain arrays. Host and device.
struct LatticeView {
  /// A wall through the grid: its points take what is interpolated between two planes.
  struct Cut {
    bool cuts = false;
    int32_t plane = 0; ///< grid index below the wall
    double share = 0;  ///< of the plane above
  };
  Vec3i cells, base;
  float isovalue = 1, inside_value = 0;
  const double* axis[3] = {}; ///< [cells + 1] positions, Å
  Cut cut[3][2];              ///< axis; lower, upper side
  BlockIndexView index{};
  const float* grid = nullptr; ///< BlockGrid::value

  HD float grid_value(Vec3i p) const {
    const int64_t b = index.find(p);
    return b == BlockIndexView::outside ? 0 : b == BlockIndexView::inside ? inside_value : grid[512 * b + slot(p)];
  }
  HD float value(Vec3i p) const {
    for (int a = 0; a < 3; ++a)
      for (int side = 0; side < 2; ++side)
        if (cut[a][side].cuts && p[a] == (side ? cells[a] : 0)) {
          const double share = cut[a][side].share;
          return static_cast<float>((1 - share) * cut_value(p, a, cut[a][side].plane) +
                                    share * cut_value(p, a, cut[a][side].plane + 1));
        }
    return grid_value(base + p);
  }
  HD bool inside(Vec3i p) const { return value(p) > isovalue; }
  HD Vec3d position(Vec3i p) const { return {axis[0][p.x], axis[1][p.y], axis[2][p.z]}; }
  /// Between lattice points, each axis by itself; p within 0 … cells.
  HD Vec3d between(Vec3d p) const {
    Vec3d x;
    for (int a = 0; a < 3; ++a) {
      const auto whole = static_cast<int64_t>(p[a]), last = int64_t{cells[a]} - 1;
      const int64_t i = whole < last ? whole : last;
      x[a] = axis[a][i] + (p[a] - static_cast<double>(i)) * (axis[a][i + 1] - axis[a][i]);
    }
    return x;
  }

private:
  /// On the wall of axis a, at one of its two planes; on further cut axes at the nearer plane.
  HD double cut_value(Vec3i p, int a, int32_t plane) const {
    Vec3i q = base + p;
    q[a] = plane;
    for (int b = a + 1; b < 3; ++b)
      for (int side = 0; side < 2; ++side)
        if (cut[b][side].cuts && p[b] == (side ? cells[b] : 0))
          q[b] = cut[b][side].share < 0.5 ? cut[b][side].plane : cut[b][side].plane + 1;
    return grid_value(q);
  }
};

/// A box of fine cells. Lattice point p (0 … cells, per axis) is grid index base + p. Within the grid its position
/// is the grid's own; beyond it spacings stretch evenly so that the walls lie where they were asked to. A wall that
/// cuts through the grid lies between grid planes: its points take the density interpolated there.
class Lattice {
public:
  /// request.kind automatic: with `walls` at least twice the surface's extents, else at least the grid; the other
  /// kinds are met exactly. Throws Error(failed) when the grid has no surface, Error(usage) when the box is empty
  /// or not larger than a few cells.
  Lattice(const BlockGrid& grid, const BoxRequest& request, bool walls);
  Lattice(const Lattice&) = delete;
  Lattice& operator=(const Lattice&) = delete;

  Vec3i cells;       ///< fine cells per axis; multiples of 2^top_level where the walls allow
  int top_level = 0; ///< level of the largest octree cells
  float isovalue = 1;

  float value(Vec3i p) const { return view_.value(p); }
  /// Whether the grid holds G there, not only the side.
  bool active(Vec3i p) const { return is_active(grid_, index_, base_ + p); }
  bool inside(Vec3i p) const { return value(p) > isovalue; }
  Vec3d position(Vec3i p) const { return view_.position(p); }
  /// Between lattice points, each axis by itself; p within 0 … cells.
  Vec3d between(Vec3d p) const { return view_.between(p); }
  /// Points into the lattice and its grid.
  const LatticeView& view() const { return view_; }
  const BlockGrid& grid() const { return grid_; }
  const BlockIndex& index() const { return index_; }
  Vec3i base() const { return base_; }
  /// A wall through the grid, lower (0) or upper (1) side of the axis: its plane is interpolated.
  bool cuts(int axis, int side) const { return cut_[axis][side].cuts; }
  bool cuts() const;
  /// The walls were asked for as coordinates: a surface that meets them is meant to.
  bool cut_allowed() const { return cut_allowed_; }

private:
  using Cut = LatticeView::Cut;
  /// False when the axis does not divide into cells of top_level.
  bool plan_axis(int axis, double lower, double upper, int32_t first, int32_t last, bool exact);

  const BlockGrid& grid_;
  BlockIndex index_;
  Vec3i base_;
  std::array<std::vector<double>, 3> axis_;
  std::array<std::array<Cut, 2>, 3> cut_{};
  bool cut_allowed_ = false;
  LatticeView view_;
};

/// Index box (lowest and highest grid index) of the cells that the surface crosses. False when there is none.
bool surface_bounds(const BlockGrid& grid, Vec3i& lower, Vec3i& upper);

} // namespace molmesh::contour
