// structure_fuzz.hpp — a structure file, whatever its bytes, is refused with one line or makes a .hier that reads
// back.
#pragma once
#include "base/error.hpp"
#include "formats/hier/hier.hpp"
#include "formats/pdb/pdb.hpp"
#include <cstdlib>
#include <sstream>
#include <string>

namespace molmesh::fuzz {

inline void structure(const std::string& bytes, const formats::PdbOptions& options) {
  std::istringstream in(bytes);
  try {
    const formats::PdbHierarchy pdb(in, "fuzz", options);
    if (pdb.report().atoms > 20'000)
      return; // copies of an assembly
    std::ostringstream out;
    pdb.write(out);
    std::istringstream back(out.str());
    const Hierarchy h = formats::read_hier(back, "back");
    if (static_cast<int64_t>(h.atom.size()) != pdb.report().atoms)
      std::abort();
  } catch (const Error& e) {
    if (std::string(e.what()).find('\n') != std::string::npos)
      std::abort();
  }
}

/// The defaults, and everything kept with all models and assembly 1.
inline void structure(const uint8_t* data, size_t size, const char* format) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  formats::PdbOptions options;
  options.format = format;
  structure(bytes, options);
  options.model = "all";
  options.altloc = "all";
  options.waters = true;
  structure(bytes, options);
  options.assembly = "1";
  structure(bytes, options);
}

} // namespace molmesh::fuzz
