// vdb.hpp — reader and writer of the sparse density grid in OpenVDB's format (VDBv1.md).
#pragma once
#include "grid/block_grid.hpp"
#include <iosfwd>
#include <string>

namespace molmesh::formats {

class Leaves;

/// What the isosurface is, where it is not that of a sum of Gaussians.
struct SurfaceKind {
  std::string surface = "gaussian"; ///< ses, sas, vdw
  double probe = 0;                 ///< Å, of ses and sas
};

/// Throws Error(bad_input) when the stream is no OpenVDB file, or has no grid `density` of molmesh_profile 1.
BlockGrid read_vdb(std::istream& in, const std::string& file, int threads = 1);
/// Contents depend on the grid alone; OpenVDB adds a fresh UUID to the bytes.
void write_vdb(std::ostream& out, const BlockGrid& grid, int threads = 1);
/// The same from leaves that are ready; inside: corners of blocks that lie wholly inside.
void write_vdb(std::ostream& out, const GridFrame& frame, const FieldInfo& info, const std::vector<Vec3i>& inside,
               const Leaves& leaves, const SurfaceKind& kind = {});

} // namespace molmesh::formats
