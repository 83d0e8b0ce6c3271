// atom_line.hpp — ATOM and HETATM lines of the PDB format whose fields are not in their columns.
#pragma once
#include <string>
#include <string_view>

namespace molmesh::formats {

inline constexpr size_t first_x = 30, coordinate_width = 8; // columns 31-38, 39-46, 47-54

/// Is the field a coordinate: a finite number, with or without a plus sign?
bool is_coordinate(std::string_view field);

/// A line with its fields where the format has them.
struct AtomLine {
  std::string_view text;
  bool pushed = false;  ///< a serial wider than its columns 7-11 had moved the rest to the right
  bool shifted = false; ///< its coordinates began one column late, as residue numbers of five digits move them
};
/// room: holds the text of a line that was moved. coordinates: false where the labels alone are wanted, which is
/// faster.
AtomLine in_columns(std::string_view line, std::string& room, bool coordinates = true);

} // namespace molmesh::formats
