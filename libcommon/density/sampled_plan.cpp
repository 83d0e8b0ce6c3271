// sampled_plan.cpp — the band in cubes of the run's own grid, exact there, weighted by the atoms that they hold.
#include "density/sampled_plan.hpp"
#include "density/culling/block_atoms.hpp"
#include "density/field/margin.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace molmesh::density {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int64_t grain = 1 << 16; // atoms
/// Octree cells of more spacings are few; cubes are whole numbers of these.
constexpr int32_t unit = 16;
constexpr int64_t least_cubes = 12, most_cubes = 32;

/// Those atoms, ascending, and the groups that hold any of them.
Hierarchy excerpt(const Hierarchy& h, std::span<const int64_t> atoms) {
  Hierarchy e;
  e.level.resize(h.level.size());
  std::vector<int64_t> child(atoms.begin(), atoms.end()), parent;
  for (const int64_t a : child)
    e.atom.push_back(h.atom[a]);
  for (size_t l = h.level.size(); l-- > 0; child.swap(parent)) {
    const std::vector<Group>& from = h.level[l].group;
    std::vector<Group>& to = e.level[l].group;
    parent.clear();
    for (int64_t i = 0; i < std::ssize(child); ++i) {
      if (parent.empty() || child[i] >= from[parent.back()].end) {
        const auto after =
            std::partition_point(from.begin(), from.end(), [&](const Group& g) { return g.begin <= child[i]; });
        parent.push_back(after - from.begin() - 1);
        const Group& g = from[parent.back()];
        to.push_back({{}, g.exponent, i, i, g.weight});
      }
      to.back().end = i + 1;
    }
  }
  return e;
}

constexpr Box nothing{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};

Box both(const Box& a, const Box& b) {
  return {{std::min(a.lo.x, b.lo.x), std::min(a.lo.y, b.lo.y), std::min(a.lo.z, b.lo.z)},
          {std::max(a.hi.x, b.hi.x), std::max(a.hi.y, b.hi.y), std::max(a.hi.z, b.hi.z)}};
}

Box bounds_of(std::span<const Atom> atoms) {
  Box b = nothing;
  for (const Atom& a : atoms)
    if (a.radius > 0)
      b = both(b, {a.center, a.center});
  return b;
}

Box bounds_of(const Hierarchy& h, int threads) {
  const std::span<const Atom> all(h.atom);
  const int64_t n = std::ssize(h.atom), chunks = (n + grain - 1) / grain;
  return par::reduce(
      chunks, threads, nothing,
      [&](int64_t c) {
        return bounds_of(
            all.subspan(static_cast<size_t>(c * grain), static_cast<size_t>(std::min(grain, n - c * grain))));
      },
      both, 1);
}

bool meet(const Box& a, const Box& b) {
  for (int i = 0; i < 3; ++i)
    if (a.lo[i] > b.hi[i] || a.hi[i] < b.lo[i])
      return false;
  return true;
}

/// [box] the atoms in it, ascending.
std::vector<std::vector<int64_t>> atoms_in(const Hierarchy& h, const std::vector<Box>& boxes, int threads) {
  constexpr int64_t run = 64; // atoms, which are near each other
  const int64_t n = std::ssize(h.atom), chunks = (n + grain - 1) / grain;
  std::vector<std::vector<std::vector<int64_t>>> part(static_cast<size_t>(chunks));
  par::for_n(chunks, threads, 1, [&](int64_t c) {
    part[c].resize(boxes.size());
    const int64_t end = std::min(n, (c + 1) * grain);
    for (int64_t first = c * grain; first < end; first += run) {
      const int64_t last = std::min(end, first + run);
      const Box all =
          bounds_of(std::span(h.atom).subspan(static_cast<size_t>(first), static_cast<size_t>(last - first)));
      for (size_t b = 0; b < boxes.size(); ++b)
        for (int64_t a = first; meet(all, boxes[b]) && a < last; ++a)
          if (h.atom[a].radius > 0 && meet(boxes[b], {h.atom[a].center, h.atom[a].center}))
            part[c][b].push_back(a);
    }
  });
  std::vector<std::vector<int64_t>> all(boxes.size());
  for (size_t b = 0; b < boxes.size(); ++b)
    for (const auto& p : part)
      all[b].insert(all[b].end(), p[b].begin(), p[b].end());
  return all;
}

