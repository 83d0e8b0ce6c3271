// influence.cpp — the ball of places of each ball, arc and vertex.
#include "distance/influence.hpp"

namespace molmesh::distance {

Influence::Influence(const UnionOfBalls& balls, const Boundary& boundary, Wanted wanted)
    : balls_(balls), boundary_(boundary), wanted_(wanted) {
  place_.reserve(balls.balls().size() + boundary.arc.size() + boundary.vertex.size());
  for (const Ball& b : balls.balls())
    place_.push_back({b.center, b.radius + beyond_balls()});
  for (const Arc& a : boundary.arc) {
    const Ball bounds = a.bounds();
    place_.push_back({bounds.center, bounds.radius + beyond_edges()});
  }
  for (const Vec3d& v : boundary.vertex)
    place_.push_back({v, beyond_edges()});
}

} // namespace molmesh::distance
