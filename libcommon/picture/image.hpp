// image.hpp — a picture as bytes: rows from the top, red, green and blue of each pixel.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace molmesh::picture {

struct Rgb {
  uint8_t r = 0, g = 0, b = 0;
};

/// share 0: a, 1: b.
inline Rgb mixed(Rgb a, Rgb b, double share) {
  const auto mix = [&](uint8_t x, uint8_t y) { return static_cast<uint8_t>(x + (y - x) * share + 0.5); };
  return {mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b)};
}

struct Image {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb; ///< [3 width height]

  Image() = default;
  Image(int w, int h, Rgb fill) : width(w), height(h), rgb(3 * static_cast<size_t>(w) * static_cast<size_t>(h)) {
    for (size_t i = 0; i < rgb.size(); i += 3)
      rgb[i] = fill.r, rgb[i + 1] = fill.g, rgb[i + 2] = fill.b;
  }
  /// In the picture.
  uint8_t* at(int x, int y) {
    return rgb.data() + 3 * (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
  }
  const uint8_t* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
  /// Nothing outside the picture.
  void blend(int x, int y, Rgb c, double share) {
    if (x < 0 || y < 0 || x >= width || y >= height || share <= 0)
      return;
    uint8_t* const p = at(x, y);
    const Rgb m = mixed({p[0], p[1], p[2]}, c, share > 1 ? 1 : share);
    p[0] = m.r, p[1] = m.g, p[2] = m.b;
  }
};

} // namespace molmesh::picture
