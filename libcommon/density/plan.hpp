// plan.hpp — what the density of a hierarchy will take, told from a coarser one.
#pragma once
#include "density/density.hpp"

namespace molmesh::density {

/// What a grid of some spacing holds.
struct GridSize {
  double spacing = 0;        ///< h, Å
  Vec3i points;              ///< of the full grid
  int64_t active_points = 0; ///< in the file
  int64_t blocks = 0;        ///< of 8³ points, those with active points
  int64_t inside_blocks = 0; ///< those that lie wholly inside
  bool smooth = false;       ///< of great balls: the surface does not grow with the resolution
};

/// The same structure on a grid of another spacing. Exact for the spacing that was counted.
GridSize at_spacing(const GridSize& counted, double spacing);

/// Times h²: what the active points of a grid of h seldom exceed. 24 for an atom among others, and the whole sphere
/// of one that is larger than atoms are.
double most_active_points(const Hierarchy& hierarchy);
/// Whether nearly all of these are of spheres far larger than atoms.
bool of_great_balls(const Hierarchy& hierarchy);

/// Of hier2density on a grid of that size: bytes at the peak, and seconds of one core of the machine of
/// docs/benchmarks.md.
struct Cost {
  int64_t memory = 0;
  double seconds = 0;
};
Cost cost(const GridSize& size, int64_t atoms);

/// A cube of a grid too large to count.
struct PlanSample {
  Band band;
  Vec3d low, high;   ///< Å, on planes of its grid
  double weight = 0; ///< what it holds times this, summed over the samples, is what the whole holds
};

struct Plan {
  GridSize size, counted;         ///< of the run, and of the grid that was counted: the run's own, or a coarser one
  Band band;                      ///< of the counted grid; empty with samples
  std::vector<PlanSample> sample; ///< instead of the whole
  double margin = 0;              ///< Å
};

/// What a tile of the planned grid holds, as the counted band is distributed.
GridSize part_of(const Plan& plan, Tile tile);

/// Counts the band on a grid of h, 2h, 4h, …, the first of some three million active points, and but for great
/// balls no coarser than 1.5 Å where h is finer; throws as compute().
Plan plan(const Hierarchy& hierarchy, const Options& options);
/// The grid of plan() for so many atoms that are no great balls.
double counted_spacing(double spacing, int64_t atoms);
/// The same, of millions of atoms from samples.
Plan quick_plan(const Hierarchy& hierarchy, const Options& options);

} // namespace molmesh::density
