// complex_passes.hpp — builds the complex, and puts grid points back where an element would have no volume; pass by
// pass, over a launcher.
#pragma once
#include "base/error.hpp"
#include "contour/complex/complex.hpp"
#include "contour/complex/distance_items.hpp"
#include "contour/complex/dual_vertex.hpp"
#include "contour/complex/numbering_items.hpp"
#include "par/atomic_updates.hpp"
#include "par/passes.hpp"
#include <utility>

namespace molmesh::contour {

struct GatherMovedPoints {
  ComplexView c;
  MOLMESH_HD int64_t operator()(int64_t v, int32_t* out) const {
    if (!c.has_moved[v])
      return 0;
    if (out)
      *out = static_cast<int32_t>(v);
    return 1;
  }
};
struct GatherInsideAtWall {
  ComplexView c;
  MOLMESH_HD int64_t operator()(int64_t v, int32_t* out) const {
    if (!c.at_wall(static_cast<int32_t>(v)) || !c.inside(static_cast<int32_t>(v)))
      return 0;
    if (out)
      *out = static_cast<int32_t>(v);
    return 1;
  }
};
struct SplitLeaves {
  static constexpr int64_t most = 1;
  ComplexView c;
  MOLMESH_HD int64_t operator()(int64_t leaf, int32_t* out) const {
    const bool split = c.is_split(static_cast<int32_t>(leaf));
    if (split && out)
      *out = static_cast<int32_t>(leaf);
    return split;
  }
};
/// Leaves with a corner near the surface.
struct GatherLeavesNearSurface {
  ComplexView c;
  MOLMESH_HD int64_t operator()(int64_t leaf, int32_t* out) const {
    bool near = false;
    for (int k = 0; k < 8; ++k)
      near = near || c.nearest[c.grid_vertex[8 * leaf + k]] >= 0;
    if (near && out)
      *out = static_cast<int32_t>(leaf);
    return near;
  }
};
// Flags raised, by many vertices or leaves at once.
/// At moved grid points among a vertex and the corners of its leaf.
struct RaiseSpoiling {
  ComplexView c;
  const int32_t* spoiled;
  uint8_t* flag; ///< [grid vertices]
  MOLMESH_HD void operator()(int64_t i) const {
    const int32_t v = spoiled[i], leaf = c.leaf_of(v);
    for (int k = leaf >= 0 ? 0 : 8; k < 9; ++k)
      if (const int32_t u = k < 8 ? c.corner_vertex(leaf, k) : v; c.moved(u))
        par::raise(flag[u]);
  }
};
/// At leaves with one of these grid points as a corner.
struct RaiseLeavesRound {
  static constexpr int64_t grain = 64;
  ComplexView c;
  const int32_t* vertex;
  uint8_t* flag; ///< [leaves]
  MOLMESH_HD void operator()(int64_t i) const {
    NearLeaves near(c.tree);
    of_point(near, i);
  }
  void run(int64_t begin, int64_t end) const {
    NearLeaves near(c.tree);
    for (int64_t i = begin; i < end; ++i)
      of_point(near, i);
  }

private:
  MOLMESH_HD void of_point(NearLeaves& near, int64_t i) const {
    for (int octant = 0; octant < 8; ++octant)
      if (const int32_t leaf = leaf_with_corner(near, c.point[vertex[i]], octant); leaf >= 0)
        par::raise(flag[leaf]);
  }
};
struct RaiseCorners {
  ComplexView c;
  const int32_t* leaf;
  uint8_t* flag; ///< [grid vertices]
  MOLMESH_HD void operator()(int64_t i) const {
    for (int k = 0; k < 8; ++k)
      par::raise(flag[c.corner_vertex(leaf[i], k)]);
  }
};
struct PlaceDuals {
  PlaceDual place;
  const int32_t* leaf;
  MOLMESH_HD void operator()(int64_t i) const { place(leaf[i]); }
};
/// The passes on a complex in a launcher's memory.
template <par::Launcher Launcher, class Memory = Launcher>
class ComplexPasses : public ComplexArrays<Memory> {
public:
  using Ids = par::List<Launcher, int32_t>;
  template <class T>
  using Array = typename Launcher::template Array<T>;

