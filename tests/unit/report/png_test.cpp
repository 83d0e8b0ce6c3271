// png_test.cpp — a PNG is read back by the rules of its specification.
#include "formats/png/png.hpp"
#include <catch2/catch.hpp>
#include <cstdlib>
#include <zlib.h>

using namespace molmesh;

namespace {

uint32_t number(const std::string& s, size_t at) {
  uint32_t v = 0;
  for (size_t i = 0; i < 4; ++i)
    v = v << 8 | static_cast<unsigned char>(s[at + i]);
  return v;
}

picture::Image read_back(const std::string& png) {
  REQUIRE(png.substr(0, 8) == "\x89PNG\r\n\x1a\n");
  std::string types, data;
  picture::Image image;
  for (size_t at = 8; at < png.size();) {
    const uint32_t length = number(png, at);
    const std::string type = png.substr(at + 4, 4), body = png.substr(at + 8, length);
    const std::string summed = type + body;
    CHECK(number(png, at + 8 + length) ==
          crc32(0, reinterpret_cast<const Bytef*>(summed.data()), uInt(summed.size())));
    types += type + ' ';
    if (type == "IHDR") {
      image = picture::Image(int(number(body, 0)), int(number(body, 4)), {});
      CHECK(body.substr(8) == std::string("\x08\x02\0\0\0", 5));
    } else if (type == "IDAT")
      data += body;
    at += 12 + length;
  }
  CHECK(types == "IHDR IDAT IEND ");
  const size_t bytes = 3 * size_t(image.width);
  std::string rows((bytes + 1) * size_t(image.height), '\0');
  uLongf size = rows.size();
  REQUIRE(uncompress(reinterpret_cast<Bytef*>(rows.data()), &size, reinterpret_cast<const Bytef*>(data.data()),
                     data.size()) == Z_OK);
  REQUIRE(size == rows.size());
  for (size_t y = 0; y < size_t(image.height); ++y)
    for (size_t i = 0; i < bytes; ++i) {
      const int filter = rows[y * (bytes + 1)];
      const auto at = [&](size_t r, size_t k) { return int(image.rgb[r * bytes + k]); };
      const int a = i < 3 ? 0 : at(y, i - 3), b = y == 0 ? 0 : at(y - 1, i),
                c = y == 0 || i < 3 ? 0 : at(y - 1, i - 3);
      const int p = a + b - c, pa = std::abs(p - a), pb = std::abs(p - b), pc = std::abs(p - c);
      REQUIRE(filter <= 4);
      const int predicted[] = {0, a, b, (a + b) / 2, pa <= pb && pa <= pc ? a : pb <= pc ? b : c};
      image.rgb[y * bytes + i] = static_cast<uint8_t>(rows[y * (bytes + 1) + 1 + i] + predicted[filter]);
    }
  return image;
}

} // namespace

TEST_CASE("a PNG holds every pixel of the picture") {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {64, 3}, {3, 64}}) {
    picture::Image image(width, height, {10, 20, 30});
    for (size_t i = 0; i < image.rgb.size(); ++i)
      image.rgb[i] = static_cast<uint8_t>(i % 5 == 0 ? 17 * i * i : i / 3 + 2 * (i % 3));
    const std::string png = formats::png(image);
    const picture::Image back = read_back(png);
    CHECK(back.width == width);
    CHECK(back.height == height);
    CHECK(back.rgb == image.rgb);
    CHECK(formats::png(image) == png);
  }
}
