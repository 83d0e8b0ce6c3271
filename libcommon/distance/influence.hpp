// influence.hpp — what may give a place its distance to the boundary of a union of balls: balls, arcs and vertices
// by one number, each with the ball of places for which it may.
#pragma once
#include "distance/boundary.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::distance {

/// Signed distances that are wanted, Å, positive in U. Of others it only counts on which side of these they are.
struct Wanted {
  double lowest, highest;
};

/// Keeps references to all that it is given.
class Influence {
public:
  Influence(const UnionOfBalls& balls, const Boundary& boundary, Wanted wanted);

  const std::vector<Ball>& balls() const { return balls_.balls(); }
  const Boundary& boundary() const { return boundary_; }
  Wanted wanted() const { return wanted_; }
  /// How far outside of its sphere a ball may give a wanted distance; how far from an arc or a vertex a place of U
  /// may be for that.
  double beyond_balls() const { return wanted_.lowest < 0 ? -wanted_.lowest : 0; }
  double beyond_edges() const { return wanted_.highest > 0 ? wanted_.highest : 0; }

  /// The places, by number: first the balls, then the arcs, then the vertices.
  const std::vector<Ball>& places() const { return place_; }
  int32_t first_arc() const { return balls_.size(); }
  int32_t first_vertex() const { return first_arc() + static_cast<int32_t>(boundary_.arc.size()); }

private:
  const UnionOfBalls& balls_;
  const Boundary& boundary_;
  const Wanted wanted_;
  std::vector<Ball> place_;
};

} // namespace molmesh::distance
