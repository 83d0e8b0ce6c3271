// dx_reader.cpp — OpenDX grids as APBS and others write them, and gzip around maps (MAP.md, rules D1 to D5).
#include "base/error.hpp"
#include "formats/map/read_map.hpp"
#include <charconv>
#include <cstring>
#include <vector>
#include <zlib.h>

namespace molmesh::formats {
namespace {

class Reader {
public:
  Reader(std::string_view text, const std::string& file) : left_(text), file_(file) {}
  compose::DenseMap run();

private:
  [[noreturn]] void refuse(const std::string& what) const {
    fail_input(file_ + ":" + std::to_string(line_) + ": " + what);
  }
  bool next_line(std::vector<std::string_view>& words);
  template <class T>
  T number(const char* rule, std::string_view word) const {
    T v{};
    if (!word.empty() && word[0] == '+')
      word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), v);
    if (error != std::errc() || end != word.data() + word.size())
      refuse(std::string(rule) + ": found '" + std::string(word.substr(0, 40)) + "', expected a number");
    return v;
  }
  Vec3d vector(const char* rule, const std::vector<std::string_view>& w) const {
    if (w.size() < 4)
      refuse(std::string(rule) + ": " + std::string(w[0]) + " without three numbers");
    const Vec3d v{number<double>(rule, w[1]), number<double>(rule, w[2]), number<double>(rule, w[3])};
    if (!(norm(v) < 1e9))
      refuse(std::string(rule) + ": " + std::string(w[0]) + " of 1e9 or more, expected less");
    return v;
  }
  void read_values(compose::DenseMap& map);

  std::string_view left_;
  const std::string& file_;
  int64_t line_ = 0;
};

bool Reader::next_line(std::vector<std::string_view>& words) {
  words.clear();
  if (left_.empty())
    return false;
  ++line_;
  const size_t end = std::min(left_.find('\n'), left_.size());
  std::string_view line = left_.substr(0, end);
  left_.remove_prefix(std::min(end + 1, left_.size()));
  for (;;) {
    const size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos || (words.empty() && line[begin] == '#'))
      return true;
    line.remove_prefix(begin);
    const size_t stop = std::min(line.find_first_of(" \t\r"), line.size());
    words.push_back(line.substr(0, stop));
    line.remove_prefix(stop);
    if (words.size() > 64) // no line of values has more
      refuse("D2: a line of more than 64 words");
  }
}

/// z fastest.
void Reader::read_values(compose::DenseMap& map) {
  const int64_t n = int64_t{map.points.x} * map.points.y * map.points.z;
  map.value.resize(static_cast<size_t>(n));
  std::vector<std::string_view> w;
  Vec3i p;
  for (int64_t found = 0; found < n;) {
    if (!next_line(w))
      refuse("D4: the file ends after " + std::to_string(found) + " values, expected " + std::to_string(n));
    for (const std::string_view word : w) {
      if (found == n)
        refuse("D4: more than " + std::to_string(n) + " values");
      const auto v = number<double>("D4", word);
      if (!(std::abs(v) < 3e38))
        refuse("D4: a value that is not finite");
      map.value[map.index(p.x, p.y, p.z)] = static_cast<float>(v);
      ++found;
      if (++p.z == map.points.z) {
        p.z = 0;
        if (++p.y == map.points.y)
          p.y = 0, ++p.x;
      }
    }
  }
}

