// plan.hpp — how large a mesh will be and what it takes, before it is made.
#pragma once
#include "contour/octree/leaves.hpp"
#include "contour/options.hpp"
#include "contour/small_bodies/finer_grid.hpp"
#include "grid/block_grid.hpp"
#include <optional>

namespace molmesh::contour {

/// The octree of a mesh of both sides: elements are some 16 a leaf, on the side where the leaf lies,
/// and more at split cells.
struct Leaves {
  double all = 0, inside = 0; ///< inside: by the share of a leaf's corners that are
  int halvings = 0;           ///< as in Summary
  double adapt = 0;           ///< the tolerance that chords allowed, in grid spacings
  double surface = 0;         ///< those whose corners lie on both sides
  double split = 0;           ///< fine cells with two pieces of the surface: at its thinnest places
  Leaves times(double share) const {
    return {share * all, share * inside, halvings, adapt, share * surface, split};
  }
  /// Of a part of the structure that is as so many.
  void add(const Leaves& part, double weight) {
    all += weight * part.all;
    inside += weight * part.inside;
    surface += weight * part.surface;
    split += weight * part.split;
    adapt = part.adapt;
  }
};

/// The octrees of one grid. Throws as contour().
class LeafCounter {
public:
  /// The grid stays the caller's.
  LeafCounter(const BlockGrid& grid, const Options& options);
  LeafCounter(const LeafCounter&) = delete;
  LeafCounter& operator=(const LeafCounter&) = delete;
  /// As the options say; or with another tolerance and other layers.
  Leaves count() const;
  Leaves count(double adapt, int layers) const;
  double volume() const; ///< Å³ within the isosurface that the grid shows, without cavities

private:
  Leaves count(const RefineOptions& refine) const;
  Options options_;
  FinerGrid finer_;
  std::optional<Lattice> lattice_;
  Surface surface_;
  int64_t split_ = 0;
  RefineOptions refine_;
};

/// Counts them: surface cells and octree of contour(), a tenth of its time. Throws as contour().
Leaves count_leaves(const BlockGrid& grid, const Options& options);

/// The leaves of the same structure on a grid of another spacing, with the default tolerance: within 8 % from twice
/// or half the spacing, for 0.25 to 3 Å. smooth: of a surface without atoms.
Leaves at_spacing(const Leaves& counted, double from, double to, bool smooth = false);
/// The leaves of a grid with so many active points, with the default tolerance and box: within a sixth for
/// molecules of some thousand atoms and more.
Leaves expected_leaves(double spacing, int64_t active_points);

struct Plan {
  int64_t elements = 0, points = 0, triangles = 0;
  int64_t across = 0; ///< edges from surface to surface through a thin place
  int64_t memory = 0; ///< bytes at the peak of density2tet
  double seconds = 0; ///< of one core of the machine of docs/benchmarks.md
};

/// blocks: of the grid.
Plan plan(const Leaves& leaves, int64_t blocks, Options::Meshed meshed);

/// Whether a GPU makes the mesh sooner than so many threads of the host, in spite of its start.
bool is_sooner_on_device(const Plan& plan, int threads);

} // namespace molmesh::contour
