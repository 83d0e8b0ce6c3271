// cell_labels.hpp — the labels of a mesh's cells with their names: boundary, part, chain, residue, …
#pragma once
#include "formats/html/mesh_code.hpp"
#include "picture/mesh_picture.hpp"

namespace molmesh::formats {

/// Boundary (as tetconvert names it), part, and the integer arrays of the mesh but for `atom` and `patch`, in this
/// order. Values are numbered by rank; those of a level that has names are those of the names;
/// residues are called by their chains, too.
std::vector<CellLabel> cell_labels(const TetMesh& m);
/// The one of that name, or null.
const CellLabel* find_label(const std::vector<CellLabel>& labels, const std::string& name);

/// What a surface is coloured by where nobody says: chain where there are several, else boundary where some are
/// named, else region where there are several, else "plain".
std::string usual_colour(const TetMesh& m, const std::vector<CellLabel>& labels);

/// Colours of the triangles for a picture. name: plain, region, body, or one of the labels; throws Error(usage)
/// that lists what there is.
picture::Colouring colouring_by(const std::string& name, const TetMesh& m, const TriangleSides& sides,
                                const MeshBodies& bodies, const std::vector<CellLabel>& labels);

/// What a page calls places by: residues, or chains where there are none.
class PlaceNames {
public:
  explicit PlaceNames(const std::vector<CellLabel>& labels);
  /// Label of a triangle, -1: none; and its name, empty for -1.
  int32_t triangle(int64_t tri) const { return inner_ && !inner_->tri.empty() ? inner_->tri[tri] : -1; }
  std::string name(int32_t label) const;
  /// Name of a tetrahedron's, or where it has none of that of the nearest triangle that has one.
  std::string of_tet(const TetMesh& m, int64_t tet) const;

private:
  const CellLabel* inner_ = nullptr;
};

} // namespace molmesh::formats
