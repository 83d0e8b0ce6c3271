// charges_file.hpp — the charges of a .hier beside the mesh that was made from it.
#pragma once
#include "formats/charges/charges.hpp"
#include "tools/structure_labels.hpp"

namespace molmesh {

/// Returns how many. file: the hierarchy's. Throws Error(bad_input) where it is of another structure, or has no
/// charges: a solver would find an energy of 0.
inline int64_t write_charges_file(std::ostream& out, const std::string& file, const TetMesh& m) {
  cli::InputFile input(file);
  const Hierarchy h = formats::read_hier(input.stream(), input.name());
  require_same_structure(h, input.name(), m);
  const int64_t n = formats::write_charges(out, h, m);
  if (n == 0)
    fail_input(input.name() + ": found no charges, expected some: a PQR file has them (pdb2pqr makes one)");
  return n;
}

} // namespace molmesh
