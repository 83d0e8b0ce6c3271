// foreign.hpp — fills in what meshes of other programs leave out.
#pragma once
#include "formats/vtu/vtu.hpp"

namespace molmesh::formats {

/// Triangles anew, with the values of those of the file that are among them. Of others nothing is known, but for
/// what `patch` is by itself.
void take_rebuilt_triangles(TetMesh& m, VtuNotes& notes);

} // namespace molmesh::formats
