// distance.cpp — balls, their boundary, the grid around them, and the band brick by brick.
#include "distance/distance.hpp"
#include "base/error.hpp"
#include "density/culling/bricks.hpp"
#include "density/field/margin.hpp"
#include "distance/brick_band.hpp"
#include "par/par.hpp"
#include "par/pool.hpp"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>

namespace molmesh::distance {
namespace {

struct Balls {
  std::vector<Ball> ball;
  density::Box box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}}; ///< of the centres
  double offset = 0; ///< Å: the surface lies so deep in the balls' union
};

Balls balls_of(const Hierarchy& h, const Body& body) {
  Balls b;
  const double more = body.surface == Surface::van_der_waals ? 0 : body.probe;
  for (const Atom& a : h.atom)
    if (a.radius > 0) {
      b.ball.push_back({a.center, a.radius + more});
      for (int axis = 0; axis < 3; ++axis) {
        b.box.lo[axis] = std::min(b.box.lo[axis], a.center[axis]);
        b.box.hi[axis] = std::max(b.box.hi[axis], a.center[axis]);
      }
    }
  if (b.ball.empty())
    fail(Status::failed, "no atom has a radius, expected one at least: there is no surface");
  b.offset = body.surface == Surface::solvent_excluded ? body.probe : 0;
  return b;
}

/// Distance from the box of the centres beyond which all of the grid is below the band, Å.
double sufficient_margin(const Balls& b, double below) {
  double margin = 0;
  for (const Ball& ball : b.ball)
    for (int a = 0; a < 3; ++a) {
      const double reach = ball.radius - b.offset + below;
      margin = std::max({margin, ball.center[a] + reach - b.box.hi[a], b.box.lo[a] + reach - ball.center[a]});
    }
  return margin + 1e-6;
}

[[noreturn]] void fail_without_band(double h, double margin, double enough) {
  char text[250];
  int n = std::snprintf(text, sizeof text, "no grid cell reaches the surface: the spacing of %g Å is too large", h);
  if (margin < enough)
    std::snprintf(text + n, sizeof text - size_t(n), ", or the margin of %g Å too small: %.2f Å suffices", margin,
                  enough);
  fail(Status::failed, text, {"spacing", "margin"});
}

/// Memory of a thread.
struct Worker {
  BrickBand brick;
  par::Arena<float> values = {};
};

/// What a brick adds.
struct Found {
  std::vector<BandBlock> band;
  std::vector<Vec3i> inside;
};

class Search {
public:
  Search(const Balls& b, const density::Options& o, const GridFrame& frame) : o_(o), frame_(frame), balls_(b.ball) {
    const double below = std::log(o.band_lower), above = std::log(o.band_upper);
    // Corners of a band cell are at most a cell's diagonal away from its limits, since distances change by no more.
    const double diagonal = std::sqrt(3.0) * frame.spacing * (1 + 1e-9);
    scale_ = {b.offset, b.offset + length * below, b.offset + length * above, 0};
    wanted_ = {scale_.lower - diagonal, scale_.upper + diagonal};
    boundary_ = boundary_of(balls_, o.threads, o.tile.whole() ? Region{} : region_of(o.tile));
    const double digits = 0.2 * std::min({o.tolerance, o.band_upper - 1, 1 - o.band_lower});
    scale_.dropped_bits = std::clamp(24 + static_cast<int>(std::floor(std::log2(digits))), 0, 20);
  }
  /// take(blocks) for each run of bricks, whose values it may keep if it says so.
  template <class Take>
  void run(Band& band, density::Counts& counts, Take&& take);

private:
  /// What gives a place of the tile its distance is a ball that meets this, or lies on one.
  Region region_of(Tile tile) const {
    const density::BlockRange own = density::blocks_of(frame_, slab_of(frame_, tile));
    const density::Box first = density::points_box(frame_, own.begin, 1),
                       last = density::points_box(frame_, own.end, 1); // a block beyond
    const double reach = std::max(std::abs(wanted_.lowest), std::abs(wanted_.highest)) + 2 * frame_.spacing;
    const Vec3d more = reach * Vec3d{1, 1, 1};
    return {first.lo - more, last.hi + more};
  }

  const density::Options& o_;
  const GridFrame& frame_;
  const UnionOfBalls balls_;
  Boundary boundary_;
  Scale scale_{};
  Wanted wanted_{};
};