/// Those that are no deeper behind a face of the box of all.
std::vector<int64_t> atoms_at_faces(const Hierarchy& h, const Box& box, double depth, int threads) {
  std::vector<Box> face(6, box);
  for (int a = 0; a < 3; ++a) {
    face[2 * a].hi[a] = box.lo[a] + depth;
    face[2 * a + 1].lo[a] = box.hi[a] - depth;
  }
  std::vector<int64_t> all;
  for (const std::vector<int64_t>& atoms : atoms_in(h, face, threads))
    all.insert(all.end(), atoms.begin(), atoms.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Å from which on no cluster matters, by atoms that lie evenly in the hierarchy.
double reach_of(const Hierarchy& h, const Options& o, double far_error) {
  constexpr int64_t looked_at = 1000, atoms_of_cluster = 8;
  const int64_t n = std::ssize(h.atom);
  std::vector<int64_t> atoms;
  for (int64_t i = 0; i < looked_at; ++i)
    if (const int64_t a = n * i / looked_at; h.atom[a].radius > 0 && (atoms.empty() || atoms.back() < a))
      atoms.push_back(a);
  if (atoms.empty())
    return infinity;
  const double share = std::min(1.0, double(atoms_of_cluster) * double(looked_at) / double(n));
  return make_field(excerpt(h, atoms), o.decay, share * far_error).farthest_cutoff;
}

/// A cube of the grid, and how often an atom of it is drawn.
struct Cube {
  Vec3i at; ///< of cubes
  int64_t drawn = 0;
};

/// A grid of cubes; each edge is `cells` spacings.
struct Cubes {
  GridFrame frame;
  int32_t cells = unit;
  double reach = 0; ///< Å
  std::vector<Cube> cube;
  int64_t draws = 0;

  double edge() const { return cells * frame.spacing; }
  Vec3i at(Vec3d p) const {
    const Vec3d x = (p - frame.origin) / edge();
    return {static_cast<int32_t>(std::floor(x.x)), static_cast<int32_t>(std::floor(x.y)),
            static_cast<int32_t>(std::floor(x.z))};
  }
  Box box(const Cube& c) const {
    const Vec3d low = frame.origin + edge() * to_double(c.at);
    return {low, low + edge() * Vec3d{1, 1, 1}};
  }
  /// With what reaches into it.
  Box wide(const Cube& c) const {
    const Box b = box(c);
    return {b.lo - reach * Vec3d{1, 1, 1}, b.hi + reach * Vec3d{1, 1, 1}};
  }
  void draw(Vec3d p) {
    ++draws;
    const Vec3i drawn = at(p);
    const auto same = std::find_if(cube.begin(), cube.end(), [&](const Cube& c) { return c.at == drawn; });
    ++(same != cube.end() ? *same : cube.emplace_back(Cube{drawn})).drawn;
  }
};

/// Draws atoms until their cubes, and what reaches there, hold so many.
void draw_cubes(const Hierarchy& h, int64_t atoms, Cubes& cubes) {
  constexpr double golden = 0.6180339887498949; // its multiples lie evenly, however many there are
  constexpr int64_t stride = 61;
  const int64_t n = std::ssize(h.atom);
  double held = 0;
  for (int64_t i = 0; i < most_cubes && (i < least_cubes || held < double(atoms)); ++i) {
    const double place = std::fmod((double(i) + 0.5) * golden, 1.0);
    const Vec3d p = h.atom[std::min(n - 1, static_cast<int64_t>(place * double(n)))].center;
    const size_t before = cubes.cube.size();
    cubes.draw(p);
    if (cubes.cube.size() == before)
      continue;
    const Box wide = cubes.wide(cubes.cube.back());
    for (int64_t a = 0; a < n; a += stride)
      held += meet(wide, {h.atom[a].center, h.atom[a].center}) ? double(stride) : 0;
  }
}

int64_t active_in(const BandBlock& b) {
  int64_t n = 0;
  for (const uint64_t word : b.active)
    n += std::popcount(word);
  return n;
}

} // namespace

std::optional<Plan> sampled_plan(const Hierarchy& h, const Options& o, int64_t atoms) {
  if (!h.body.empty() || of_great_balls(h) || o.margin >= 0 || !o.tile.whole())
    return {};
  const SearchOptions s = band_of(o);
  const double far = budget_for(s).far;
  Cubes cubes;
  cubes.reach = reach_of(h, o, far);
  if (!std::isfinite(cubes.reach))
    return {};

  // The grid around all of it: its margin is that of the atoms near its faces.
  const Box box = bounds_of(h, o.threads);
  const double sufficient = sufficient_margin(
      make_field(excerpt(h, atoms_at_faces(h, box, cubes.reach, o.threads)), o.decay, far, o.threads),
      o.band_lower);
  Plan p;
  double spacing = o.spacing;
  if (o.grid_points > 0)
    spacing = longest_edge(box, sufficient) / static_cast<double>(o.grid_points - 3);
  p.margin = sufficient + spacing;
  const GridFrame frame = o.grid_points > 0 ? frame_with_points(box, p.margin, o.grid_points)
                                            : frame_with_spacing(box, p.margin, spacing);
  check(o, frame.spacing);
  const double counted = counted_spacing(frame.spacing, atoms);
  cubes.frame = frame_with_spacing(box, sufficient + counted, counted);
  cubes.cells = unit * static_cast<int32_t>(std::max(2.0, std::ceil(4 * cubes.reach / (unit * counted))));
  draw_cubes(h, atoms, cubes);

  std::vector<Box> wide;
  for (const Cube& c : cubes.cube)
    wide.push_back(cubes.wide(c));
  const std::vector<std::vector<int64_t>> lists = atoms_in(h, wide, o.threads);
  double active = 0, blocks = 0, inside = 0;
  for (size_t c = 0; c < cubes.cube.size(); ++c) {
    const Cube& cube = cubes.cube[c];
    const auto own = std::count_if(lists[c].begin(), lists[c].end(),
                                   [&](int64_t a) { return cubes.at(h.atom[a].center) == cube.at; });
    PlanSample sample;
    sample.weight =
        double(h.atom.size()) / double(cubes.draws) * double(cube.drawn) / double(std::max<int64_t>(1, own));
    const Field f = make_field(excerpt(h, lists[c]), o.decay, far, o.threads);
    if (f.ln_highest > 88)
      return {};
    GridFrame grid = cubes.frame;
    grid.origin = sample.low = cubes.box(cube).lo;
    sample.high = cubes.box(cube).hi;
    grid.lower = {0, 0, 0};
    grid.points = (cubes.cells + 1) * Vec3i{1, 1, 1};
    SearchCounts counts;
    sample.band = find_band(f, grid, s, counts);
    const auto is_own = [&](Vec3i corner) { return std::max({corner.x, corner.y, corner.z}) < cubes.cells; };
    for (const BandBlock& b : sample.band.block)
      if (is_own(b.corner)) {
        blocks += sample.weight;
        active += sample.weight * double(active_in(b));
      }
    for (const Vec3i& corner : sample.band.inside)
      inside += sample.weight * is_own(corner);
    p.sample.push_back(std::move(sample));
  }
  if (!(active > 0))
    return {};
  p.counted = {counted, cubes.frame.points, std::llround(active), std::llround(blocks), std::llround(inside),
               false};
  p.size = at_spacing(p.counted, frame.spacing);
  p.size.points = frame.points;
  return p;
}

} // namespace molmesh::density
