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

namespace {

/// Unpacks piece by piece into `room`, which take(bytes) empties; take(n) says how many bytes of it are filled.
template <class Take>
void inflate_all(std::string_view bytes, const std::string& file, std::string& room, Take&& take) {
  z_stream z{};
  if (inflateInit2(&z, 15 + 16) != Z_OK)
    throw std::bad_alloc();
  const std::unique_ptr<z_stream, End> guard(&z);
  size_t used = 0;
  constexpr size_t limit = std::numeric_limits<uInt>::max();
  for (;;) {
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + used)); // zlib does not write to it
    z.avail_in = static_cast<uInt>(std::min(bytes.size() - used, limit));
    z.next_out = reinterpret_cast<Bytef*>(room.data());
    z.avail_out = static_cast<uInt>(room.size());
    const int status = inflate(&z, Z_NO_FLUSH);
    used = static_cast<size_t>(reinterpret_cast<const char*>(z.next_in) - bytes.data());
    take(room.size() - z.avail_out);
    if (status == Z_STREAM_END) {
      const std::string_view rest = bytes.substr(used);
      if (rest.find_first_not_of('\0') == std::string_view::npos)
        return;
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
}

} // namespace

std::string gunzip(std::string_view bytes, const std::string& file) {
  // Twice: the first time for the size, so that neither a file of zeros nor growing memory takes more than the
  // text.
  const size_t most = most_unpacked(bytes.size());
  std::string room(size_t{1} << 16, '\0');
  size_t size = 0;
  inflate_all(bytes, file, room, [&](size_t n) {
    size += n;
    if (size > most)
      fail_input(file + ": found gzip data that unpack to over " + std::to_string(most) +
                 " bytes, expected at most 20 times their size and 64 MiB");
  });
  std::string text;
  text.reserve(size);
  inflate_all(bytes, file, room, [&](size_t n) { text.append(room, 0, n); });
  return text;
}

} // namespace molmesh::formats
