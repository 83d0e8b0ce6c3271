// preamble.hpp — what an OpenVDB file says before its tree: version, grid, metadata, transform.
#pragma once
#include "density/block_grid.hpp"
#include "formats/vdb/bytes.hpp"

namespace molmesh::formats {

void write_preamble(Bytes& out, const GridFrame& f, const FieldInfo& info);

} // namespace molmesh::formats
