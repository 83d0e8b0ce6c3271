// ccp4_reader.cpp — the header of a CCP4/MRC map, in either byte order, and its values (MAP.md, rules M1 to M6).
#include "base/error.hpp"
#include "formats/map/read_map.hpp"
#include "par/pages.hpp"
#include "par/par.hpp"
#include <cmath>
#include <cstring>
#include <limits>

namespace molmesh::formats {
namespace {

constexpr size_t header_size = 1024;

template <class T>
T number(const char* at, bool swap) {
  char b[sizeof(T)];
  std::memcpy(b, at, sizeof b);
  if (swap)
    std::reverse(b, b + sizeof b);
  T v;
  std::memcpy(&v, b, sizeof v);
  return v;
}

class Reader {
public:
  Reader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}
  compose::DenseMap run(int threads);

private:
  [[noreturn]] void refuse(const std::string& what) const { fail_input(file_ + ": " + what); }
  int32_t word(int n) const { return number<int32_t>(bytes_.data() + 4 * (n - 1), swap_); } // counts from 1
  double real(int n) const { return number<float>(bytes_.data() + 4 * (n - 1), swap_); }
  void find_order();
  void read_axes(compose::DenseMap& map);
  template <class T>
  void read_values(compose::DenseMap& map, const char* from, int threads) const;

