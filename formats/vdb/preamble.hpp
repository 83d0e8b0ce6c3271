// preamble.hpp — what an OpenVDB file says before its tree: version, grid, metadata, transform.
#pragma once
#include "formats/vdb/bytes.hpp"
#include "formats/vdb/vdb.hpp"

namespace molmesh::formats {

void write_preamble(Bytes& out, const GridFrame& f, const FieldInfo& info, const SurfaceKind& kind);

} // namespace molmesh::formats
