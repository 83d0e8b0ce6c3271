// png.hpp — writes pictures as PNG (PNG.md).
#pragma once
#include "picture/image.hpp"
#include <string>

namespace molmesh::formats {

/// 8 bits of red, green and blue. Same picture, same bytes.
std::string png(const picture::Image& image);

} // namespace molmesh::formats
