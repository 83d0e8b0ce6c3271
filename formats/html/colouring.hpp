// colouring.hpp — what a mesh may be coloured by: regions, bodies and the labels of its cells.
#pragma once
#include "formats/vtu/cell_labels.hpp"
#include "picture/mesh_picture.hpp"
#include <map>

namespace molmesh::formats {

/// Labels and names of the boundaries of the mesh that its user named (patch_names).
std::map<int32_t, std::string> user_boundaries(const TetMesh& m);

/// What a surface is coloured by where nobody says: boundary where the user named some, else chain where there are
/// several, else region where the mesh has domains, else boundary where some are named, else region where there are
/// several, else "plain".
std::string usual_colour(const TetMesh& m, const std::vector<CellLabel>& labels);

/// Colours of the triangles for a picture. name: plain, region, body, or one of the labels; throws Error(usage)
/// that lists what there is.
picture::Colouring colouring_by(const std::string& name, const TetMesh& m, const TriangleSides& sides,
                                const MeshBodies& bodies, const std::vector<CellLabel>& labels);

} // namespace molmesh::formats
