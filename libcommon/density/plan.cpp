// plan.cpp — counts a coarse band; how the surface grows with the resolution is measured on many structures.
#include "density/plan.hpp"
#include "density/sampled_plan.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <span>

namespace molmesh::density {
namespace {

/// ln of (points · h²) and of (blocks · h²), 0 at 1 Å: the mean of four proteins of 2,300 to 12,800 atoms. Coarse
/// grids miss the dents between atoms, and the band has a width.
struct Grown {
  double spacing, active, blocks;
};
constexpr Grown rows[] = {{0.125, 0.44, 0.65},   {0.25, 0.275, 0.55},  {0.375, 0.181, 0.442},
                          {0.5, 0.126, 0.321},   {0.75, 0.054, 0.128}, {1, 0, 0},
                          {1.5, -0.109, -0.135}, {2, -0.213, -0.174},  {3, -0.403, -0.223}};

constexpr double points_of_atom = 24;   // at 1 Å, no more
constexpr double points_of_sphere = 45; // for each Å² of its radius squared
constexpr double largest_radius = 6;    // Å, of beads that stand for groups of atoms
constexpr double points_of_area = points_of_sphere / (4 * std::numbers::pi);
constexpr double points_of_great = 1e7; // of bodies without atoms
constexpr double countable = 3e6;
constexpr double coarsest = 1.5; // Å, where atoms show

/// Between two spacings along ln h, beyond the table as between its last two.
double interpolated(double Grown::*ln, double spacing) {
  size_t i = 1;
  while (i + 1 < std::size(rows) && rows[i].spacing < spacing)
    ++i;
  const Grown &a = rows[i - 1], &b = rows[i];
  return a.*ln + (b.*ln - a.*ln) * std::log(spacing / a.spacing) / std::log(b.spacing / a.spacing);
}

int64_t times(int64_t n, double factor) {
  return std::llround(static_cast<double>(n) * factor);
}

/// Of active points or blocks.
int64_t grown(int64_t n, double Grown::*ln, const GridSize& counted, double to) {
  const double from = counted.spacing;
  double factor = (from / to) * (from / to);
  if (!counted.smooth)
    factor *= std::exp(interpolated(ln, to) - interpolated(ln, from));
  return times(n, factor);
}

/// What the run refuses while it works, as values beyond floats, which great balls have: does a second's work of
/// it, at the grid's wall.
void try_run(const Hierarchy& hierarchy, Options options, const GridSize& size) {
  struct Enough {};
  int64_t blocks = 0;
  options.tile = {1, std::max(1, std::max({size.points.x, size.points.y, size.points.z}) / (4 * tile_layer))};
  options.take = [&](const FieldInfo&, std::span<const BandBlocks> runs) {
    for (const BandBlocks& r : runs)
      blocks += std::ssize(r);
    if (blocks > 5000)
      throw Enough();
  };
  try {
    Counts counts;
    compute(hierarchy, options, counts);
  } catch (const Enough&) {
  }
}

} // namespace

GridSize at_spacing(const GridSize& counted, double spacing) {
  GridSize s = counted;
  if (spacing == counted.spacing)
    return s;
  const double finer = counted.spacing / spacing;
  s.spacing = spacing;
  for (int a = 0; a < 3; ++a)
    s.points[a] = static_cast<int32_t>(std::min(std::round(counted.points[a] * finer), 536870912.0));
  s.active_points = grown(counted.active_points, &Grown::active, counted, spacing);
  s.blocks = grown(counted.blocks, &Grown::blocks, counted, spacing);
  s.inside_blocks = times(counted.inside_blocks, finer * finer * finer);
  return s;
}

Cost cost(const GridSize& size, int64_t atoms) {
  const auto active = static_cast<double>(size.active_points), n = static_cast<double>(atoms);
  const double at_first = 6.3 * std::min(active, 1.5e6) + 137 * std::min(n, 2e4);
  return {std::llround(9.35e6 + at_first + 5.35 * active + 115 * n), 0.0095 + 25e-9 * active + 0.9e-6 * n};
}

GridSize part_of(const Plan& plan, Tile tile) {
  if (tile.whole())
    return plan.size;
  GridFrame frame;
  frame.points = plan.size.points;
  const Slab slab = slab_of(frame, tile);
  const double coarser = double(plan.size.points[slab.axis]) / plan.counted.points[slab.axis];
  const auto is_in = [&](Vec3i corner) {
    const double at = (corner[slab.axis] + 4) * coarser;
    return at >= slab.begin && at < slab.end;
  };
  int64_t active = 0, blocks = 0, inside = 0;
  for (const BandBlock& b : plan.band.block)
    if (is_in(b.corner)) {
      ++blocks;
      for (const uint64_t word : b.active)
        active += std::popcount(word);
    }
  for (const Vec3i& c : plan.band.inside)
    inside += is_in(c);
  const auto share = [](int64_t all, int64_t part, int64_t counted) {
    return counted > 0 ? times(all, double(part) / double(counted)) : 0;
  };
  GridSize s = plan.size;
  s.active_points = share(s.active_points, active, plan.counted.active_points);
  s.blocks = share(s.blocks, blocks, plan.counted.blocks);
  s.inside_blocks = share(s.inside_blocks, inside, plan.counted.inside_blocks);
  return s;
}

namespace {

// Of its surface, Å².
double area_of(const Body& b) {
  using Shape = Body::Shape;
  const double s = b.size, u = norm(b.u), v = b.shape == Shape::slab ? s : norm(b.v);
  constexpr double pi = std::numbers::pi;
  switch (b.shape) {
  case Shape::sphere:
    return 4 * pi * s * s;
  case Shape::capsule:
    return 4 * pi * s * (s + u);
  case Shape::cylinder:
    return 2 * pi * s * (s + 2 * u);
  case Shape::box:
  case Shape::slab:
    return 8 * (s * u + u * v + v * s);
  }
  return 0;
}

double points_of_bodies(const Hierarchy& hierarchy) {
  double n = 0;
  for (const Body& b : hierarchy.body)
    n += points_of_area * area_of(b);
  return n;
}

} // namespace

double most_active_points(const Hierarchy& hierarchy) {
  double n = points_of_bodies(hierarchy);
  for (const Atom& a : hierarchy.atom)
    n += a.radius > largest_radius ? points_of_sphere * a.radius * a.radius : points_of_atom;
  return n;
}

bool of_great_balls(const Hierarchy& hierarchy) {
  const double bodies = points_of_bodies(hierarchy), atoms = most_active_points(hierarchy) - bodies;
  return bodies > points_of_great || atoms > 100 * static_cast<double>(hierarchy.atom.size());
}

namespace {

/// Half the thickness of the thickest body, Å: a grid of this spacing cannot miss it.
double thickest(const Hierarchy& hierarchy) {
  using Shape = Body::Shape;
  double r = 0;
  for (const Atom& a : hierarchy.atom)
    r = std::max(r, a.radius);
  for (const Body& b : hierarchy.body) {
    const double s = b.size, u = norm(b.u), v = norm(b.v);
    r = std::max(r, b.shape == Shape::cylinder || b.shape == Shape::slab ? std::min(s, u)
                    : b.shape == Shape::box                              ? std::min({s, u, v})
                                                                         : s);
  }
  return r;
}

double countable_spacing(double spacing, double most_points, double most_spacing) {
  while (spacing * 2 <= most_spacing && most_points / (spacing * spacing) > countable)
    spacing *= 2;
  return spacing;
}

} // namespace

double counted_spacing(double spacing, int64_t atoms) {
  return countable_spacing(spacing, points_of_atom * double(atoms), coarsest);
}

Plan quick_plan(const Hierarchy& hierarchy, const Options& options) {
  constexpr size_t many = 2'000'000; // all of less is counted in seconds
  constexpr int64_t sampled = 1'500'000;
  if (hierarchy.atom.size() > many)
    if (std::optional<Plan> p = sampled_plan(hierarchy, options, sampled))
      return std::move(*p);
  return plan(hierarchy, options);
}

Plan plan(const Hierarchy& hierarchy, const Options& options) {
  const bool smooth = of_great_balls(hierarchy);
  Options o = options;
  o.progress = {};
  o.take = {};
  o.tile = {};
  Plan p;
  const auto count = [&] {
    Counts counts;
    p.band = compute(hierarchy, o, counts);
    p.counted = {p.band.frame.spacing,
                 p.band.frame.points,
                 p.band.active_points,
                 static_cast<int64_t>(p.band.block.size()),
                 static_cast<int64_t>(p.band.inside.size()),
                 smooth};
    p.margin = counts.margin;
  };
  double spacing = options.spacing;
  if (options.grid_points > 0) { // the spacing that so many points along the longest axis have
    o.grid_points = std::min<int64_t>(options.grid_points, 65);
    o.any_values = o.grid_points < options.grid_points;
    count();
    if (o.grid_points == options.grid_points) {
      p.size = p.counted;
      return p;
    }
    const double walls = options.margin < 0 ? 3 : 1; // points of the longest axis that are no spacing of the box's
    spacing = p.counted.spacing * (static_cast<double>(o.grid_points) - walls) /
              (static_cast<double>(options.grid_points) - walls);
    o.grid_points = 0;
  }
  o.spacing = smooth ? countable_spacing(spacing, most_active_points(hierarchy), thickest(hierarchy))
                     : counted_spacing(spacing, std::ssize(hierarchy.atom));
  o.any_values = o.spacing > spacing;
  count();
  if (o.any_values)
    for (LargeArray<float>& values : p.band.storage)
      for (float& v : values)
        v = std::min(v, std::numeric_limits<float>::max());
  p.size = at_spacing(p.counted, spacing);
  if (smooth && o.any_values)
    try_run(hierarchy, options, p.size);
  return p;
}

} // namespace molmesh::density
