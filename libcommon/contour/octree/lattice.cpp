// lattice.cpp — where the walls go, and what lies between them. A wall may cut the molecule, as the cuboid outer
// boundary of section 6 of Liao et al. 2013 cuts the membrane and the filaments.
#include "contour/octree/lattice.hpp"
#include "base/bits.hpp"
#include "base/error.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>

namespace molmesh::contour {
namespace {

constexpr int32_t most_cells = 1 << 20; // a Morton key holds 21 bits an axis

/// How much spacings beyond the grid may change, as a share, for the walls to lie where asked.
constexpr double most_change = 0.3;

/// Where the middle of the grid should lie, in lattice points from the lower wall; `middle`: where it does. A third
/// or two thirds into an octree cell of `half` is as far into its cells of every smaller level. On a corner of
/// large cells, where the middle of a box comes to lie, all cells round it are divided for balance, level after
/// level.
int32_t off_centre(int32_t middle, int32_t half) {
  const int32_t corner = middle / half * half;
  const int32_t third = corner + half / 3, two_thirds = corner + half - half / 3;
  return std::abs(third - middle) < std::abs(two_thirds - middle) ? third : two_thirds;
}

/// Largest level whose cells are no longer than half of `extent` cells; at most 12.
int level_for(double extent) {
  int level = 0;
  while (level < 12 && (4 << level) <= extent)
    ++level;
  return level;
}

/// Cells beside an outer sphere are at most this part of its radius: the volume between it and the mesh's triangles
/// is then some 0.6 % of its own.
constexpr double largest_of_radius = 1. / 8;

struct IndexBox {
  static constexpr int32_t none = 1 << 30; // beyond any index of a grid
  Vec3i lower{none, none, none}, upper{-none, -none, -none};
  bool empty() const { return lower.x > upper.x; }
};
IndexBox both(IndexBox a, const IndexBox& b) {
  for (int axis = 0; axis < 3; ++axis) {
    a.lower[axis] = std::min(a.lower[axis], b.lower[axis]);
    a.upper[axis] = std::max(a.upper[axis], b.upper[axis]);
  }
  return a;
}

/// Grid indices of the cells that the surface crosses.
IndexBox surface_bounds(const BlockGrid& grid, const uint64_t* inside_words, int threads) {
  const auto of_block = [&](int64_t b) {
    IndexBox box;
    uint64_t any = 0;
    for (int x = 0; x < 8; ++x) {
      const auto word = static_cast<size_t>(8 * b + x);
      const uint64_t bits = inside_words[word] & grid.active[word];
      any |= bits;
      if (bits)
        box = both(box, {{x, 0, 0}, {x, 0, 0}});
    }
    if (!any)
      return box;
    uint32_t columns = 0;
    box.lower.y = lowest_bit(any) >> 3;
    for (int y = 0; y < 8; ++y)
      if (const auto row = static_cast<uint32_t>(any >> 8 * y) & 0xFF) {
        box.upper.y = y;
        columns |= row;
      }
    box.lower.z = lowest_bit(columns);
    for (int z = 0; z < 8; ++z)
      box.upper.z = columns >> z & 1 ? z : box.upper.z;
    const Vec3i corner = grid.corner[b];
    return IndexBox{corner + box.lower, corner + box.upper};
  };
  IndexBox box = par::reduce(static_cast<int64_t>(grid.corner.size()), threads, IndexBox{}, of_block, both);
  // Inside points are at least one step within the surface's bounding box.
  box.lower = box.lower - Vec3i{1, 1, 1};
  box.upper = box.upper + Vec3i{1, 1, 1};
  return box;
}

} // namespace

Lattice::Lattice(const BlockGrid& grid, const BoxRequest& request, bool walls, int threads)
    : isovalue(static_cast<float>(grid.info.isovalue)), grid_(grid), index_(grid),
      inside_words_(grid.active.size()) {
  par::for_n(static_cast<int64_t>(inside_words_.size()), threads,
             SetInsideWords{grid.value.data(), isovalue, inside_words_.data()});
  const IndexBox surface = surface_bounds(grid, inside_words_.data(), threads);
  if (surface.empty())
    fail(Status::failed,
         "the density has no surface at isovalue " + std::to_string(grid.info.isovalue) + ": nothing to mesh");
  const GridFrame& frame = grid.frame;
  const Vec3i grid_last = frame.lower + frame.points - Vec3i{1, 1, 1};
  const bool to_grid = request.kind == BoxRequest::tight || (request.kind == BoxRequest::automatic && !walls);
  cut_allowed_ = request.kind == BoxRequest::corners;
  // Of the surface: may end within the grid.
  const bool by_extents = request.kind == BoxRequest::factor || request.kind == BoxRequest::padding;

  Vec3d lower = frame.position(frame.lower), upper = frame.position(grid_last);
  if (request.kind == BoxRequest::sphere) {
    const double reach = (1 + 2 * largest_of_radius) * request.outer.radius; // two of the largest cells beyond it
    for (int a = 0; a < 3; ++a) {
      lower[a] = std::min(lower[a], request.outer.center[a] - reach);
      upper[a] = std::max(upper[a], request.outer.center[a] + reach);
    }
  } else if (request.kind == BoxRequest::corners) {
    lower = request.lower;
    upper = request.upper;
  } else if (!to_grid) {
    const double scale = request.kind == BoxRequest::factor ? request.scale : by_extents ? 1 : 2;
    const Vec3d pad = Vec3d{1, 1, 1} * request.distance;
    const Vec3d centre = 0.5 * (frame.position(surface.lower) + frame.position(surface.upper));
    const Vec3d half = 0.5 * scale * (frame.position(surface.upper) - frame.position(surface.lower)) + pad;
    for (int a = 0; a < 3; ++a) {
      lower[a] = by_extents ? centre[a] - half[a] : std::min(lower[a], centre[a] - half[a]);
      upper[a] = by_extents ? centre[a] + half[a] : std::max(upper[a], centre[a] + half[a]);
    }
  }
  for (int a = 0; a < 3; ++a)
    if (const double low = frame.position(frame.lower)[a], high = frame.position(grid_last)[a];
        !(lower[a] < high && upper[a] > low))
      fail(Status::usage,
           "box: found " + std::to_string(lower[a]) + " to " + std::to_string(upper[a]) + " Å along " + "xyz"[a] +
               ", expected a box that meets the grid, from " + std::to_string(low) + " to " + std::to_string(high),
           {"box"});
  const double h = frame.spacing;
  double least = 1e300;
  for (int a = 0; a < 3; ++a) {
    const double extent = (upper[a] - lower[a]) / h;
    if (!(extent >= 4 * (1 - 1e-9)))
      fail(Status::usage,
           "box: found an extent of " + std::to_string(extent * h) + " Å, expected at least four grid spacings",
           {"box"});
    if (!(extent < most_cells / 2)) {
      char text[160];
      std::snprintf(text, sizeof text,
                    "found a box of %.0f grid spacings along an axis, expected fewer than 524288: a larger spacing "
                    "of the density, or a smaller box",
                    extent);
      fail(Status::usage, text, {"spacing", "box"});
    }
    least = std::min(least, extent);
  }
  top_level = level_for(least);
  while (request.kind == BoxRequest::sphere && top_level > 0 &&
         (1 << top_level) * h > largest_of_radius * request.outer.radius)
    --top_level;
  for (;; --top_level) {
    bool whole = true;
    for (int a = 0; a < 3; ++a)
      whole = plan_axis(a, lower[a], upper[a], frame.lower[a], grid_last[a], request.kind) && whole;
    if (whole || top_level == 0)
      break;
  }
  view_.cells = cells;
  view_.base = base_;
  view_.isovalue = isovalue;
  view_.inside_value = static_cast<float>(grid.info.inside_value);
  view_.index = index_.view();
  view_.grid = grid.value.data();
  view_.active_words = grid.active.data();
  view_.inside_words = inside_words_.data();
  view_.spacing = h;
  view_.grid_first = frame.lower - base_;
  view_.grid_last = grid_last - base_;
  for (size_t a = 0; a < 3; ++a) {
    view_.axis[a] = axis_[a].data();
    for (size_t side = 0; side < 2; ++side) {
      view_.cut[a][side] = cut_[a][side];
      view_.any_cut = view_.any_cut || cut_[a][side].cuts;
    }
  }
}

bool Lattice::plan_axis(int a, double lower, double upper, int32_t first, int32_t last, BoxRequest::Kind kind) {
  const bool round = kind == BoxRequest::sphere, exact = kind != BoxRequest::automatic && !round;
  const double h = grid_.frame.spacing, origin = grid_.frame.origin[a];
  const auto index = [&](double x) { // a wall on a grid plane is on it, whatever rounding makes of its place
    const double i = (x - origin) / h, whole = std::floor(i + 0.5);
    return exact && std::fabs(i - whole) <= 1e-9 ? whole : i;
  };
  const double low = index(lower), high = index(upper);
  const int32_t unit = 1 << top_level;
  // A wall within the grid takes the place of the nearest grid plane.
  auto begin = static_cast<int32_t>(std::floor(exact ? low + 0.5 : low));
  auto end = static_cast<int32_t>(exact ? std::floor(high + 0.5) : std::ceil(high));
  for (int side = 0; side < 2; ++side) {
    const double wall = side ? high : low;
    Cut& cut = cut_[a][side];
    cut.cuts = exact && wall > first && wall < last;
    cut.plane = static_cast<int32_t>(std::floor(wall));
    cut.share = wall - cut.plane;
  }
  // A whole number of the largest cells, so that no layer of small ones lines the walls: spacings beyond the grid
  // change for it. Between two walls that cut the grid nothing can give way.
  const int32_t rest = (end - begin) % unit;
  const int32_t below = std::max(0, first - begin), beyond = below + std::max(0, end - last);
  bool whole = true;
  if (rest != 0 && !exact) {
    begin -= (unit - rest) / 2;
    end += (unit - rest) - (unit - rest) / 2;
  } else if (rest != 0 && beyond > 0) {
    const int32_t change = 2 * rest < unit ? -rest : unit - rest;
    whole = std::abs(change) <= most_change * beyond;
    const auto low_change = static_cast<int32_t>(std::lround(double(change) * below / beyond));
    begin -= low_change;
    end += change - low_change;
  }
  if ((exact || round) && whole && top_level > 0 && begin < first && end > last) {
    const int32_t middle = (first + last) / 2 - begin;
    constexpr int32_t largest_surface_cell = 1 << most_merges; // in steps of these all surface cells stay the same
    const int32_t shift = (off_centre(middle, unit / 2) - middle) / largest_surface_cell * largest_surface_cell;
    const auto gives_way = [](int32_t spacings, double meshed) {
      return std::abs(spacings - meshed) <= most_change * meshed;
    };
    if (round ? begin - shift <= first && end - shift >= last
              : gives_way(first - begin + shift, first - low) && gives_way(end - last - shift, high - last)) {
      begin -= shift;
      end -= shift;
    }
  }
  cells[a] = end - begin;
  base_[a] = begin;
  std::vector<double>& x = axis_[a];
  x.resize(static_cast<size_t>(cells[a]) + 1);
  for (int32_t i = 0; i <= cells[a]; ++i)
    x[i] = origin + h * (begin + i);
  if (!exact || !whole)
    return whole;
  if (begin < first) {
    const double anchor = origin + h * first, step = (anchor - lower) / (first - begin);
    for (int32_t i = begin; i < first; ++i)
      x[i - begin] = anchor - step * (first - i);
  }
  if (end > last) {
    const double anchor = origin + h * last, step = (upper - anchor) / (end - last);
    for (int32_t i = last + 1; i <= end; ++i)
      x[i - begin] = anchor + step * (i - last);
  }
  x.front() = lower; // to the last bit
  x.back() = upper;
  return true;
}

void refuse_surface_at_wall() {
  fail(Status::failed,
       "the surface meets the wall of the box, expected a grid with a larger margin, or a box that is given "
       "by its corners and cuts the surface",
       {"margin", "box"});
}

} // namespace molmesh::contour
