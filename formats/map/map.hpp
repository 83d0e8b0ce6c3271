// map.hpp — dense views of a sparse density grid for programs that read no OpenVDB (MAP.md). Written only.
#pragma once
#include "grid/block_grid.hpp"
#include <iosfwd>

namespace molmesh::formats {

/// CCP4/MRC 2014, mode 2, x fastest. Throws Error(bad_input) past 2^31 - 1 points on an axis or 8·10^9 in all.
void write_ccp4(std::ostream& out, const BlockGrid& grid, const std::string& file);
/// OpenDX text, z fastest, as APBS writes it. The same limits.
void write_dx(std::ostream& out, const BlockGrid& grid, const std::string& file);

} // namespace molmesh::formats
