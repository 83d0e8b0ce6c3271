// operators.hpp — the motions of a biological assembly, for structures that are placed elsewhere.
#pragma once
#include "geom/rigid.hpp"
#include <iosfwd>
#include <string>
#include <vector>

namespace molmesh::formats {

/// Each operator of the assembly once, in the order of the file (PDB, mmCIF …; plain or gzip), whichever chains it
/// is for. Throws Error(bad_input) "FILE: …" where the file has no such assembly.
std::vector<Rigid> read_operators(std::istream& in, const std::string& file, const std::string& assembly);

} // namespace molmesh::formats
