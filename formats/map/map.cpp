// map.cpp — CCP4/MRC and OpenDX, a line of points at a time: memory stays that of the sparse grid.
#include "formats/map/map.hpp"
#include "base/error.hpp"
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <ostream>

namespace molmesh::formats {
namespace {

int64_t checked_points(const GridFrame& f, const std::string& file) {
  const double n = double(f.points.x) * f.points.y * f.points.z;
  if (n > 8e9)
    fail_input(file + ": a dense map would have " + std::to_string(f.points.x) + " x " +
               std::to_string(f.points.y) + " x " + std::to_string(f.points.z) +
               " points, expected at most 8000000000");
  return static_cast<int64_t>(n);
}

/// Values along one axis from `at`: one look-up a block.
class Line {
public:
  explicit Line(const BlockGrid& grid) : grid_(grid), index_(grid) {}
  template <class Use>
  void along(Vec3i at, int axis, Use&& use) const {
    const int32_t end = grid_.frame.lower[axis] + grid_.frame.points[axis];
    while (at[axis] < end) {
      const int64_t b = index_.find(at);
      const int32_t stop = std::min(end, block_corner(at)[axis] + 8);
      for (; at[axis] < stop; ++at[axis])
        use(b >= 0                    ? grid_.value[512 * b + slot(at)]
            : b == BlockIndex::inside ? static_cast<float>(grid_.info.inside_value)
                                      : 0.0f);
    }
  }

private:
  const BlockGrid& grid_;
  BlockIndex index_;
};

struct Moments {
  float least = 0, most = 0;
  double mean = 0, deviation = 0;
};

Moments moments(const BlockGrid& grid, int64_t points) {
  // Points beyond the grid in blocks at its wall are left out; blocks that are not there hold 0.
  const Vec3i lo = grid.frame.lower, hi = lo + grid.frame.points;
  double sum = 0, squares = 0;
  int64_t added = 0;
  Moments m{std::numeric_limits<float>::max(), 0};
  const auto add = [&](double v) {
    ++added;
    sum += v;
    squares += v * v;
    m.least = std::min(m.least, static_cast<float>(v));
    m.most = std::max(m.most, static_cast<float>(v));
  };
  const auto block = [&](Vec3i corner, auto value) {
    for (int s = 0; s < 512; ++s)
      if (const Vec3i p = corner + within_block(s);
          p.x < hi.x && p.y < hi.y && p.z < hi.z && p.x >= lo.x && p.y >= lo.y && p.z >= lo.z)
        add(value(static_cast<size_t>(s)));
  };
  for (size_t b = 0; b < grid.corner.size(); ++b)
    block(grid.corner[b], [&](size_t s) { return grid.value[512 * b + s]; });
  for (const Vec3i& c : grid.inside)
    block(c, [&](size_t) { return static_cast<float>(grid.info.inside_value); });
  if (added < points)
    m.least = std::min(m.least, 0.0f);
  m.mean = sum / static_cast<double>(points);
  m.deviation = std::sqrt(std::max(0.0, squares / static_cast<double>(points) - m.mean * m.mean));
  return m;
}

} // namespace

void write_ccp4(std::ostream& out, const BlockGrid& grid, const std::string& file) {
  const GridFrame& f = grid.frame;
  const Moments m = moments(grid, checked_points(f, file));
  char header[1024] = {};
  const auto put = [&header](int word, auto v) { // words count from 1, as in the format's description
    static_assert(sizeof v == 4);
    std::memcpy(header + 4 * (word - 1), &v, 4);
  };
  for (int a = 0; a < 3; ++a) {
    put(1 + a, f.points[a]);
    put(5 + a, int32_t{0}); // start: the origin is in words 50 to 52, exact
    put(8 + a, f.points[a]);
    put(11 + a, static_cast<float>(f.spacing * f.points[a])); // cell, Å
    put(14 + a, 90.0f);
    put(17 + a, int32_t{a + 1}); // columns, rows, sections: x, y, z
    put(50 + a, static_cast<float>(f.position(f.lower)[a]));
  }
  put(4, int32_t{2}); // float
  put(20, m.least);
  put(21, m.most);
  put(22, static_cast<float>(m.mean));
  put(23, int32_t{1});     // space group P1
  put(28, int32_t{20140}); // version
  std::memcpy(header + 208, "MAP ", 4);
  std::memcpy(header + 212, "\x44\x44\0\0", 4); // little-endian
  put(55, static_cast<float>(m.deviation));
  put(56, int32_t{1});
  char isovalue[40];
  std::snprintf(isovalue, sizeof isovalue, "%.9g", grid.info.isovalue);
  const std::string label = grid.info.creator + ", isovalue " + isovalue;
  std::memset(header + 224, ' ', 80);
  std::memcpy(header + 224, label.data(), std::min<size_t>(80, label.size()));
  out.write(header, sizeof header);

  const Line line(grid);
  std::vector<float> row(static_cast<size_t>(f.points.x));
  for (int32_t z = 0; z < f.points.z; ++z)
    for (int32_t y = 0; y < f.points.y && out; ++y) {
      float* to = row.data();
      line.along(f.lower + Vec3i{0, y, z}, 0, [&](float v) { *to++ = v; });
      out.write(reinterpret_cast<const char*>(row.data()), static_cast<std::streamsize>(4 * row.size()));
    }
}

void write_dx(std::ostream& out, const BlockGrid& grid, const std::string& file) {
  const GridFrame& f = grid.frame;
  const int64_t points = checked_points(f, file);
  const auto number = [](auto v) {
    char text[40];
    return std::string(text, std::to_chars(text, text + sizeof text, v).ptr);
  };
  const std::string counts = number(f.points.x) + " " + number(f.points.y) + " " + number(f.points.z);
  const Vec3d origin = f.position(f.lower);
  const std::string h = number(f.spacing);
  out << "# " << grid.info.creator << ", isovalue " << number(grid.info.isovalue) << "\n"
      << "object 1 class gridpositions counts " << counts << "\n"
      << "origin " << number(origin.x) << " " << number(origin.y) << " " << number(origin.z) << "\n"
      << "delta " << h << " 0 0\ndelta 0 " << h << " 0\ndelta 0 0 " << h << "\n"
      << "object 2 class gridconnections counts " << counts << "\n"
      << "object 3 class array type double rank 0 items " << points << " data follows\n";
  const Line line(grid);
  std::string text;
  int64_t written = 0;
  for (int32_t x = 0; x < f.points.x; ++x)
    for (int32_t y = 0; y < f.points.y && out; ++y) {
      line.along(f.lower + Vec3i{x, y, 0}, 2, [&](float v) {
        char digits[32];
        text.append(digits, std::to_chars(digits, digits + sizeof digits, v).ptr);
        text += ++written % 3 == 0 ? '\n' : ' ';
      });
      out.write(text.data(), static_cast<std::streamsize>(text.size()));
      text.clear();
    }
  if (points % 3 != 0)
    out << "\n";
  out << "attribute \"dep\" string \"positions\"\n"
      << "object \"density\" class field\n"
      << "component \"positions\" value 1\ncomponent \"connections\" value 2\ncomponent \"data\" value 3\n";
}

} // namespace molmesh::formats
