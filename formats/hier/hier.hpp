// hier.hpp — reader and writer of .hier, version 1 (HIERv1.md).
#pragma once
#include "molecule/hierarchy.hpp"
#include <iosfwd>

namespace molmesh::formats {

/// Throws Error(bad_input) "FILE:LINE: found, expected"; `file` names the stream in messages.
Hierarchy read_hier(std::istream& in, const std::string& file);
/// Numbers read back exactly. Same hierarchy, same bytes.
void write_hier(std::ostream& out, const Hierarchy& h);

} // namespace molmesh::formats
