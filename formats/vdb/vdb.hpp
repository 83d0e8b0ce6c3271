// vdb.hpp — reader and writer of the sparse density grid in OpenVDB's format (VDBv1.md).
#pragma once
#include "density/band.hpp"
#include "density/block_grid.hpp"
#include <iosfwd>
#include <string>

namespace molmesh::formats {

/// Throws Error(bad_input) when the stream is no OpenVDB file, or has no grid `density` of molmesh_profile 1.
BlockGrid read_vdb(std::istream& in, const std::string& file, int threads = 1);
/// Contents depend on the grid alone; OpenVDB adds a fresh UUID to the bytes.
void write_vdb(std::ostream& out, const BlockGrid& grid, int threads = 1);
void write_vdb(std::ostream& out, const density::Band& band, int threads = 1);

} // namespace molmesh::formats
