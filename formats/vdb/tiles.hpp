// tiles.hpp — puts the tiles of a density together: the file that one run over the whole grid would have written.
#pragma once
#include "formats/vdb/leaves.hpp"
#include "formats/vdb/vdb.hpp"
#include <iosfwd>
#include <string>
#include <vector>

namespace molmesh::formats {

class TileJoin {
public:
  explicit TileJoin(int threads) : leaves_(threads) {}
  /// In any order; a whole density is tile 1 of 1. Of each tile its compressed values stay. Throws Error(bad_input)
  /// where the tile is there already, or of another grid, structure or search.
  void add(std::istream& in, const std::string& file);
  /// Throws Error(bad_input) where a tile is missing, or all are empty.
  void check_complete() const;
  /// Of a complete set: all but the header's UUID is as one run writes it.
  void write(std::ostream& out) const;

  const GridFrame& frame() const { return frame_; }
  const FieldInfo& info() const { return info_; }
  size_t tiles() const { return file_.size(); }
  size_t blocks() const { return leaves_.size(); }
  size_t inside_blocks() const { return inside_.size(); }

private:
  void check_same(const BlockGrid& grid, const VdbExtras& extras, const std::string& file) const;

  GridFrame frame_; ///< and what follows: of the first tile; info_ counts the points of all
  FieldInfo info_;
  VdbExtras extras_;
  std::vector<std::pair<int32_t, std::string>> file_; ///< tile's number, ascending, and its file
  Leaves leaves_;
  std::vector<Vec3i> inside_;
};

} // namespace molmesh::formats
