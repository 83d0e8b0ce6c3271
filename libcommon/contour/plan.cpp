// plan.cpp — counts leaves; elements, memory and time for each leaf are measured (docs/benchmarks.md, Plans).
#include "contour/plan.hpp"
#include "contour/outer_sphere/outer_sphere.hpp"
#include "contour/surface/ambiguous_cell.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

namespace molmesh::contour {
namespace {

// Elements of a leaf, of a split cell beside those, and edges across it.
constexpr double elements_of_leaf = 15.6, split_inside = 55, split_outside = 40, across_split = 8.5;

// Of a surface's leaves, those that are split: on coarse grids; else there are as many at every spacing.
constexpr double most_split = 0.1;

/// Leaves of a structure over those at 1 Å, all and inside, and all over the active points: the mean of five
/// proteins of 2,300 to 16,000 atoms.
struct Measured {
  double spacing, all, inside, of_active;
};
constexpr Measured measured[] = {
    {0.125, 10.6, 12.0, 0.0707}, {0.25, 4.70, 5.35, 0.138},   {0.375, 3.09, 3.35, 0.224},
    {0.5, 2.18, 2.36, 0.297},    {0.75, 1.333, 1.415, 0.436}, {1, 1, 1, 0.61},
    {1.5, 0.622, 0.565, 0.934},  {2, 0.371, 0.313, 1.076},    {3, 0.153, 0.108, 1.20}};

/// Powers of the spacing between the rows, and beyond them.
double interpolated(double Measured::*x, double spacing) {
  size_t i = 1;
  while (i + 1 < std::size(measured) && measured[i].spacing < spacing)
    ++i;
  const Measured &a = measured[i - 1], &b = measured[i];
  return a.*x * std::pow(spacing / a.spacing, std::log(b.*x / a.*x) / std::log(b.spacing / a.spacing));
}

/// Cells with two pieces of the surface or more.
int64_t count_split(const Surface& surface, float isovalue, int threads) {
  std::array<bool, 256> may_split{}; // by the corners inside
  for (unsigned inside = 0; inside < 256; ++inside) {
    double value[8];
    for (int c = 0; c < 8; ++c)
      value[c] = (inside >> c & 1) != 0 ? 1 : -1;
    const CellTopology t = cell_topology(value);
    may_split[inside] = t.split() || std::any_of(t.diagonal.begin(), t.diagonal.end(),
                                                 [](Diagonal d) { return d != Diagonal::none; });
  }
  return par::reduce(
      std::ssize(surface.cells), threads, int64_t{0},
      [&](int64_t i) {
        const SurfaceCell& cell = surface.cells[i];
        unsigned inside = 0;
        for (int c = 0; c < 8; ++c)
          inside |= unsigned{cell.value[c] > isovalue} << c;
        if (!may_split[inside])
          return int64_t{0};
        double value[8];
        for (int c = 0; c < 8; ++c)
          value[c] = over_isovalue(cell.value[c], isovalue);
        return int64_t{cell_topology(value).split()};
      },
      std::plus<int64_t>());
}

} // namespace

LeafCounter::LeafCounter(const BlockGrid& grid, const Options& options) : options_(options) {
  options_.box = with_sphere(grid, options.box, options.threads);
  finer_ = finer_grid(grid, options_);
  lattice_.emplace(finer_.grid ? *finer_.grid : grid, options_.box, options.meshed != Options::interior,
                   options.threads);
  surface_ = find_surface(*lattice_, options.threads);
  split_ = count_split(surface_, lattice_->isovalue, options.threads);
  refine_ = refine_options(*lattice_, options_, grid.frame.spacing, finer_.halvings);
}

double LeafCounter::volume() const {
  constexpr int across = 4; // samples of a cell
  const float isovalue = lattice_->isovalue;
  const int64_t samples = par::reduce( // beyond an eighth of the cell for each corner inside
      std::ssize(surface_.cells), options_.threads, int64_t{0},
      [&](int64_t i) {
        double log_g[8];
        int64_t n = 0;
        for (int c = 0; c < 8; ++c) {
          const float v = surface_.cells[i].value[c];
          log_g[c] = std::log(std::max(v, std::numeric_limits<float>::min()) / isovalue);
          n -= v > isovalue ? across * across * across / 8 : 0;
        }
        for (int s = 0; s < across * across * across; ++s) {
          const Vec3d place{s % across + 0.5, s / across % across + 0.5, s / (across * across) + 0.5};
          const Vec3d t = place / across;
          double sum = 0;
          for (int c = 0; c < 8; ++c)
            sum += log_g[c] * ((c & 1) != 0 ? t.x : 1 - t.x) * ((c & 2) != 0 ? t.y : 1 - t.y) *
                   ((c & 4) != 0 ? t.z : 1 - t.z);
          n += sum > 0;
        }
        return n;
      },
      std::plus<int64_t>());
  const BlockGrid& grid = lattice_->grid();
  const int64_t points = 512 * std::ssize(grid.inside) +
                         std::count_if(grid.value.begin(), grid.value.end(), [&](float v) { return v > isovalue; });
  return std::pow(grid.frame.spacing, 3) * (double(points) + double(samples) / (across * across * across));
}

Leaves LeafCounter::count() const {
  return count(refine_);
}
Leaves LeafCounter::count(double adapt, int layers) const {
  RefineOptions refine = refine_;
  refine.adapt = adapt * (1 << finer_.halvings);
  refine.layers = layers;
  return count(refine);
}

Leaves LeafCounter::count(const RefineOptions& refine) const {
  const Options& options = options_;
  const Lattice& lattice = *lattice_;
  Leaves leaves;
  leaves.halvings = finer_.halvings;
  LeafList list = select_leaves(lattice, surface_, refine, options.threads);
  leaves.adapt = list.adapt / (1 << finer_.halvings);
  const Octree octree(lattice.cells, std::move(list), options.threads);
  const OctreeView& tree = octree.view();
  struct Found {
    int64_t corners = 0, crossed = 0, beyond = 0; // inside the surface; leaves; beyond an outer sphere
  };
  const Found found = par::reduce(
      tree.size(), options.threads, Found{},
      [&](int64_t i) {
        const auto leaf = static_cast<int32_t>(i);
        const Vec3i p = tree.corner(leaf);
        const int32_t edge = tree.extent(leaf);
        int64_t beyond = 0;
        unsigned inside = 0; // by corner
        for (int c = 0; c < 8; ++c) {
          Vec3i q = p + edge * Vec3i{c & 1, c >> 1 & 1, c >> 2};
          for (int a = 0; a < 3; ++a)
            q[a] = std::min(q[a], lattice.cells[a]);
          inside |= unsigned{lattice.value(q) > lattice.isovalue} << c;
          beyond += options.box.is_sphere() && options.box.outer.height(lattice.position(q)) > 0;
        }
        return Found{std::popcount(inside), inside != 0 && inside != 255, beyond};
      },
      [](const Found& a, const Found& b) {
        return Found{a.corners + b.corners, a.crossed + b.crossed, a.beyond + b.beyond};
      });
  leaves.all = tree.size() - static_cast<double>(found.beyond) / 8;
  leaves.inside = static_cast<double>(found.corners) / 8;
  leaves.surface = static_cast<double>(found.crossed);
  leaves.split = static_cast<double>(split_);
  return leaves;
}

Leaves count_leaves(const BlockGrid& grid, const Options& options) {
  return LeafCounter(grid, options).count();
}

Leaves at_spacing(const Leaves& counted, double from, double to, bool smooth) {
  Leaves l = counted;
  const auto factor = [&](double Measured::*x) {
    return smooth ? (from / to) * (from / to) : interpolated(x, to) / interpolated(x, from);
  };
  l.all *= factor(&Measured::all);
  l.inside *= factor(&Measured::inside);
  l.inside = std::min(l.inside, l.all);
  l.surface *= factor(&Measured::all);
  l.split = std::min(l.split, most_split * l.surface);
  return l;
}

Leaves expected_leaves(double spacing, int64_t active_points) {
  Leaves l;
  l.all = static_cast<double>(active_points) * interpolated(&Measured::of_active, spacing);
  l.inside = 0.49 * l.all * interpolated(&Measured::inside, spacing) / interpolated(&Measured::all, spacing);
  l.surface = 0.4 * l.all;
  l.split = 0.004 * l.all / interpolated(&Measured::all, spacing);
  return l;
}

Plan plan(const Leaves& leaves, int64_t blocks, Options::Meshed meshed) {
  double elements = 0;
  if (meshed != Options::exterior)
    elements += elements_of_leaf * leaves.inside + split_inside * leaves.split;
  if (meshed != Options::interior)
    elements += elements_of_leaf * (leaves.all - leaves.inside) + split_outside * leaves.split;
  Plan p;
  p.elements = std::llround(elements);
  p.points = std::llround(elements / (meshed == Options::both ? 5.6 : 4.6));
  // Split cells are where leaves are small beside larger ones, up to a point.
  const double thin = leaves.surface > 0 ? leaves.split / leaves.surface : 0;
  const double of_box = meshed == Options::interior ? 0 : 1100; // walls
  const double triangles = leaves.surface * (2.6 + std::min(42 * thin, 0.5 + 8 * thin)) + of_box;
  p.triangles = std::llround(triangles);
  p.across = std::llround(across_split * leaves.split);
  const double bytes = 6000 * double(blocks) + 500 * leaves.all + 17.3 * elements + 250 * triangles;
  p.memory = std::llround(9.9e6 + bytes + 0.32 * std::min(bytes, 22e6)); // small meshes fit large pages less well
  const double far = 0.6 + 0.4 * std::min(1., leaves.all / 45'000);      // small meshes stay in the cache
  p.seconds =
      0.008 + far * (2e-6 * leaves.all + 1.6e-7 * elements) + 0.0012 * leaves.split; // some 130 points relaxed
  return p;
}

bool is_sooner_on_device(const Plan& plan, int threads) {
  constexpr double start = 0.15, elements_a_second = 40e6; // measured, with the copy of the mesh to the host
  constexpr double efficiency = 0.6;                       // of the host's threads
  return start + double(plan.elements) / elements_a_second < plan.seconds / std::max(1., efficiency * threads);
}

} // namespace molmesh::contour
