// glyphs.hpp — outlines of the characters that pictures can show: ASCII and a few signs of units.
#pragma once
#include <cstdint>
#include <string_view>

namespace molmesh::picture {

/// An em is 72 units. outline: polygons, a blank between two; each corner is two characters, 46 + x and 57 + y,
/// with y up from the base line. What lies within an odd number of them, or overlaps, is ink (non-zero winding).
struct Glyph {
  uint32_t code; ///< Unicode
  double advance;
  std::string_view outline;
};
inline constexpr double units_per_em = 72;
inline constexpr int glyph_x0 = 46, glyph_y0 = 57;

/// That of '?' where there is none.
const Glyph& glyph_of(uint32_t code);

} // namespace molmesh::picture
