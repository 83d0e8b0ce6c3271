// drawing.hpp — flat drawing on a picture, smooth at its edges: rectangles and text.
#pragma once
#include "picture/image.hpp"
#include <string>
#include <string_view>

namespace molmesh::picture {

/// Pixels; opacity 0 to 1.
void fill_rectangle(Image& image, double x, double y, double width, double height, Rgb colour, double opacity = 1);

/// UTF-8; size: of an em, in pixels. Characters without a glyph (glyphs.hpp) are drawn as '?'.
double text_width(std::string_view text, double size);
/// (x, y): where its base line begins.
void draw_text(Image& image, double x, double y, std::string_view text, double size, Rgb colour);
/// Cut with … at its end where it is wider.
std::string shortened(const std::string& text, double size, double width);

} // namespace molmesh::picture