template <class Take>
void Search::run(Band& band, density::Counts& counts, Take&& take) {
  const Influence influence(balls_, boundary_, wanted_);
  std::vector<NearBrick> brick =
      bricks_near(influence.places(), frame_, density::blocks_of(frame_, slab_of(frame_, o_.tile)), o_.threads);
  const auto n = static_cast<int64_t>(brick.size());
  constexpr int64_t at_once = 256;
  par::Pool<Worker> workers;
  std::atomic<int64_t> done{0};
  const auto make = [&] { return std::make_unique<Worker>(Worker{BrickBand(influence, frame_, scale_)}); };
  for (int64_t begin = 0; begin < n; begin += at_once) {
    std::vector<Found> found(static_cast<size_t>(std::min(at_once, n - begin)));
    par::for_n(static_cast<int64_t>(found.size()), o_.threads, 1, [&](int64_t i) {
      NearBrick& at = brick[static_cast<size_t>(begin + i)];
      Found& to = found[static_cast<size_t>(i)];
      workers.with(make, [&](Worker& w) { w.brick.find(at, w.values, to.band, to.inside); });
      at.near = {};
      if (o_.progress)
        o_.progress(++done, n);
    });
    std::vector<BandBlocks> runs;
    for (Found& f : found) {
      band.inside.insert(band.inside.end(), f.inside.begin(), f.inside.end());
      if (!f.band.empty())
        runs.push_back(f.band);
    }
    if (take(runs))
      for (const std::unique_ptr<Worker>& w : workers.all())
        w->values.restart();
  }
  counts.search = {};
  for (const std::unique_ptr<Worker>& w : workers.all()) {
    counts.search.blocks_visited += w->brick.cubes;
    counts.search.blocks_evaluated += w->brick.mixed_cubes;
    counts.search.atom_visits += w->brick.visits();
    counts.search.active_points += w->brick.active_points;
    band.info.analyzed_points += w->brick.points;
    for (LargeArray<float>& chunk : w->values.release())
      band.storage.push_back(std::move(chunk));
  }
  band.active_points = counts.search.active_points;
}

} // namespace

Band compute(const Hierarchy& h, const Body& body, const density::Options& o, density::Counts& counts) {
  const Balls balls = balls_of(h, body);
  const bool derived = o.margin < 0;
  const double sufficient = sufficient_margin(balls, -length * std::log(o.band_lower));
  double margin = o.margin;
  if (derived) { // one cell more, so that no cell of the band touches the wall
    const double spacing =
        o.grid_points > 0 ? density::longest_edge(balls.box, sufficient) / static_cast<double>(o.grid_points - 3)
                          : o.spacing;
    margin = sufficient + spacing;
  }
  counts.margin = margin;
  const double enough = derived ? 0 : std::ceil(100 * sufficient) / 100;
  if (o.grid_points > 0 && !(density::longest_edge(balls.box, margin) > 0)) // all of it one point
    fail_without_band(0, margin, enough);
  Band band;
  band.frame = o.grid_points > 0 ? density::frame_with_points(balls.box, margin, o.grid_points)
                                 : density::frame_with_spacing(balls.box, margin, o.spacing);
  band.info.isovalue = 1;
  band.info.decay = 1;
  band.info.band_lower = o.band_lower;
  band.info.band_upper = o.band_upper;
  band.info.tolerance = o.tolerance;
  band.info.inside_value = static_cast<float>(std::max(2.0, o.band_upper));
  band.info.atoms = static_cast<int64_t>(balls.ball.size());
  band.info.source = h.source;
  for (const Level& l : h.level)
    band.info.levels += (band.info.levels.empty() ? "" : " ") + l.name;
  bool cut = false;
  Search(balls, o, band.frame).run(band, counts, [&](std::span<const BandBlocks> runs) {
    for (const BandBlocks& blocks : runs)
      cut = cut || (!derived && wall_cuts_surface(band.frame, band.info, blocks));
    if (o.take) {
      o.take(band.info, runs);
      return true;
    }
    for (const BandBlocks& blocks : runs)
      band.block.insert(band.block.end(), blocks.begin(), blocks.end());
    return false;
  });
  if (band.active_points == 0 && o.tile.whole())
    fail_without_band(band.frame.spacing, margin, enough);
  par::sort(band.inside, o.threads);
  par::sort(band.block, o.threads, [](const BandBlock& a, const BandBlock& b) { return a.corner < b.corner; });
  if (cut || (!derived && wall_cuts_surface(band.frame, band.inside))) {
    char text[128];
    std::snprintf(text, sizeof text,
                  "the grid's wall cuts the surface: a margin of %g Å is too small, %.2f Å suffices", margin,
                  enough);
    fail(Status::failed, text);
  }
  return band;
}

} // namespace molmesh::distance
