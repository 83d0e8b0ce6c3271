// surface_fit.hpp — how well surface triangles fit the target, and where vertices bound to it may go.
#pragma once
#include "optimize/acceptance/acceptance.hpp"
#include "optimize/operations/region.hpp"
#include <optional>

namespace molmesh::optimize {

/// Target::off_by of a place of such a vertex, the larger of two targets; none where one is not known.
std::optional<double> off_at(const DynamicMesh& m, const Target* target, const Vertex& vertex, Vec3d x);
inline std::optional<double> off_at(const Region& r, const Vertex& vertex, Vec3d x) {
  return off_at(r.mesh, r.target, vertex, x);
}
/// Of a vertex of the surface, a trace or a line; two spacings where the target is not known. Else 0.
double off(const DynamicMesh& m, const Target* target, int32_t v);
inline double off(const Region& r, int32_t v) {
  return off(r.mesh, r.target, v);
}
/// Whether it is kept on the mesh's target alone.
inline bool has_main_target(const DynamicMesh& m, int32_t v) {
  return m.vertex[v].kind != Kind::line && !m.labels[m.vertex[v].label].target;
}
/// Whether the face is a surface triangle, counted from this side, that does not keep the guard, or is turned by
/// more than Guard::widest_unbent.
bool is_bent(const Region& r, const Acceptance& accept, int32_t element, size_t face);
/// misfit() of a triangle of that label that runs as the target's normal does. The target is not null.
double misfit_of(const Region& r, const Acceptance& accept, uint8_t label, Vec3d a, Vec3d b, Vec3d c);
/// Of a labelled face; 0 for flat labels and without a target.
double misfit_of(const Region& r, const Acceptance& accept, const Element& e, size_t face);

/// Adds a labelled face of e to the moving triangles, seen from the side that counts it, with vertex `from` moving.
void add_triangle(Region& r, const Element& e, size_t face, int32_t from);
/// Of the moving triangles, with the vertex at x, or where it is.
Fit fit_of_triangles(const Region& r, const Acceptance& accept, const Vec3d* x = nullptr);
/// The moving triangles become those of v's star; how they fit now.
Fit gather_triangles(Region& r, const Acceptance& accept, const std::vector<int32_t>& star, int32_t v);

/// Moves x, of a vertex of that kind, onto the target. False where that takes more than `reach` (Å).
bool project(const Region& r, const Vertex& vertex, Vec3d& x, double reach);

/// Puts trial places of a vertex on the target, within the walls.
struct OnTarget {
  const Region& r;
  const Vertex& vertex;
  Vec3d from;   ///< where the vertex is
  double reach; ///< of a projection (Å)
  bool operator()(Vec3d& x) const;
  /// Of n trials those that come there, in front and in order; how many.
  int all(Vec3d* x, int n) const;
};

/// Moves trial places of a vertex onto what it is bound to: the target, its walls, or near enough to the target.
struct Bound {
  const Acceptance& accept;
  OnTarget target;
  bool operator()(Vec3d& x) const;
  int all(Vec3d* x, int n) const;

private:
  bool stays_near(Vec3d x) const;
};

} // namespace molmesh::optimize
