// straddling.hpp — surface points moved so that flat triangles lie on both sides of the curved surface.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// The triangles of a mesh whose points lie on a surface are chords: where it is convex all of the volume between
/// is missing, and a charge is as much nearer to the boundary. Moves each point of the label Boundary::surface
/// along its normal by the mean height of the surface above its triangles, which the normals at the triangles'
/// corners tell, and by at most a tenth of its shortest edge. Points of other boundaries too, and of elements that
/// would lose more than half of their volume, stay. Returns how many moved.
int64_t straddle_surface(TetMesh& m);

} // namespace molmesh
