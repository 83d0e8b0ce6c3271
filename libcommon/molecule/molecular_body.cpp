// molecular_body.cpp — settings of the Gaussian body by the hydrogens that a structure has.
#include "molecule/molecular_body.hpp"
#include "molecule/limits.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh {

Hydrogens hydrogens_of(int64_t hydrogens, int64_t carbons, int64_t heavy) {
  if (carbons > 0 && 10 * hydrogens >= 7 * carbons)
    return Hydrogens::all;
  return 50 * hydrogens >= heavy && hydrogens > 0 ? Hydrogens::polar : Hydrogens::none;
}

std::string name_of(Hydrogens kind) {
  return kind == Hydrogens::all ? "all hydrogens" : kind == Hydrogens::polar ? "polar hydrogens" : "no hydrogens";
}

ResidueSettings molecular_body(Hydrogens kind) {
  switch (kind) {
  case Hydrogens::all:
    return {0.4, 0.63};
  case Hydrogens::polar:
    return {0.31, 0.55};
  case Hydrogens::none:
    break;
  }
  return {0.3, 0.58};
}

double residue_weight(double w_r, int64_t n) {
  if (n < 1)
    return 1;
  return std::max(least_weight, std::round(1e4 * std::pow(w_r, 1 - 1 / static_cast<double>(n))) / 1e4);
}

} // namespace molmesh
