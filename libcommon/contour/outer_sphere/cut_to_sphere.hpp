// cut_to_sphere.hpp — the part of a mesh within a sphere, with triangles on the sphere.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh::contour {

/// `mesh` fills a box that holds the sphere. What is beyond the sphere goes: points near it move onto it, and the
/// elements that still cross it are cut (Labelle and Shewchuk, Isosurface stuffing, ACM Trans. Graph. 2007; here on
/// the elements of the octree). The triangles on the sphere get the label outer_sphere; their points lie on it, up
/// to Sphere::rounding(). Elements of the molecule and its surface are not touched.
/// Throws Error(failed): with the least radius that works where the surface is less than two of its elements' edges
/// from the sphere, and where rounding leaves a part of an element without volume.
void cut_to_sphere(TetMesh& mesh, const Sphere& sphere, int threads);

} // namespace molmesh::contour
