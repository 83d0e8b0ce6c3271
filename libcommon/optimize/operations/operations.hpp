// operations.hpp — the operations on a region: each is tried, and done where the acceptance has it.
#pragma once
#include "optimize/acceptance/acceptance.hpp"
#include "optimize/operations/region.hpp"

namespace molmesh::optimize {

// Each tells whether it was done; where not, nothing has changed. i, j: corners of the element e.

/// The edge goes: its ring is filled anew. Flips a surface edge.
bool remove_edge(Region& r, const Acceptance& accept, int32_t e, int i, int j);
/// The face i goes: two elements become three.
bool swap_face(Region& r, const Acceptance& accept, int32_t e, int i);
/// Vertex i goes to vertex j.
bool contract_edge(Region& r, const Acceptance& accept, int32_t e, int i, int j);
/// Vertices i and j meet where their elements are best.
bool merge_edge(Region& r, const Acceptance& accept, int32_t e, int i, int j);
/// A new vertex comes to lie on the edge, where its elements are best.
bool split_edge(Region& r, const Acceptance& accept, int32_t e, int i, int j);
/// Moves v until its elements reach the goal, or, to fit the surface, to where its triangles fit best.
bool smooth_vertex(Region& r, const Acceptance& accept, int32_t v);

/// Whether the edge is under a tenth of a spacing.
bool is_tiny(const Region& r, int32_t e, int i, int j);

/// Moves surface vertices onto the target, in order, all the way or part of it; no element falls under `floor`.
/// floor ≥ 1 means: an element may lose at most half its quality. The part has not been changed before. Crossings
/// are tested once, after all moves. Where triangles cross, their vertices are put back and moved once more, with a
/// test after each.
void project_to_surface(Region& r, const Acceptance& accept, const std::vector<int32_t>& vertices, float floor);
/// Moves a vertex of the surface or a trace towards the nearest place on the target that it finds, as far as no
/// element falls under `floor`.
bool step_to_surface(Region& r, const Acceptance& accept, int32_t v, float floor);
/// The closed surface of few triangles that v is on shrinks to what the target has there, in shells that get
/// smaller by about `ratio`.
bool shrink_cavity(Region& r, int32_t v, double ratio);
/// Near a surface vertex off the target (Target::neck).
bool find_neck(const Region& r, int32_t v, Neck& neck);
/// The surface near v follows the target down into a neck, in such shells.
bool follow_neck(Region& r, int32_t v, const Neck& neck, double ratio);

} // namespace molmesh::optimize
