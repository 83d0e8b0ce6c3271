// halved_grid.cpp — the halved grid: each block's points and those between them, as eight blocks.
#include "contour/small_bodies/halved_grid.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace molmesh::contour {
namespace {

/// The 9³ points from a block's corner to those of the next.
struct Window {
  static constexpr int width = 9;
  std::array<float, width * width * width> value;
  std::array<double, width * width * width> logarithm; ///< of value / isovalue
  std::array<bool, width * width * width> active;

  static size_t at(Vec3i p) { return static_cast<size_t>((p.x * width + p.y) * width + p.z); }

  Window(const BlockGrid& grid, const BlockIndex& index, Vec3i corner) {
    const double iso = static_cast<float>(grid.info.isovalue);
    Vec3i p;
    for (p.x = 0; p.x < width; ++p.x)
      for (p.y = 0; p.y < width; ++p.y)
        for (p.z = 0; p.z < width; ++p.z) {
          const float v = value_at(grid, index, corner + p);
          value[at(p)] = v;
          logarithm[at(p)] = std::log(std::max(v, std::numeric_limits<float>::min()) / iso);
          active[at(p)] = is_active(grid, index, corner + p);
        }
  }
};

struct Child {
  Vec3i corner;
  std::array<float, 512> value;
  std::array<uint64_t, 8> active{};
  bool any_active() const {
    return std::any_of(active.begin(), active.end(), [](uint64_t word) { return word != 0; });
  }
};

struct Point {
  float value;
  bool active;
};

/// q: 0 … 15 on each axis, in half spacings from the window's corner. linear: G itself is interpolated.
Point point_at(const Window& window, Vec3i q, float iso, float inside_value, bool linear) {
  const Vec3i low{q.x >> 1, q.y >> 1, q.z >> 1};
  if (((q.x | q.y | q.z) & 1) == 0)
    return {window.value[Window::at(low)], window.active[Window::at(low)]};
  // A sum of sums along an axis: where both are on one side so is the sum, whatever is rounded.
  double sum = 0;
  bool active = true, inside = true;
  for (int x = 0; x <= (q.x & 1); ++x) {
    double in_plane = 0;
    for (int y = 0; y <= (q.y & 1); ++y) {
      double in_row = 0;
      for (int z = 0; z <= (q.z & 1); ++z) {
        const size_t at = Window::at(low + Vec3i{x, y, z});
        in_row += linear ? double(window.value[at]) - iso : window.logarithm[at];
        active = active && window.active[at];
        inside = inside && window.value[at] > iso;
      }
      in_plane += in_row;
    }
    sum += in_plane;
  }
  if (!active)
    return {inside ? inside_value : 0, false};
  const int points = (1 + (q.x & 1)) * (1 + (q.y & 1)) * (1 + (q.z & 1));
  const auto v = static_cast<float>(linear ? iso + sum / points : iso * std::exp(sum / points));
  // Nor does rounding to single precision.
  return {sum > 0 ? std::max(v, std::nextafter(iso, std::numeric_limits<float>::max())) : std::min(v, iso), true};
}

} // namespace

BlockGrid halved(const BlockGrid& grid, int threads, const std::vector<Vec3i>& linear) {
  const BlockIndex index(grid);
  const auto iso = static_cast<float>(grid.info.isovalue),
             inside_value = static_cast<float>(grid.info.inside_value);
  const auto blocks = static_cast<int64_t>(grid.corner.size());
  // A point between belongs to the block of its lowest neighbour: no other block has active points.
  std::vector<Child> child(grid.corner.size() * 8);
  par::for_n(blocks, threads, 1, [&](int64_t b) {
    const Vec3i corner = grid.corner[static_cast<size_t>(b)];
    const Window window(grid, index, corner);
    for (int c = 0; c < 8; ++c) {
      Child& out = child[static_cast<size_t>(8 * b + c)];
      const Vec3i first = 8 * Vec3i{c >> 2, c >> 1 & 1, c & 1};
      out.corner = 2 * corner + first;
      for (int s = 0; s < 512; ++s) {
        const Vec3i step = within_block(s);
        const Point p = point_at(window, first + step, iso, inside_value,
                                 std::binary_search(linear.begin(), linear.end(), out.corner + step));
        out.value[static_cast<size_t>(s)] = p.value;
        out.active[static_cast<size_t>(s >> 6)] |= uint64_t{p.active} << (s & 63);
      }
    }
  });
  std::sort(child.begin(), child.end(), [](const Child& a, const Child& b) { return a.corner < b.corner; });

  BlockGrid out;
  out.info = grid.info;
  out.frame = {grid.frame.origin, grid.frame.spacing / 2, 2 * grid.frame.lower,
               2 * grid.frame.points - Vec3i{1, 1, 1}};
  for (const Vec3i& corner : grid.inside)
    for (int c = 0; c < 8; ++c)
      out.inside.push_back(2 * corner + 8 * Vec3i{c >> 2, c >> 1 & 1, c & 1});
  for (const Child& c : child)
    if (c.any_active()) {
      out.corner.push_back(c.corner);
      out.value.insert(out.value.end(), c.value.begin(), c.value.end());
      out.active.insert(out.active.end(), c.active.begin(), c.active.end());
    } else if (c.value[0] > iso) {
      out.inside.push_back(c.corner);
    }
  std::sort(out.inside.begin(), out.inside.end());
  return out;
}

} // namespace molmesh::contour
