// cell_labels.hpp — the labels of a mesh's cells with their names: boundary, part, chain, residue, …
#pragma once
#include "mesh/mesh_bodies.hpp"
#include "mesh/triangle_sides.hpp"
#include <string>
#include <vector>

namespace molmesh::formats {

/// Labels of cells to go with the mesh; -1: none.
struct CellLabel {
  std::string name;               ///< "chain"
  std::vector<std::string> names; ///< of the values 0, 1, …
  std::vector<int32_t> tet, tri;  ///< either may be empty: left out
};

/// Boundary (as tetconvert names it), part, and the integer arrays of the mesh but for `atom` and `patch`, in this
/// order. Values are numbered by rank; those of a level that has names are those of the names;
/// residues are called by their chains, too: "//D/1(GLY)".
std::vector<CellLabel> cell_labels(const TetMesh& m);
/// The one of that name, or null.
const CellLabel* find_label(const std::vector<CellLabel>& labels, const std::string& name);

/// What places are called by: residues, or chains where there are none.
class PlaceNames {
public:
  explicit PlaceNames(const std::vector<CellLabel>& labels); ///< keeps a reference to them
  bool known() const { return inner_ != nullptr; }
  /// Label of a triangle, -1: none; and its name, empty for -1.
  int32_t triangle(int64_t tri) const { return inner_ && !inner_->tri.empty() ? inner_->tri[tri] : -1; }
  std::string name(int32_t label) const;
  /// Name of a tetrahedron's, or where it has none of that of the nearest triangle that has one.
  std::string of_tet(const TetMesh& m, int64_t tet) const;

private:
  const CellLabel* inner_ = nullptr;
};

/// Of each body the places whose triangles it has, those with the most triangles first, then in the order of their
/// labels.
std::vector<std::vector<std::string>> names_round_bodies(const TetMesh& m, const TriangleSides& sides,
                                                         const MeshBodies& bodies, const PlaceNames& places);
/// So many of them are shown to people: "//A/45(TYR), //A/46(GLY)"; and these.
constexpr size_t shown_names = 8;
std::string first_of(const std::vector<std::string>& names);

} // namespace molmesh::formats