  /// Grid points keep their distance from the surface, dual vertices are in their places. What the arguments point
  /// to stays the caller's.
  ComplexPasses(Launcher& m, const LatticeView& lattice, const OctreeView& tree, const SurfaceCell* cells,
                const SurfaceSample* samples, int64_t surface_cells)
      : m_(m) {
    ComplexView& v = this->view;
    v.lattice = lattice;
    v.tree = tree;
    v.cells = cells;
    v.samples = samples;
    v.surface_cells = static_cast<int32_t>(surface_cells);
    const int64_t leaves = tree.leaves;
    this->first_cell = m.filled(leaves, int32_t{-1});
    v.first_cell = this->first_cell.data();
    m.for_n("find surface", surface_cells, ClaimLeaf{v}, {double(surface_cells) * 44});
    v.side = take(this->side, leaves);
    v.grid_vertex = take(this->grid_vertex, 8 * leaves);
    v.beside = take(this->beside, 6 * leaves);
    v.split = take(this->split, leaves);
    this->face_points = m.filled(leaves, uint16_t{0});
    v.face_points = this->face_points.data();
    {
      auto owned = m.template array<int32_t>(8 * leaves), first = m.template array<int32_t>(leaves + 1),
           extra = m.template array<int32_t>(leaves + 1);
      m.for_n("own corners", leaves, OwnCorners{tree, owned.data(), first.data(), v.beside}, {double(leaves) * 69});
      m.for_n("count pieces", leaves, CountPieces{v, extra.data()},
              {double(leaves) * 9 + double(surface_cells) * 40});
      v.grid_vertices = v.dual0 = m.scan("scan", first.data(), leaves);
      v.pieces = m.scan("scan", extra.data(), leaves);
      const int64_t points = v.grid_vertices;
      v.split_leaf = take(this->split_leaf, v.pieces);
      v.position = take(this->position, v.vertices());
      v.value = take(this->value, v.vertices());
      v.point = take(this->point, points);
      v.distance = take(this->distance, points);
      v.estimate = take(this->estimate, points);
      v.has_moved = take(this->has_moved, points);
      v.nearest = take(this->nearest, points);
      v.least_level = take(this->least_level, points);
      m.for_n("number corners", leaves, NumberCorners{v, owned.data(), first.data()},
              {double(leaves) * 45 + double(points) * 44});
      m.for_n("share corners", leaves, ShareCorners{v, owned.data()}, {double(leaves) * 70});
      m.for_n("number pieces", leaves, NumberPieces{v, extra.data()}, {double(leaves) * 12});
    }
    {
      auto sample = m.filled(v.grid_vertices, LookFromLeaf::none);
      auto level = m.filled(v.grid_vertices, ~uint32_t{0});
      m.for_n("look from leaves", leaves, LookFromLeaf{v, sample.data(), level.data()},
              {double(leaves) * 34 + double(surface_cells) * 32});
      m.for_n("keep distance", v.grid_vertices, KeepDistance{v, sample.data(), level.data()},
              {double(v.grid_vertices) * 42});
    }
    m.for_n("place dual vertices", leaves, PlaceDual{v}, {double(leaves) * 30 + double(surface_cells) * 300});
  }

  /// Whether an inside grid point lies on a wall of the lattice.
  bool meets_wall() {
    return par::gather<int32_t>(m_, "inside at wall", this->view.grid_vertices, GatherInsideAtWall{this->view}).n >
           0;
  }

  /// Validity is proven for cells that are boxes: where a moved grid point spoils it, it goes back. Returns how
  /// many did. spoiled_of(leaves, ends): vertices that elements without positive volume would hang on, of the
  /// leaves' faces and of rings with both ends among `ends` or not grid points (null: all).
  template <class SpoiledOf>
  int64_t restore_spoiling(SpoiledOf spoiled_of) {
    // Every face of a surface cell belongs to a leaf with a corner in common.
    Ids spoiled = spoiled_of(par::gather<int32_t>(m_, "leaves near surface", this->view.tree.leaves,
                                                  GatherLeavesNearSurface{this->view}),
                             static_cast<const Ids*>(nullptr));
    constexpr int most_rounds = 8; // then all go back: time must be bounded
    int64_t restored = 0;
    for (int round = 0; spoiled.n > 0; ++round) {
      const Ids spoiling = spoiling_vertices(spoiled, round == most_rounds);
      restored += spoiling.n;
      m_.for_n("restore", spoiling.n, Restore{this->view, spoiling.data()});
      const Ids leaves = leaves_round(spoiling);
      m_.for_n("place dual vertices", leaves.n, PlaceDuals{{this->view}, leaves.data()});
      // An edge of a leaf, halves and those on its faces included, has its ends among the corners of the leaves
      // around; all faces at it belong to leaves with such a corner. Rings of other edges may be incomplete.
      const Ids ends = corners_of(leaves_round(corners_of(leaves)));
      spoiled = spoiled_of(leaves_round(ends), &ends);
    }
    return restored;
  }

private:
  template <class T>
  T* take(Array<T>& store, int64_t n) {
    store = m_.template array<T>(n);
    return store.data();
  }
  /// What Raise, from these ids, raises of `most` flags, ascending.
  template <class Raise>
  Ids raised(const char* name, const Ids& ids, int64_t most) {
    auto flag = m_.filled(most, uint8_t{0});
    m_.for_n(name, ids.n, Raise{this->view, ids.data(), flag.data()});
    return par::flagged(m_, name, most, flag.data());
  }
  /// Leaves with one of these grid points as a corner.
  Ids leaves_round(const Ids& ids) { return raised<RaiseLeavesRound>("leaves round", ids, this->view.tree.leaves); }
  Ids corners_of(const Ids& leaves) { return raised<RaiseCorners>("corners", leaves, this->view.grid_vertices); }
  /// Moved grid points that elements without positive volume hang on: themselves, or through the dual vertex of a
  /// cell with such a corner; all that are moved where that is none, since a ring may hang on a face point, and
  /// that on grid points further on.
  Ids spoiling_vertices(const Ids& spoiled, bool all) {
    Ids spoiling = raised<RaiseSpoiling>("spoiling", spoiled, this->view.grid_vertices);
    if (all || spoiling.n == 0)
      spoiling = par::gather<int32_t>(m_, "moved", this->view.grid_vertices, GatherMovedPoints{this->view});
    if (spoiling.n == 0)
      fail(Status::failed, "contour: an element of unmoved boxes has no volume");
    return spoiling;
  }
  Launcher& m_;
};

} // namespace molmesh::contour
