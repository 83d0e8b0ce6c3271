// from_map.cpp — evaluates the blocks that the contour may cross.
#include "compose/from_map.hpp"
#include "base/error.hpp"
#include "compose/draft.hpp"
#include "par/pages.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cstdio>
#include <limits>
#include <vector>

namespace molmesh::compose {
namespace {

struct Range {
  float lo = std::numeric_limits<float>::max(), hi = std::numeric_limits<float>::lowest();
  void add(const Range& r) {
    lo = std::min(lo, r.lo);
    hi = std::max(hi, r.hi);
  }
};

/// The range of the values in each cube of 8³ points.
class Ranges {
public:
  Ranges(const DenseMap& map, int threads) : points_(map.points) {
    for (int a = 0; a < 3; ++a)
      n_[a] = (points_[a] + 7) / 8;
    range_.resize(static_cast<size_t>(int64_t{n_.x} * n_.y * n_.z));
    par::for_n(int64_t{n_.y} * n_.z, threads, 16, [&](int64_t row) {
      const auto y = static_cast<int32_t>(row % n_.y), z = static_cast<int32_t>(row / n_.y);
      for (int32_t k = 8 * z; k < std::min(points_.z, 8 * z + 8); ++k)
        for (int32_t j = 8 * y; j < std::min(points_.y, 8 * y + 8); ++j)
          for (int32_t i = 0; i < points_.x; ++i) {
            const float v = map.value[map.index(i, j, k)];
            range_[i / 8 + n_.x * row].add({v, v});
          }
    });
  }
  Range all() const {
    Range r;
    for (const Range& one : range_)
      r.add(one);
    return r;
  }
  /// Of the points from lo to hi, both included and moved within the walls.
  Range within(Vec3i lo, Vec3i hi) const {
    Range r;
    Vec3i b, e;
    for (int a = 0; a < 3; ++a) {
      b[a] = std::clamp(lo[a], 0, points_[a] - 1) / 8;
      e[a] = std::clamp(hi[a], 0, points_[a] - 1) / 8;
    }
    for (int32_t z = b.z; z <= e.z; ++z)
      for (int32_t y = b.y; y <= e.y; ++y)
        for (int32_t x = b.x; x <= e.x; ++x)
          r.add(range_[x + n_.x * (y + int64_t{n_.y} * z)]);
    return r;
  }

private:
  Vec3i points_, n_;
  std::vector<Range> range_;
};

/// Half of the map's points next to the contour have a gradient of at least this length, 1/Å.
double slope_at_level(const DenseMap& map, double level, int threads) {
  Vec3d row[3];
  map.to_indices(row);
  const Vec3i n = map.points;
  std::vector<std::vector<float>> of_layer(static_cast<size_t>(n.z));
  par::for_n(n.z, threads, 1, [&](int64_t layer) {
    const auto k = static_cast<int32_t>(layer);
    for (int32_t j = 0; j < n.y; ++j)
      for (int32_t i = 0; i < n.x; ++i) {
        const Vec3i p{i, j, k};
        const bool inside = map.at(p) > level;
        bool crossed = false;
        Vec3d g;
        for (int a = 0; a < 3; ++a) {
          Vec3i before = p, behind = p;
          before[a] = std::max(0, p[a] - 1);
          behind[a] = std::min(n[a] - 1, p[a] + 1);
          const double lo = map.at(before), hi = map.at(behind);
          crossed = crossed || (lo > level) != inside || (hi > level) != inside;
          g += (hi - lo) / (behind[a] - before[a]) * row[a];
        }
        if (crossed)
          of_layer[layer].push_back(static_cast<float>(norm(g)));
      }
  });
  std::vector<float> all;
  for (const std::vector<float>& l : of_layer)
    all.insert(all.end(), l.begin(), l.end());
  if (all.empty())
    return 0;
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
  std::nth_element(all.begin(), middle, all.end());
  return *middle;
}

/// The lattice of a map with three equal steps along x, y and z.
bool cubic(const DenseMap& map) {
  const double h = map.axis[0].x;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      if (!(std::abs(map.axis[a][b] - (a == b ? h : 0)) <= 1e-4 * h))
        return false;
  return h > 0;
}

int64_t points_inside_walls(const DenseMap& map, double level) {
  const Vec3i n = map.points;
  int64_t count = 0;
  for (int32_t k = 0; k < n.z; ++k)
    for (int32_t j = 0; j < n.y; ++j) {
      const bool whole_line = k == 0 || j == 0 || k == n.z - 1 || j == n.y - 1;
      for (int32_t i = 0; i < n.x; i += whole_line ? 1 : n.x - 1)
        count += map.at({i, j, k}) > level;
    }
  return count;
}

/// A frame round the map, with a point beyond its walls. Its origin is a point of the lattice next to the map's.
GridFrame frame_of(const DenseMap& map, double h, Vec3d lattice, bool own) {
  GridFrame f{map.origin, h, {-1, -1, -1}, {}};
  if (!own)
    for (int a = 0; a < 3; ++a)
      f.origin[a] = lattice[a] + h * std::floor((map.origin[a] - lattice[a]) / h + 1e-6);
  Vec3d lo = map.origin, hi = map.origin;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      const double reach = (map.points[a] - 1) * map.axis[a][b];
      (reach < 0 ? lo : hi)[b] += reach;
    }
  for (int a = 0; a < 3; ++a) {
    const double below = (f.origin[a] - lo[a]) / h, above = (hi[a] - f.origin[a]) / h;
    if (!(below + above < 1 << 28) || !(std::abs(lo[a]) < 1e10 * h && std::abs(hi[a]) < 1e10 * h))
      fail(Status::usage, "the grid would have more than 2^28 points along an axis, expected a larger spacing",
           {"spacing"});
    f.lower[a] = -static_cast<int32_t>(std::ceil(below - 1e-6)) - 1;
    f.points[a] = own ? map.points[a] + 2 : static_cast<int32_t>(std::ceil(above - 1e-6)) + 2 - f.lower[a];
  }
  return f;
}

} // namespace

