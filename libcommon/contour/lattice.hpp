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

/// A box of fine cells. Lattice point p (0 … cells, per axis) is grid index base + p. Within the grid its position
/// is the grid's own; beyond it spacings stretch evenly so that the walls lie where they were asked to. A wall that
/// cuts through the grid lies between grid planes: its points take the density interpolated there.
class Lattice {
public:
  /// request.kind automatic: with `walls` at least twice the surface's extents, else at least the grid; the other
  /// kinds are met exactly. Throws Error(failed) when the grid has no surface, Error(usage) when the box is empty
  /// or not larger than a few cells.
  Lattice(const BlockGrid& grid, const BoxRequest& request, bool walls);

  Vec3i cells;       ///< fine cells per axis; multiples of 2^top_level where the walls allow
  int top_level = 0; ///< level of the largest octree cells
  float isovalue = 1;

  float value(Vec3i p) const;
  /// Whether the grid holds G there, not only the side.
  bool active(Vec3i p) const { return is_active(grid_, index_, base_ + p); }
  bool inside(Vec3i p) const { return value(p) > isovalue; }
  Vec3d position(Vec3i p) const {
    return {axis_[0][static_cast<size_t>(p.x)], axis_[1][static_cast<size_t>(p.y)],
            axis_[2][static_cast<size_t>(p.z)]};
  }
  /// Between lattice points, each axis by itself; p within 0 … cells.
  Vec3d between(Vec3d p) const {
    Vec3d x;
    for (int a = 0; a < 3; ++a) {
      const auto i = std::min(static_cast<size_t>(p[a]), axis_[static_cast<size_t>(a)].size() - 2);
      const double* at = &axis_[static_cast<size_t>(a)][i];
      x[a] = at[0] + (p[a] - static_cast<double>(i)) * (at[1] - at[0]);
    }
    return x;
  }
  const BlockGrid& grid() const { return grid_; }
  const BlockIndex& index() const { return index_; }
  Vec3i base() const { return base_; }
  /// A wall through the grid, lower (0) or upper (1) side of the axis: its plane is interpolated.
  bool cuts(int axis, int side) const { return cut_[axis][side].cuts; }
  bool cuts() const;
  /// The walls were asked for as coordinates: a surface that meets them is meant to.
  bool cut_allowed() const { return cut_allowed_; }

private:
  struct Cut {
    bool cuts = false;
    int32_t plane = 0; ///< grid index below the wall
    double share = 0;  ///< of the plane above
  };
  float grid_value(Vec3i grid_index) const { return value_at(grid_, index_, grid_index); }
  /// False when the axis does not divide into cells of top_level.
  bool plan_axis(int axis, double lower, double upper, int32_t first, int32_t last, bool exact);

  const BlockGrid& grid_;
  BlockIndex index_;
  Vec3i base_;
  std::array<std::vector<double>, 3> axis_;
  std::array<std::array<Cut, 2>, 3> cut_{};
  bool cut_allowed_ = false;
};

/// Index box (lowest and highest grid index) of the cells that the surface crosses. False when there is none.
bool surface_bounds(const BlockGrid& grid, Vec3i& lower, Vec3i& upper);

} // namespace molmesh::contour