  std::string_view bytes_;
  const std::string& file_;
  bool swap_ = false;
  int along_[3] = {}; ///< the map's axis of columns, rows and sections
};

/// What the machine stamp (word 54) says; where it says nothing, that in which the mode and the number of columns
/// are small numbers.
void Reader::find_order() {
  const std::string_view stamp = bytes_.substr(212, 2);
  if (stamp == "\x44\x44" || stamp == "\x44\x41" || stamp == "\x11\x11") {
    swap_ = stamp == "\x11\x11";
    if (word(4) >= 0 && word(4) < 256)
      return;
  }
  const auto likely = [&](bool swap) {
    swap_ = swap;
    return word(4) >= 0 && word(4) < 256 && word(1) > 0 && word(1) < 1 << 24;
  };
  if (!likely(false) && !likely(true))
    refuse("M1: neither a CCP4/MRC map nor an OpenDX file, expected one of them");
}

void Reader::read_axes(compose::DenseMap& map) {
  double cell[3], angle[3];
  for (int a = 0; a < 3; ++a) {
    cell[a] = real(11 + a);
    angle[a] = real(14 + a);
    if (!(cell[a] > 0 && cell[a] < 1e6) || !(angle[a] > 1 && angle[a] < 179) || word(8 + a) < 1)
      refuse("M4: a cell of " + std::to_string(cell[a]) + " Å, " + std::to_string(angle[a]) + "° and " +
             std::to_string(word(8 + a)) + " intervals along axis " + std::to_string(a + 1) +
             ", expected positive ones");
  }
  bool any = false, seen[3] = {};
  for (int a = 0; a < 3; ++a)
    any = any || word(17 + a) != 0;
  for (int a = 0; a < 3; ++a) {
    const int axis = any ? word(17 + a) : a + 1;
    if (axis < 1 || axis > 3 || seen[axis - 1])
      refuse("M3: columns, rows and sections are not the axes 1, 2 and 3 in some order");
    seen[axis - 1] = true;
    along_[a] = axis - 1;
  }
  // The first axis is x, the second in the plane of x and y.
  const auto degrees = [](double d) { return d * 3.14159265358979323846 / 180; };
  const auto cosine = [&](double d) { return d == 90 ? 0 : std::cos(degrees(d)); };
  const double ca = cosine(angle[0]), cb = cosine(angle[1]), cg = cosine(angle[2]),
               sg = angle[2] == 90 ? 1 : std::sin(degrees(angle[2]));
  const double x = cb, y = (ca - cb * cg) / sg, z2 = 1 - x * x - y * y;
  if (!(z2 > 1e-6))
    refuse("M4: a cell of no volume");
  const Vec3d edge[3] = {{1, 0, 0}, {cg, sg, 0}, {x, y, std::sqrt(z2)}};
  Vec3i start;
  bool has_origin = false;
  for (int a = 0; a < 3; ++a) {
    map.axis[a] = cell[a] / word(8 + a) * edge[a];
    map.points[along_[a]] = word(1 + a);
    start[along_[a]] = word(5 + a);
    has_origin = has_origin || real(50 + a) != 0;
  }
  for (int a = 0; a < 3; ++a) {
    if (!std::isfinite(real(50 + a)) || std::abs(real(50 + a)) > 1e9 || std::abs(double(start[a])) > 1e8)
      refuse("M4: the map's place is not a number below 1e9");
    if (has_origin)
      map.origin[a] = real(50 + a);
    else
      map.origin += double(start[a]) * map.axis[a];
  }
}

/// IEEE 754's binary16.
struct Half {
  uint16_t bits;
  explicit operator float() const {
    const int exponent = bits >> 10 & 31, fraction = bits & 1023;
    const float sign = bits >> 15 ? -1.0f : 1.0f;
    if (exponent == 31)
      return fraction ? std::numeric_limits<float>::quiet_NaN() : sign * std::numeric_limits<float>::infinity();
    return sign * std::ldexp(static_cast<float>(exponent ? fraction + 1024 : fraction), std::max(exponent, 1) - 25);
  }
};

template <class T>
void Reader::read_values(compose::DenseMap& map, const char* from, int threads) const {
  const int64_t columns = map.points[along_[0]], rows = map.points[along_[1]], sections = map.points[along_[2]];
  par::for_n(sections, threads, 1, [&](int64_t s) {
    const char* at = from + s * rows * columns * static_cast<int64_t>(sizeof(T));
    Vec3i p;
    p[along_[2]] = static_cast<int32_t>(s);
    for (int64_t r = 0; r < rows; ++r) {
      p[along_[1]] = static_cast<int32_t>(r);
      for (int64_t c = 0; c < columns; ++c, at += sizeof(T)) {
        p[along_[0]] = static_cast<int32_t>(c);
        const auto v = static_cast<float>(number<T>(at, swap_));
        if (!std::isfinite(v))
          refuse("M6: a value that is not finite");
        map.value[map.index(p.x, p.y, p.z)] = v;
      }
    }
  });
}

compose::DenseMap Reader::run(int threads) {
  if (bytes_.size() < header_size)
    refuse("M1: " + std::to_string(bytes_.size()) + " bytes, expected a CCP4/MRC map or an OpenDX file");
  find_order();
  compose::DenseMap map;
  const int32_t mode = word(4);
  const size_t size = mode == 0 ? 1 : mode == 1 || mode == 6 || mode == 12 ? 2 : mode == 2 ? 4 : 0;
  if (size == 0)
    refuse("M2: mode " + std::to_string(mode) + ", expected 0, 1, 2, 6 or 12");
  double n = 1;
  for (int a = 0; a < 3; ++a) {
    if (word(1 + a) < 2 || word(1 + a) > 1 << 24)
      refuse("M2: " + std::to_string(word(1 + a)) + " points along an axis, expected 2 to 2^24");
    n *= word(1 + a);
  }
  const int32_t symmetry = word(24);
  if (symmetry < 0)
    refuse("M2: an extended header of " + std::to_string(symmetry) + " bytes");
  const double left = static_cast<double>(bytes_.size() - header_size) - symmetry;
  if (n * static_cast<double>(size) > left)
    refuse("M5: the file ends before the map's " + std::to_string(word(1)) + " x " + std::to_string(word(2)) +
           " x " + std::to_string(word(3)) + " points");
  read_axes(map);
  par::resize_pages(map.value, static_cast<size_t>(n), threads);
  const char* const from = bytes_.data() + header_size + symmetry;
  switch (mode) {
  case 0:
    read_values<int8_t>(map, from, threads);
    break;
  case 1:
    read_values<int16_t>(map, from, threads);
    break;
  case 6:
    read_values<uint16_t>(map, from, threads);
    break;
  case 12:
    read_values<Half>(map, from, threads);
    break;
  default:
    read_values<float>(map, from, threads);
  }
  return map;
}

} // namespace

compose::DenseMap parse_ccp4(std::string_view bytes, const std::string& file, int threads) {
  return Reader(bytes, file).run(threads);
}

} // namespace molmesh::formats
