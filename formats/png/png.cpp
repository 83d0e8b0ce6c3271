// png.cpp — signature, header, one compressed block of rows, end; zlib compresses and sums.
#include "formats/png/png.hpp"
#include <cstdlib>
#include <new>
#include <zlib.h>

namespace molmesh::formats {
namespace {

void add_number(std::string& s, uint32_t v) {
  for (int shift = 24; shift >= 0; shift -= 8)
    s += static_cast<char>(v >> shift);
}

void add_chunk(std::string& s, const std::string& type, const std::string& data) {
  add_number(s, static_cast<uint32_t>(data.size()));
  const std::string summed = type + data;
  s += summed;
  add_number(s, static_cast<uint32_t>(
                    crc32(0, reinterpret_cast<const Bytef*>(summed.data()), static_cast<uInt>(summed.size()))));
}

/// The filter with the least sum of differences, as the specification advises; 0 none, 1 left, 2 above, 4 Paeth.
void add_row(std::string& rows, const picture::Image& image, int y) {
  const int bytes = 3 * image.width;
  const uint8_t* const row = image.at(0, y);
  const auto left = [&](int i) { return i < 3 ? 0 : row[i - 3]; };
  const auto above = [&](int i) { return y == 0 ? 0 : image.at(0, y - 1)[i]; };
  const auto corner = [&](int i) { return y == 0 || i < 3 ? 0 : image.at(0, y - 1)[i - 3]; };
  const auto paeth = [&](int i) {
    const int a = left(i), b = above(i), c = corner(i), p = std::abs(b - c), q = std::abs(a - c),
              r = std::abs(a + b - 2 * c);
    return p <= q && p <= r ? a : q <= r ? b : c;
  };
  std::string best;
  int64_t least = -1;
  for (const int filter : {0, 1, 2, 4}) {
    std::string line(1, static_cast<char>(filter));
    int64_t sum = 0;
    for (int i = 0; i < bytes; ++i) {
      const int predicted = filter == 0 ? 0 : filter == 1 ? left(i) : filter == 2 ? above(i) : paeth(i);
      const auto difference = static_cast<int8_t>(row[i] - predicted);
      sum += std::abs(int{difference});
      line += static_cast<char>(difference);
    }
    if (least < 0 || sum < least)
      least = sum, best = line;
  }
  rows += best;
}

} // namespace

std::string png(const picture::Image& image) {
  std::string head, rows;
  add_number(head, static_cast<uint32_t>(image.width));
  add_number(head, static_cast<uint32_t>(image.height));
  head += std::string("\x08\x02\0\0\0", 5); // 8 bits, red green blue, deflate, filters a row, not interlaced
  for (int y = 0; y < image.height; ++y)
    add_row(rows, image, y);
  uLongf size = compressBound(rows.size());
  std::string data(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(data.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
                rows.size(), 9) != Z_OK)
    throw std::bad_alloc();
  data.resize(size);
  std::string s = "\x89PNG\r\n\x1a\n";
  add_chunk(s, "IHDR", head);
  add_chunk(s, "IDAT", data);
  add_chunk(s, "IEND", "");
  return s;
}

} // namespace molmesh::formats