compose::DenseMap Reader::run() {
  compose::DenseMap map;
  std::vector<std::string_view> w;
  int deltas = 0;
  bool counts = false, origin = false;
  while (next_line(w)) {
    if (w.empty())
      continue;
    if (w[0] == "origin") {
      map.origin = vector("D3", w);
      origin = true;
    } else if (w[0] == "delta") {
      if (deltas == 3)
        refuse("D3: a fourth delta");
      map.axis[deltas++] = vector("D3", w);
    } else if (w[0] == "object" && w.size() >= 4 && w[2] == "class" && w[3] == "gridpositions") {
      if (w.size() != 8 || w[4] != "counts")
        refuse("D2: gridpositions without counts of three axes");
      double n = 1;
      for (int a = 0; a < 3; ++a) {
        map.points[a] = number<int32_t>("D2", w[5 + static_cast<size_t>(a)]);
        if (map.points[a] < 2 || map.points[a] > 1 << 24)
          refuse("D2: " + std::to_string(map.points[a]) + " points along an axis, expected 2 to 2^24");
        n *= map.points[a];
      }
      if (2 * n > static_cast<double>(left_.size()) + 1) // a digit and a blank
        refuse("D4: the file is too short for its " + std::string(w[5]) + " x " + std::string(w[6]) + " x " +
               std::string(w[7]) + " points");
      counts = true;
    } else if (w[0] == "object" && w.size() >= 4 && w[2] == "class" && w[3] == "array") {
      if (!counts || !origin || deltas != 3)
        refuse("D1: values before gridpositions, origin and three deltas");
      const double length = norm(map.axis[0]) * norm(map.axis[1]) * norm(map.axis[2]);
      if (!(std::abs(map.volume_of_cell()) > 1e-6 * length))
        refuse("D3: the deltas lie in a plane");
      for (size_t i = 4; i < w.size(); ++i) {
        if (w[i] == "binary" || w[i] == "ieee")
          refuse("D5: binary values, expected text");
        if (w[i] == "items" && i + 1 < w.size() &&
            number<int64_t>("D2", w[i + 1]) != int64_t{map.points.x} * map.points.y * map.points.z)
          refuse("D2: " + std::string(w[i + 1]) + " items, expected as many as points");
      }
      read_values(map);
      return map;
    }
  }
  refuse("D1: no values, expected gridpositions, origin, three deltas and an array");
}

/// Unpacks as much as is there; a byte of gzip makes 1032 at most.
std::string unpacked(std::string_view packed, const std::string& file) {
  z_stream z{};
  if (inflateInit2(&z, 15 + 32) != Z_OK)
    fail(Status::failed, file + ": no memory to unpack it");
  std::string out;
  constexpr size_t step = size_t{1} << 22;
  int state = Z_OK;
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  size_t left = packed.size();
  while (state == Z_OK) {
    const size_t before = out.size();
    out.resize(before + step);
    z.next_out = reinterpret_cast<Bytef*>(out.data() + before);
    z.avail_out = step;
    if (z.avail_in == 0) {
      const size_t some = std::min<size_t>(left, size_t{1} << 30);
      z.avail_in = static_cast<uInt>(some);
      left -= some;
    }
    state = inflate(&z, Z_NO_FLUSH);
    out.resize(before + step - z.avail_out);
    if (state == Z_BUF_ERROR && left > 0)
      state = Z_OK;
  }
  inflateEnd(&z);
  if (state != Z_STREAM_END)
    fail_input(file + ": G1: damaged or truncated, expected a whole gzip file");
  return out;
}

bool is_gzip(std::string_view b) {
  return b.size() > 2 && b[0] == '\x1f' && b[1] == '\x8b';
}

} // namespace

compose::DenseMap parse_dx(std::string_view text, const std::string& file) {
  return Reader(text, file).run();
}

bool is_vdb(std::string_view bytes) {
  return bytes.substr(0, 4) == std::string_view(" BDV", 4);
}

compose::DenseMap read_map(std::string bytes, const std::string& file, int threads) {
  if (is_gzip(bytes))
    bytes = unpacked(bytes, file);
  // An OpenDX file is text; a map's first word is a small number and has bytes of 0.
  const std::string_view head = std::string_view(bytes).substr(0, 1024);
  if (!head.empty() && head.find('\0') == std::string_view::npos)
    return parse_dx(bytes, file);
  return parse_ccp4(bytes, file, threads);
}

} // namespace molmesh::formats
