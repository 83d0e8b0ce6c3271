// vdb.hpp — reader and writer of the sparse density grid in OpenVDB's format (VDBv1.md).
#pragma once
#include "formats/vdb/extras.hpp"
#include "grid/block_grid.hpp"
#include <iosfwd>
#include <memory>
#include <string>

namespace molmesh::formats {

class Leaves;

/// Throws Error(bad_input) when the stream is no OpenVDB file, or has no grid `density` of molmesh_profile 1, or
/// holds a tile of one.
/// extras: gets what else the file says.
BlockGrid read_vdb(std::istream& in, const std::string& file, int threads = 1, VdbExtras* extras = nullptr);
/// The same of a tile of a grid, or of a whole one, which is tile 1 of 1.
BlockGrid read_tile(std::istream& in, const std::string& file, int threads, VdbExtras& extras);
/// A file whose tree is known and whose values are still packed: its size, before the grid takes its memory. Throws
/// as read_vdb().
class PackedVdb {
public:
  PackedVdb(std::istream& in, const std::string& file);
  ~PackedVdb();
  double spacing() const; ///< Å
  int64_t blocks() const;
  int64_t active_points() const;
  FieldInfo info() const;
  BlockGrid unpack(int threads, VdbExtras* extras = nullptr) const;

private:
  struct Content;
  std::unique_ptr<const Content> content_;
};
/// Contents depend on the grid alone; OpenVDB adds a fresh UUID to the bytes.
void write_vdb(std::ostream& out, const BlockGrid& grid, int threads = 1, const VdbExtras& extras = {});
/// The same from leaves that are ready; inside: corners of blocks that lie wholly inside.
void write_vdb(std::ostream& out, const GridFrame& frame, const FieldInfo& info, const std::vector<Vec3i>& inside,
               const Leaves& leaves, const VdbExtras& extras = {});

} // namespace molmesh::formats
