// structure.hpp — a structure file to its density in one step.
#pragma once
#include "density/density.hpp"
#include "formats/hier/hier.hpp"
#include "formats/pdb/pdb.hpp"
#include "grid/band.hpp"
#include <fstream>
#include <sstream>

namespace molmesh::reference {

/// Defaults of pdb2hier and hier2density.
inline BlockGrid density_of(const std::string& path, double spacing) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  formats::PdbHierarchy(in, path, {}).write(text);
  density::Counts counts;
  density::Options options;
  options.spacing = spacing;
  options.threads = 2;
  return to_block_grid(density::compute(formats::read_hier(text, path), options, counts), options.threads);
}

} // namespace molmesh::reference
