// join.hpp — joins densities on one lattice: sum, union, difference (§6 of Liao et al. 2013: the assembly of
// filaments).
#pragma once
#include "geom/rigid.hpp"
#include "grid/block_grid.hpp"
#include "grid/tail.hpp"
#include <span>
#include <string>

namespace molmesh::compose {

/// A density whose point p is point p + shift of the whole.
struct Placed {
  const BlockGrid* grid; ///< several may share one
  Vec3i shift;
  Tail tail; ///< of the grid
  bool subtract = false;
  /// Of a resampled grid: the grid that it was made of, for which the tail holds, and the motion from indices of
  /// the whole to its indices. Null: `grid` itself.
  const BlockGrid* body = nullptr;
  Rigid to_body = {};
  std::string name = {}; ///< for messages
};

enum class Combine {
  sum, ///< equation 6
  max, ///< the union of the bodies, pointwise
};

struct Options {
  Combine combine = Combine::sum;
  double unknown = 0.02; ///< how much density may be missing at a point, in isovalues
  int threads = 1;
};

struct Counts {
  int64_t shared_points = 0;  ///< points whose value has several terms
  double largest_unknown = 0; ///< the most that may be missing near the surface, in units of G
};

/// The density of the whole on its frame. `info` says everything but the tolerance, which becomes what holds for
/// the result (I1): docs/theory/field.md §8. All grids have the frame's spacing and info's isovalue.
///
/// sum: adds values where grids know theirs. A grid that only tells "outside" at a point counts 0 there, and the
/// most that it may have is known: band_lower, or what its tail allows. Throws Error(usage) where more than
/// options.unknown isovalues are missing from a known value, or at a point that could be inside without them. That
/// share is at most what lies between band_lower and the isovalue (I2).
/// max: the largest value; complete without further knowledge.
/// Grids to subtract follow: the result is min(G, v²/G_subtracted), v the isovalue.
BlockGrid join(const GridFrame& frame, const FieldInfo& info, std::span<const Placed> placed,
               const Options& options, Counts& counts);

} // namespace molmesh::compose
