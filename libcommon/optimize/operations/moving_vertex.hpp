// moving_vertex.hpp — what operations share that look for the place of a vertex: its elements, a search, a step.
#pragma once
#include "base/open_table.hpp"
#include "optimize/acceptance/surface_fit.hpp"
#include "optimize/operations/operations.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

float deficit_of(const Region& r, const Acceptance& accept, const std::vector<int32_t>& elements); ///< sum
float deficit_of(const Acceptance& accept, const std::vector<Candidate>& elements);

double mean_edge(const Region& r, const std::vector<int32_t>& star, int32_t v); ///< of those at v (Å)

/// Directions that a vertex at x may take, an orthonormal basis of them; how many: all three, the free axes, the
/// plane across the normal of target or sphere, or the former's line in a wall or in another target's plane.
/// leaves_target: it is not kept on the target.
int directions_of(const Region& r, const Vertex& vertex, bool leaves_target, Vec3d x, Vec3d basis[3]);

/// Whether the moving triangles fit with the vertex at x.
inline bool fits_at(const Region& r, const Acceptance& accept, Vec3d x, const Fit& before) {
  return accept.fits(fit_of_triangles(r, accept, &x), before);
}
/// Fit::worth of the moving triangles with the vertex at x, 0 where one of the elements is as bad as `above`: what
/// a search raises to make the surface fit.
float worth_at(Region& r, const Acceptance& accept, Vec3d x, float above);
/// Raises `best` (of the elements, or worth_at) by moving x, of such a vertex, until it reaches `aim`. True when it
/// has moved.
bool search_place(Region& r, const Acceptance& accept, const Vertex& vertex, Vec3d& x, float& best, float aim,
                  double length, const Fit& before, float above);

/// What has moved where crossings are tested later.
struct Moves {
  SmallNumbers vertex;
  std::vector<Vec3d> from;   ///< of these
  std::vector<int64_t> face; ///< triangles that may cross others, 4 element + face
};
/// v is at its new place: stays when every element of its star is above `above` and their deficit no more than
/// `allowed`, and goes back to `from` otherwise. later: crossings are tested later.
bool accept_move(Region& r, const Acceptance& accept, const std::vector<int32_t>& star, int32_t v, Vec3d from,
                 float above, float allowed, Moves* later = nullptr);
/// Moves v, r.work.star being its elements, as far as they stay above: all the way, or steps shorter each time.
bool step_towards(Region& r, const Acceptance& accept, int32_t v, Vec3d to, double shorter, double least,
                  float above, Moves* later = nullptr);

} // namespace molmesh::optimize