BlockGrid from_map(const DenseMap& map, const MapOptions& o, MapCounts& counts) {
  const Ranges ranges(map, o.threads);
  const Range all = ranges.all();
  counts.least = all.lo;
  counts.most = all.hi;
  counts.slope_of_map = slope_at_level(map, o.level, o.threads);
  if (!(counts.slope_of_map > 0)) {
    char text[160];
    std::snprintf(text, sizeof text, "the map does not cross the level %g: its values go from %g to %g", o.level,
                  counts.least, counts.most);
    fail(Status::usage, text, {"level"});
  }
  const double step[3] = {norm(map.axis[0]), norm(map.axis[1]), norm(map.axis[2])};
  const double own = cubic(map) ? map.axis[0].x : std::min({step[0], step[1], step[2]});
  const double h = o.spacing > 0 ? o.spacing : own;
  const Vec3d lattice = o.lattice.value_or(map.origin);
  bool same = cubic(map) && std::abs(h - own) <= 1e-9 * own;
  for (int a = 0; a < 3; ++a) {
    const double off = (map.origin[a] - lattice[a]) / own;
    same = same && std::abs(off - std::round(off)) <= 1e-6;
  }
  counts.interpolated = !same;
  counts.wall_points = points_inside_walls(map, o.level);

  Draft draft;
  draft.frame = frame_of(map, h, lattice, same);
  FieldInfo& info = draft.info;
  info.isovalue = o.isovalue;
  info.decay = o.decay;
  info.band_lower = o.band_lower * o.isovalue;
  info.band_upper = o.band_upper * o.isovalue;
  info.inside_value = static_cast<float>(std::max(2 * o.isovalue, info.band_upper));
  info.tolerance = 1e-6; // rounding
  const Vec3i lo = draft.frame.lower, points = draft.frame.points, hi = lo + points;
  info.analyzed_points = int64_t{points.x} * points.y * points.z;

  Vec3d row[3];
  map.to_indices(row);
  const auto to_map = [&](Vec3d p) { // from the frame's indices
    const Vec3d d = h * p + (draft.frame.origin - map.origin);
    return Vec3d{dot(row[0], d), dot(row[1], d), dot(row[2], d)};
  };
  const double factor = o.slope / counts.slope_of_map, margin = std::log(o.band_upper) / factor,
               below = std::log(o.band_lower) / factor; // of the values, from the level
  enum Side : uint8_t { outside, inside, open };
  const auto side_of = [&](Vec3i corner) { // of the block and the points next to it
    Vec3d least{1e300, 1e300, 1e300}, most{-1e300, -1e300, -1e300};
    for (int k = 0; k < 8; ++k) {
      const Vec3d u = to_map(to_double(corner) + Vec3d{k & 1 ? 8. : -1., k & 2 ? 8. : -1., k & 4 ? 8. : -1.});
      for (int a = 0; a < 3; ++a) {
        least[a] = std::min(least[a], u[a]);
        most[a] = std::max(most[a], u[a]);
      }
    }
    Vec3i first, last;
    bool beyond = false, all_beyond = false;
    for (int a = 0; a < 3; ++a) {
      const double end = map.points[a] - 1;
      all_beyond = all_beyond || most[a] < -1e-6 || least[a] > end + 1e-6;
      beyond = beyond || least[a] < 0 || most[a] > end;
      first[a] = static_cast<int32_t>(std::floor(std::clamp(least[a], 0.0, end))) - 1;
      last[a] = static_cast<int32_t>(std::floor(std::clamp(most[a], 0.0, end))) + 2;
    }
    if (all_beyond)
      return outside;
    const Range r = ranges.within(first, last);
    const double middle = 0.5 * (double{r.lo} + r.hi),
                 half = (same ? 0.5 : 0.5 * DenseMap::overshoot) * (double{r.hi} - r.lo);
    if (middle + half < o.level + below)
      return outside;
    return middle - half > o.level + margin && !beyond ? inside : open;
  };
  const Vec3i first = block_corner(lo), end = block_corner(hi + Vec3i{7, 7, 7});
  const int64_t ny = (end.y - first.y) / 8, nz = (end.z - first.z) / 8, blocks = (end.x - first.x) / 8 * ny * nz;
  if (blocks > int64_t{1} << 28)
    fail(Status::usage, "the grid would have more than 1.4e11 points, expected a larger spacing", {"spacing"});
  const auto corner_of = [&](int64_t b) {
    return first + 8 * Vec3i{static_cast<int32_t>(b / (ny * nz)), static_cast<int32_t>(b / nz % ny),
                             static_cast<int32_t>(b % nz)};
  };
  std::vector<uint8_t> side(static_cast<size_t>(blocks));
  par::for_n(blocks, o.threads, 256, [&](int64_t b) { side[b] = side_of(corner_of(b)); });
  for (int64_t b = 0; b < blocks; ++b)
    if (side[b] != outside)
      (side[b] == open ? draft.corner : draft.inside).push_back(corner_of(b));

  const auto n = static_cast<int64_t>(draft.corner.size());
  par::resize_pages(draft.value, static_cast<size_t>(512 * n), o.threads);
  par::resize_pages(draft.known, static_cast<size_t>(8 * n), o.threads);
  const double slack = same ? 0.5 : 1e-6; // of rounding, in the map's indices
  par::for_n(n, o.threads, 16, [&](int64_t b) {
    for (int s = 0; s < 512; ++s) {
      const Vec3i p = draft.corner[b] + within_block(s);
      Vec3d u = to_map(to_double(p));
      bool in_frame = true, in_map = true;
      for (int a = 0; a < 3; ++a) {
        in_frame = in_frame && p[a] >= lo[a] && p[a] < hi[a];
        in_map = in_map && u[a] >= -slack && u[a] <= map.points[a] - 1 + slack;
        u[a] = std::clamp(u[a], 0.0, map.points[a] - 1.0);
      }
      double f = -1; // beyond the walls
      if (in_map)
        f = factor * ((same ? double{map.at(p)} : map.tricubic(u)) - o.level);
      draft.value[512 * b + s] =
          in_frame ? static_cast<float>(o.isovalue * std::exp(std::clamp(f, -60.0, 60.0))) : 0;
    }
    std::fill_n(&draft.known[8 * b], 8, ~uint64_t{0});
  });
  int64_t unknown = 0;
  return finish(std::move(draft), o.threads, unknown);
}

} // namespace molmesh::compose
