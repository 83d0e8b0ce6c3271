// drawing.cpp — polygons by counting the samples of each pixel that they cover.
#include "picture/drawing.hpp"
#include "picture/glyphs.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::picture {
namespace {

struct Edge {
  double x0, y0, x1, y1;
};

/// Pixels' shares within the polygons, by non-zero winding: 4 rows of samples a pixel, exact along a row.
void fill_polygons(Image& image, const std::vector<Edge>& edge, Rgb colour) {
  constexpr int rows = 4;
  double low = 1e30, high = -1e30, left = 1e30, right = -1e30;
  for (const Edge& e : edge) {
    low = std::min({low, e.y0, e.y1}), high = std::max({high, e.y0, e.y1});
    left = std::min({left, e.x0, e.x1}), right = std::max({right, e.x0, e.x1});
  }
  const int first = std::max(0, static_cast<int>(std::floor(low))), x0 = static_cast<int>(std::floor(left)),
            last = std::min(image.height - 1, static_cast<int>(std::floor(high))),
            width = static_cast<int>(std::floor(right)) - x0 + 2;
  std::vector<double> cover(static_cast<size_t>(std::max(0, width)));
  std::vector<std::pair<double, int>> crossing;
  for (int y = first; y <= last; ++y) {
    std::fill(cover.begin(), cover.end(), 0.);
    for (int s = 0; s < rows; ++s) {
      const double at = y + (s + 0.5) / rows;
      crossing.clear();
      for (const Edge& e : edge)
        if ((e.y0 <= at) != (e.y1 <= at))
          crossing.push_back({e.x0 + (at - e.y0) / (e.y1 - e.y0) * (e.x1 - e.x0), e.y0 < e.y1 ? 1 : -1});
      std::sort(crossing.begin(), crossing.end());
      int winding = 0;
      for (size_t i = 0; i + 1 < crossing.size(); ++i) {
        winding += crossing[i].second;
        if (winding == 0)
          continue;
        const double a = crossing[i].first - x0, b = crossing[i + 1].first - x0;
        for (int x = static_cast<int>(a); x <= static_cast<int>(b) && x < width; ++x)
          cover[static_cast<size_t>(x)] += std::max(0., std::min(b, x + 1.) - std::max(a, double(x))) / rows;
      }
    }
    for (int x = 0; x < width; ++x)
      image.blend(x0 + x, y, colour, cover[static_cast<size_t>(x)]);
  }
}

/// f(code) for each character; bytes that are no UTF-8 are U+FFFD.
template <class F>
void each_character(std::string_view text, F&& f) {
  for (size_t i = 0; i < text.size();) {
    const auto byte = [&](size_t k) { return static_cast<unsigned char>(text[k]); };
    const unsigned char b = byte(i++);
    const size_t more = b < 0x80 ? 0 : b >> 5 == 6 ? 1 : b >> 4 == 14 ? 2 : b >> 3 == 30 ? 3 : 4;
    uint32_t code = more == 0 ? b : more < 4 ? b & (0x3Fu >> more) : 0xFFFD;
    for (size_t k = 0; more < 4 && k < more; ++k) {
      if (i >= text.size() || byte(i) >> 6 != 2) {
        code = 0xFFFD;
        break;
      }
      code = code << 6 | (byte(i++) & 0x3Fu);
    }
    f(code);
  }
}

} // namespace

void fill_rectangle(Image& image, double x, double y, double width, double height, Rgb colour, double opacity) {
  const auto share = [](double low, double high, int pixel) {
    return std::max(0., std::min(high, pixel + 1.) - std::max(low, double(pixel)));
  };
  for (int j = static_cast<int>(std::floor(y)); j < y + height; ++j)
    for (int i = static_cast<int>(std::floor(x)); i < x + width; ++i)
      image.blend(i, j, colour, opacity * share(x, x + width, i) * share(y, y + height, j));
}

double text_width(std::string_view text, double size) {
  double width = 0;
  each_character(text, [&](uint32_t code) { width += glyph_of(code).advance; });
  return width * size / units_per_em;
}

void draw_text(Image& image, double x, double y, std::string_view text, double size, Rgb colour) {
  const double scale = size / units_per_em;
  std::vector<Edge> edge;
  each_character(text, [&](uint32_t code) {
    const Glyph& g = glyph_of(code);
    edge.clear();
    for (std::string_view rest = g.outline; !rest.empty();) {
      const std::string_view ring = rest.substr(0, rest.find(' '));
      rest.remove_prefix(std::min(rest.size(), ring.size() + 1));
      const auto corner = [&](size_t i) {
        return std::pair{x + (ring[2 * i] - glyph_x0) * scale, y - (ring[2 * i + 1] - glyph_y0) * scale};
      };
      for (size_t i = 0, n = ring.size() / 2; i < n; ++i) {
        const auto a = corner(i), b = corner((i + 1) % n);
        edge.push_back({a.first, a.second, b.first, b.second});
      }
    }
    fill_polygons(image, edge, colour);
    x += g.advance * scale;
  });
}

std::string shortened(const std::string& text, double size, double width) {
  if (text_width(text, size) <= width)
    return text;
  std::string cut = text;
  while (!cut.empty() && text_width(cut + "…", size) > width) {
    while (cut.size() > 1 && static_cast<unsigned char>(cut.back()) >> 6 == 2) // a character's further bytes
      cut.pop_back();
    cut.pop_back();
  }
  return cut + "…";
}

} // namespace molmesh::picture
