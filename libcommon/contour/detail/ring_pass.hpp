// ring_pass.hpp — the elements round one sign-change edge.
#pragma once
#include "contour/complex.hpp"
#include "contour/detail/batch.hpp"

namespace molmesh::contour::detail {

/// What a ring needs to know of vertices: those of the complex and the face and wall points after them.
struct RingVertices {
  const Complex& complex;
  const std::vector<Vec3d>& position;
  const std::vector<int32_t>& wall; ///< per vertex after the complex's own: Boundary of a wall point, 0 otherwise
};

/// links [begin, end): all links of one edge. The ring is closed, or at a wall an open chain from wall point to
/// wall point.
void make_ring(const RingVertices& v, const Link* begin, const Link* end, const bool wanted[2], Batch& out);

} // namespace molmesh::contour::detail
