// unseen_residues.hpp — which residues of a named boundary no triangle of the surface belongs to.
#pragma once
#include "label/mesh_labels.hpp"

namespace molmesh::label {

struct UnseenResidues {
  int64_t residues = 0;            ///< of which atoms are selected
  std::vector<std::string> unseen; ///< those without a triangle, as selections: "//A/102(ASP)"; in the file's order
};

/// A triangle belongs to the residue if the atom that owns it (labels.index.back(), before add_labels) is a
/// selected one of that residue. Empty for a hierarchy without the level "residue".
UnseenResidues unseen_residues(const Hierarchy& h, const Places& places, const Labels& labels,
                               const NamedBoundary& boundary);

} // namespace molmesh::label
