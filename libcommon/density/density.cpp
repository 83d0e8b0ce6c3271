// density.cpp — makes the field and the grid frame, then searches the band.
#include "density/density.hpp"
#include "base/error.hpp"
#include "density/culling/block_atoms.hpp"
#include "density/field/margin.hpp"
#include "molecule/bodies.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>

namespace molmesh::density {
namespace {

/// What I2 and the floats of the file ask of the band (field.md §5).
void check_band(const Options& o) {
  const double off = o.tolerance * std::max(1.0, o.isovalue),
               room = std::min(o.band_upper - o.isovalue, o.isovalue - o.band_lower);
  char text[200];
  if (!(o.band_upper <= 1e38)) {
    std::snprintf(text, sizeof text, "the band reaches up to %g, expected at most 1e38: a lower isovalue or band",
                  o.band_upper);
    fail(Status::usage, text, {"isovalue", "band"});
  }
  if (off <= room * (1 + 1e-12))
    return;
  std::snprintf(text, sizeof text,
                "tolerance: found %g, expected at most %g, the band's reach from the isovalue of %g: a wider band "
                "or a larger isovalue would do, too",
                o.tolerance, room / std::max(1.0, o.isovalue), o.isovalue);
  fail(Status::usage, text, {"tolerance", "band", "isovalue"});
}

/// Terms over a block are known to κh²·1e-14 or so, and clusters near it to 1e-6 h (field.md §4).
void check_spacing(const Options& o, double h) {
  constexpr double most = 1e7;
  if (o.decay * h * h <= most)
    return;
  char text[200];
  std::snprintf(text, sizeof text, "the spacing is %g Å, expected at most %g Å at this decay: %s", h,
                std::sqrt(most / o.decay), o.grid_points > 0 ? "a larger grid" : "a smaller spacing");
  fail(Status::usage, text, {o.grid_points > 0 ? "grid" : "spacing", "decay"});
}

/// enough: a margin that suffices.
[[noreturn]] void fail_without_band(const Options& o, double h, double margin, double enough) {
  char text[250];
  int n = std::snprintf(text, sizeof text, "no grid cell reaches the band from %g to %g: the isovalue is too high",
                        o.band_lower, o.band_upper);
  if (h > 0)
    n += std::snprintf(text + n, sizeof text - size_t(n), ", or the spacing of %g Å too large", h);
  if (margin < enough)
    std::snprintf(text + n, sizeof text - size_t(n), ", or the margin of %g Å too small: %.2f Å suffices", margin,
                  enough);
  fail(Status::failed, text);
}

/// Every active value is a number in the file.
void check_values(BandBlocks blocks) {
  for (const BandBlock& b : blocks) {
    BlockValues room;
    const float* const value = active_values(b, room);
    int64_t n = 0;
    for (const uint64_t word : b.active)
      n += std::popcount(word);
    if (!std::all_of(value, value + n, [](float v) { return std::isfinite(v); }))
      fail(Status::usage,
           "next to the surface the field is above 3.4e38, beyond the file's single precision: "
           "expected a smaller spacing, decay or exponent",
           {"spacing", "decay"});
  }
}

} // namespace

void check(const Options& o, double h) {
  check_band(o);
  check_spacing(o, h);
}

SearchOptions band_of(const Options& o) {
  SearchOptions s;
  s.isovalue = o.isovalue;
  s.band_lower = o.band_lower;
  s.band_upper = o.band_upper;
  s.tolerance = o.tolerance;
  s.threads = o.threads;
  return s;
}

void check_field(const Hierarchy& hierarchy, const Options& o) {
  if (!all_have_bodies(hierarchy))
    return check_field(bodies_of(hierarchy).hierarchy, o);
  make_field(hierarchy, o.decay, budget_for(band_of(o)).far, o.threads);
}

Band compute(const Hierarchy& hierarchy, const Options& o, Counts& counts, const BandFinder& find) {
  if (!all_have_bodies(hierarchy))
    return compute(bodies_of(hierarchy).hierarchy, o, counts, find);
  check_band(o);
  SearchOptions s = band_of(o);
  s.full = o.full_search;
  s.atoms = o.atoms;
  s.tile = o.tile;
  s.progress = o.progress;
  Field f = make_field(hierarchy, o.decay, budget_for(s).far, o.threads);
  const Box box = f.bounds();
  const bool derived = o.margin < 0;
  const double sufficient = derived || !o.tile.whole() ? sufficient_margin(f, o.band_lower) : 0;
  const auto enough = [&] { // as messages show it
    return derived ? 0 : std::ceil(100 * (o.tile.whole() ? sufficient_margin(f, o.band_lower) : sufficient)) / 100;
  };
  double margin = o.margin;
  if (derived) {
    // One cell more on each side: then no cell of the band touches the wall either.
    const double h =
        o.grid_points > 0 ? longest_edge(box, sufficient) / static_cast<double>(o.grid_points - 3) : o.spacing;
    margin = sufficient + h;
  }
  counts.margin = margin;
  if (o.grid_points > 0 && !(longest_edge(box, margin) > 0)) // all of it one point
    fail_without_band(o, 0, margin, enough());
  const GridFrame frame = o.grid_points > 0 ? frame_with_points(box, margin, o.grid_points)
                                            : frame_with_spacing(box, margin, o.spacing);
  check_spacing(o, frame.spacing);
  if (!o.tile.whole())
    keep_near(f, searched_box(frame, o.tile));
  bool cut = false;
  const BandSink look = [&](const FieldInfo& info, std::span<const BandBlocks> runs) {
    for (const BandBlocks& blocks : runs) {
      if (f.ln_highest > 88 && !o.any_values)
        check_values(blocks);
      cut = cut || (!derived && wall_cuts_surface(frame, info, blocks));
    }
    if (o.take)
      o.take(info, runs);
  };
  if (o.take)
    s.take = look;
  Band band = find(f, frame, s, counts.search);
  if (const BandBlocks left = band.block; !left.empty()) // without a sink, or with a finder that does not use it
    look(band.info, {&left, 1});
  if (band.active_points == 0 && o.tile.whole())
    fail_without_band(o, frame.spacing, margin, enough());
  if (o.take)
    band.block = {}, band.storage = {};
  band.info.source = hierarchy.source;
  for (const Level& l : hierarchy.level)
    band.info.levels += (band.info.levels.empty() ? "" : " ") + l.name;
  if (cut || (!derived && wall_cuts_surface(frame, band.inside))) {
    char text[128];
    std::snprintf(text, sizeof text,
                  "the grid's wall cuts the surface: a margin of %g Å is too small, %.2f Å suffices", margin,
                  enough());
    fail(Status::failed, text);
  }
  return band;
}

} // namespace molmesh::density
