// gunzip.cpp — zlib around growing memory.
#include "formats/pdb/gunzip.hpp"
#include "base/error.hpp"
#include <algorithm>
#include <limits>
#include <memory>
#include <zlib.h>

namespace molmesh::formats {
namespace {

struct End {
  void operator()(z_stream* z) const { inflateEnd(z); }
};

} // namespace

bool is_gzip(std::string_view bytes) {
  return bytes.size() >= 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
}

std::string gunzip(std::string_view bytes, const std::string& file) {
  z_stream z{};
  if (inflateInit2(&z, 15 + 16) != Z_OK)
    throw std::bad_alloc();
  const std::unique_ptr<z_stream, End> guard(&z);
  std::string text;
  size_t used = 0;
  text.resize(std::max<size_t>(4 * bytes.size(), 4096));
  size_t made = 0;
  constexpr size_t limit = std::numeric_limits<uInt>::max();
  for (;;) {
    if (made == text.size())
      text.resize(2 * text.size());
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + used)); // zlib does not write to it
    z.avail_in = static_cast<uInt>(std::min(bytes.size() - used, limit));
    z.next_out = reinterpret_cast<Bytef*>(text.data() + made);
    z.avail_out = static_cast<uInt>(std::min(text.size() - made, limit));
    const int status = inflate(&z, Z_NO_FLUSH);
    used = static_cast<size_t>(reinterpret_cast<const char*>(z.next_in) - bytes.data());
    made = static_cast<size_t>(reinterpret_cast<char*>(z.next_out) - text.data());
    if (status == Z_STREAM_END) {
      const std::string_view rest = bytes.substr(used);
      if (rest.find_first_not_of('\0') == std::string_view::npos)
        break;
      if (!is_gzip(rest))
        fail_input(file + ": found " + std::to_string(rest.size()) +
                   " bytes after the gzip data, expected its end");
      inflateReset(&z);
    } else if (status == Z_MEM_ERROR) {
      throw std::bad_alloc();
    } else if (used == bytes.size() && z.avail_out != 0) {
      fail_input(file + ": found the end within gzip data, expected a complete file");
    } else if (status != Z_OK && status != Z_BUF_ERROR) {
      fail_input(file + ": found damaged gzip data (" + (z.msg ? z.msg : "checksum") + "), expected a whole file");
    }
  }
  text.resize(made);
  return text;
}

} // namespace molmesh::formats
