// other_selection.hpp — tells whether a mesh was made of other atoms of the structure's file.
#pragma once
#include "label/mesh_labels.hpp"
#include "molecule/hierarchy.hpp"
#include <string>

namespace molmesh::label {

/// "5,400 atoms where the mesh has 5,469". Empty: the numbers are the same, the mesh does not know its own, or the
/// files differ.
std::string other_number(const Hierarchy& h, const TetMesh& mesh);

/// What shows that the mesh was made of another selection of the same file, as many atoms as it may have: over a
/// twentieth of the surface is far from the atoms, or over a twentieth of the atoms lies beyond the mesh. Empty:
/// nothing does, or the files differ. places and labels: of the mesh by these atoms.
std::string other_selection(const Hierarchy& h, const TetMesh& mesh, const Places& places, const Labels& labels);

} // namespace molmesh::label
