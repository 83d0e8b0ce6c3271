// decode.hpp — the bytes of an OpenVDB file, checked and taken apart, for float trees of the standard shape.
// OpenVDB's own reader trusts every length it meets and reads leaves one after the other; this one does neither.
#pragma once
#include "geom/vec.hpp"
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace molmesh::formats::vdb {

/// Å, R9: points of a grid are told apart in double precision, and nothing that is computed from places overflows.
inline constexpr double least_spacing = 1e-6, largest_spacing = 1e6, largest_place = 1e8;

/// A constant cube of `edge` points (8, 128 or 4096); only those that are active or differ from the background.
struct Tile {
  Vec3i corner;
  int32_t edge;
  float value;
  bool active;
};

/// One 8³ leaf; `data` starts at its value mask and ends with its values, still compressed.
struct Leaf {
  Vec3i corner;
  std::string_view data;
};

struct Metadata {
  std::string type; ///< OpenVDB's name: "double", "int64", "vec3i" …
  std::string_view bytes;
};

struct FloatGrid {
  std::map<std::string, Metadata, std::less<>> metadata;
  double spacing = 0; ///< Å; uniform voxels only
  Vec3d origin;       ///< Å, position of index (0,0,0)
  uint32_t compression = 0;
  float background = 0;
  std::vector<Tile> tile;
  std::vector<Leaf> leaf; ///< in OpenVDB's order
  size_t bytes = 0;       ///< of the file
};

/// The float grid named `name`, whose parts point into `bytes`. Throws Error(bad_input) with rules R1 to R4, R9 and
/// R10.
FloatGrid decode(std::string_view bytes, std::string_view name, const std::string& file);

/// value[512] and active[8 words] of a leaf. Throws Error(bad_input), R3.
void decode_leaf(const FloatGrid& grid, const Leaf& leaf, const std::string& file, float* value, uint64_t* active);

} // namespace molmesh::formats::vdb
