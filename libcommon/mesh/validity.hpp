// validity.hpp — checks I6: a conforming mesh whose regions are bounded by closed 2-manifolds.
// That no two triangles cross is looked for on request (add_crossings).
#pragma once
#include "mesh/region_summary.hpp"
#include <optional>

namespace molmesh {

/// Rules, in the order in which they are reported. Names are part of tetstat's JSON (TETSTATv1).
///   index                a corner names no point
///   volume               a tetrahedron without positive volume (exact)
///   duplicate_point      two points with the same coordinates (exact)
///   unused_point         a point of no tetrahedron
///   duplicate_tet        two tetrahedra with the same four points
///   crowded_face         a face in more than two tetrahedra
///   folded_face          two tetrahedra on the same side of their common face
///   missing_triangle     a face between regions, or with one tetrahedron, without a triangle
///   stray_triangle       a triangle on no such face
///   duplicate_triangle   two triangles on one face
///   triangle_orientation a triangle that points the wrong way (adjacency.hpp)
///   open_edge            an edge in one triangle of a region's boundary
///   crowded_edge         an edge in more than two, or in two that run along it the same way
///   pinched_point        a point with several fans of triangles of a region's boundary
///   box_label            a box triangle between two tetrahedra, or a surface triangle in the plane of a box side
///   box_plane            box triangles of one side not in one plane, to the last bit, or points beyond it
///   box_volume           volumes that do not add up to the box
///   sphere_label         of a mesh with an outer sphere: a triangle of it between two tetrahedra, or of a box
///   sphere_point         a triangle of the outer sphere with a point that is not on it, to rounding
///   overlap              a piece of the faces with one tetrahedron that has tetrahedra on its outer side too, or
///                        several over each other on its inner side: a hanging node, a body within another
/// The box rules apply where regions are 1 to 3 or domains and labels 1 to 7 or interfaces of these; box_volume,
/// where all six sides have triangles and every face with one tetrahedron is on one of them. overlap
/// (validity_covering.hpp) is looked for where no other rule is broken.
struct Fault {
  std::string rule;
  int64_t count = 0;
  std::string example; ///< "tet 412 (points 3 17 9 20)"
};

struct Validity {
  std::vector<Fault> faults;                  ///< none: valid
  std::vector<RegionSummary> region;          ///< ascending
  SurfaceSummary surface;                     ///< triangles with label 1
  std::optional<SurfaceSummary> outer_sphere; ///< its triangles, where the mesh has one
  double volume = 0;                          ///< Å³
  Vec3d low, high;                            ///< bounding box, Å
  bool valid() const { return faults.empty(); }
};

/// Same result at any number of threads. Coordinates are finite.
Validity check_validity(const TetMesh& m, int threads);

/// Adds the fault crossing_triangles: pairs of triangles, box sides apart, that meet elsewhere than in common
/// corners and edges. I6 implies that there are none where tetrahedra fill the box; meshes of one side can break
/// it.
void add_crossings(Validity& v, const TetMesh& m, int threads);

} // namespace molmesh
