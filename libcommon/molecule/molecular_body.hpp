// molecular_body.hpp — which exponent and weight make the Gaussian body of a structure that of its molecular
// surface.
#pragma once
#include <cstdint>
#include <string>

namespace molmesh {

/// Which hydrogens a structure has: a body without them needs sharper residues.
enum class Hydrogens { none, polar, all };

/// hydrogens, carbons, heavy: numbers of atoms with a body, without waters; heavy includes carbons. Proteins and
/// nucleic acids have 1.2 to 1.6 hydrogens for each carbon with all of them, and 0.2 to 0.4 with polar ones.
Hydrogens hydrogens_of(int64_t hydrogens, int64_t carbons, int64_t heavy);
std::string name_of(Hydrogens kind);

/// No unit, of residues: their exponent P_R, and W_R, from which residue_weight() makes the weight of each
/// (docs/experiments.md, "The molecular surface").
struct ResidueSettings {
  double exponent, weight;
};
ResidueSettings molecular_body(Hydrogens kind);

/// The weight W = W_R^(1 - 1/n) of a residue of n atoms with a body, to four decimals but at least 0.001, so that
/// an atom alone keeps its sphere; 1 for n = 0.
double residue_weight(double w_r, int64_t n);

} // namespace molmesh
