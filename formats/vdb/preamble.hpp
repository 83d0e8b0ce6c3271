// preamble.hpp — what an OpenVDB file says before its tree: version, grid, metadata, transform.
#pragma once
#include "formats/vdb/bytes.hpp"
#include "formats/vdb/extras.hpp"
#include "grid/block_grid.hpp"

namespace molmesh::formats {

void write_preamble(Bytes& out, const GridFrame& f, const FieldInfo& info, const VdbExtras& extras);

} // namespace molmesh::formats
