// lattice.hpp — the grid points that the octree divides: their values, and their positions up to the outer box.
#pragma once
#include "geom/sphere.hpp"
#include "grid/block_grid.hpp"
#include <array>
#include <vector>

namespace molmesh::contour {

/// Levels that surface cells may merge over: 32 fine spacings at most.
inline constexpr int most_merges = 5;

/// The outer boundary to mesh in: a box, or a sphere.
struct BoxRequest {
  enum Kind { automatic, tight, factor, padding, corners, sphere_factor, sphere_padding, sphere } kind = automatic;
  double scale = 0; ///< factor: times the surface's own extents, about its centre; sphere_factor: times its radius
  Vec3d lower, upper;  ///< corners: Å; met to the last bit
  double distance = 0; ///< padding, sphere_padding: Å from the surface's own extents, or its radius
  Sphere outer = {};   ///< sphere: to mesh in; the box of the lattice holds it
  bool is_sphere() const { return kind >= sphere_factor; }
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
  bool any_cut = false;
  BlockIndexView index{};
  const float* grid = nullptr;            ///< BlockGrid::value
  const uint64_t* active_words = nullptr; ///< BlockGrid::active
  const uint64_t* inside_words = nullptr; ///< laid out alike: values above the isovalue
  double spacing = 0;                     ///< of the grid, Å
  Vec3i grid_first, grid_last;            ///< lattice points; outside the lattice where a wall cuts the grid

  MOLMESH_HD float grid_value(Vec3i p) const { return value_in(index.find(p), p); }
  MOLMESH_HD float value(Vec3i p) const {
    for (int a = 0; any_cut && a < 3; ++a)
      for (int side = 0; side < 2; ++side)
        if (cut[a][side].cuts && p[a] == (side ? cells[a] : 0)) {
          const double share = cut[a][side].share;
          return static_cast<float>((1 - share) * cut_value(p, a, cut[a][side].plane) +
                                    share * cut_value(p, a, cut[a][side].plane + 1));
        }
    return grid_value(base + p);
  }
  MOLMESH_HD bool on_cut(Vec3i p) const {
    for (int a = 0; a < 3; ++a)
      if ((cut[a][0].cuts && p[a] == 0) || (cut[a][1].cuts && p[a] == cells[a]))
        return true;
    return false;
  }
  /// Whether the grid holds G there, not only the side; v: value(p) then. last: as for inside.
  MOLMESH_HD bool active(Vec3i p, float& v, BlockIndexView::Last& last) const {
    const Vec3i q = base + p;
    const int64_t b = index.find(q, last);
    if (b < 0 || !bit(active_words, b, q))
      return false;
    v = any_cut && on_cut(p) ? value(p) : grid[512 * b + slot(q)];
    return true;
  }
  MOLMESH_HD Vec3d position(Vec3i p) const { return {axis[0][p.x], axis[1][p.y], axis[2][p.z]}; }
  /// Between lattice points, each axis by itself; p within 0 … cells.
  MOLMESH_HD Vec3d between(Vec3d p) const {
    Vec3d x;
    for (int a = 0; a < 3; ++a) {
      const auto whole = static_cast<int64_t>(p[a]), last = int64_t{cells[a]} - 1;
      const int64_t i = whole < last ? whole : last;
      x[a] = axis[a][i] + (p[a] - static_cast<double>(i)) * (axis[a][i + 1] - axis[a][i]);
    }
    return x;
  }

  /// Of BlockGrid::active or what is laid out like it.
  MOLMESH_HD static bool bit(const uint64_t* words, int64_t block, Vec3i grid_point) {
    const int s = slot(grid_point);
    return words[8 * block + (s >> 6)] >> (s & 63) & 1;
  }
  /// At a point that block b, as the index names it, holds; grid_point: by its place within the block.
  MOLMESH_HD float value_in(int64_t b, Vec3i grid_point) const {
    return b == BlockIndexView::outside  ? 0
           : b == BlockIndexView::inside ? inside_value
                                         : grid[512 * b + slot(grid_point)];
  }

private:
  /// On the wall of axis a, at one of its two planes; on further cut axes at the nearer plane.
  MOLMESH_HD double cut_value(Vec3i p, int a, int32_t plane) const {
    Vec3i q = base + p;
    q[a] = plane;
    for (int b = a + 1; b < 3; ++b)
      for (int side = 0; side < 2; ++side)
        if (cut[b][side].cuts && p[b] == (side ? cells[b] : 0))
          q[b] = cut[b][side].share < 0.5 ? cut[b][side].plane : cut[b][side].plane + 1;
    return grid_value(q);
  }
};

/// Word i of inside_words.
struct SetInsideWords {
  const float* grid;
  float isovalue;
  uint64_t* words;
  MOLMESH_HD void operator()(int64_t i) const {
    const float* v = grid + 64 * i;
    uint64_t word = 0;
    for (int row = 0; row < 8; ++row) {
      uint32_t byte = 0;
      for (int z = 0; z < 8; ++z)
        byte |= uint32_t{v[8 * row + z] > isovalue} << z;
      word |= uint64_t{byte} << 8 * row;
    }
    words[i] = word;
  }
};

/// A box of fine cells. Lattice point p (0 … cells, per axis) is grid index base + p. Within the grid its position
/// is the grid's own; beyond it spacings change evenly so that the walls lie where they were asked to. A wall that
/// cuts through the grid lies between grid planes: its points take the density interpolated there.
class Lattice {
public:
  /// request.kind automatic: with `walls` at least twice the surface's extents, else at least the grid; sphere: the
  /// walls hold grid and sphere, cells are at most an eighth of its radius; the other kinds are met exactly. A
  /// sphere that depends on the surface is found before (outer_sphere.hpp). Throws Error(failed) when the grid has
  /// no surface, Error(usage) when the box is empty or not larger than a few cells.
  Lattice(const BlockGrid& grid, const BoxRequest& request, bool walls, int threads);
  Lattice(const Lattice&) = delete;
  Lattice& operator=(const Lattice&) = delete;

  Vec3i cells;       ///< fine cells per axis; multiples of 2^top_level where the walls allow
  int top_level = 0; ///< level of the largest octree cells
  float isovalue = 1;

  float value(Vec3i p) const { return view_.value(p); }
  Vec3d position(Vec3i p) const { return view_.position(p); }
  /// Points into the lattice and its grid.
  const LatticeView& view() const { return view_; }
  const BlockGrid& grid() const { return grid_; }
  const BlockIndex& index() const { return index_; }
  Vec3i base() const { return base_; }
  /// The walls were given as coordinates: a surface may meet them.
  bool cut_allowed() const { return cut_allowed_; }

private:
  using Cut = LatticeView::Cut;
  /// False when the axis does not divide into cells of top_level.
  bool plan_axis(int axis, double lower, double upper, int32_t first, int32_t last, BoxRequest::Kind kind);

  const BlockGrid& grid_;
  BlockIndex index_;
  LargeArray<uint64_t> inside_words_;
  Vec3i base_;
  std::array<std::vector<double>, 3> axis_;
  std::array<std::array<Cut, 2>, 3> cut_{};
  bool cut_allowed_ = false;
  LatticeView view_;
};

/// What a surface at a wall that may not cut it is refused with.
[[noreturn]] void refuse_surface_at_wall();

} // namespace molmesh::contour
