// charges_file.hpp — the charges of a .hier beside the mesh that was made from it.
#pragma once
#include "formats/charges/charges.hpp"
#include "tools/structure_labels.hpp"

namespace molmesh {

/// Returns how many. file: the hierarchy's. Throws Error(bad_input) where it is of another structure.
inline int64_t write_charges_file(std::ostream& out, const std::string& file, const TetMesh& m) {
  cli::InputFile input(file);
  const Hierarchy h = formats::read_hier(input.stream(), input.name());
  require_same_structure(h, input.name(), m);
  return formats::write_charges(out, h, m);
}

} // namespace molmesh
