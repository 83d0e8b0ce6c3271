// elements_spacing.hpp — hier2density's --elements: the spacing, and a note where it shows too little of the body.
#pragma once
#include "cli/plan.hpp"
#include "density/plan.hpp"
#include "distance/distance.hpp"
#include "tools/element_limit.hpp"
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

namespace molmesh {

/// The default mesh of a grid: its leaves, and the volume that the grid shows, Å³.
struct CountedMesh {
  double spacing;
  contour::Leaves leaves;
  double volume;
};

/// The finest spacing, in steps of 0.005 Å, of whose default mesh nine tenths of so many elements are planned. A
/// note tells better ways where the body is a caricature there. Throws Error(usage) where none up to 20 Å has so
/// few, and as density::plan().
inline double spacing_of_elements(const Hierarchy& h, const std::optional<distance::Body>& body, density::Options d,
                                  int64_t elements, const std::string& region, const cli::Run& run) {
  // Shares of the volume at 1 Å. Nine tenths are left at 2 to 3 Å of 240 to 2,000 atoms, at 2.9 to 3.9 Å of 2,300
  // to 13,000.
  constexpr double least_shown = 0.85, well_shown = 0.91;
  const double coarsened =
      region == "interior" ? 0.9 : 0.65; // tetsmooth --coarsen leaves, of planned elements, at most
  contour::Options options;
  options.meshed = meshed_of(region);
  options.threads = d.threads;
  d.tile = {};
  const auto band = [&] {
    if (!body)
      return density::plan(h, d).band;
    d.spacing = density::counted_spacing(d.spacing, std::ssize(h.atom));
    density::Counts counts;
    return distance::compute(h, *body, d, counts);
  };
  const auto count = [&](double spacing) {
    d.spacing = spacing;
    const BlockGrid grid = to_block_grid(band(), d.threads);
    const contour::LeafCounter counter(grid, options);
    return CountedMesh{grid.frame.spacing, counter.count(), counter.volume()};
  };
  const auto planned = [&](const CountedMesh& c) {
    return double(contour::plan(c.leaves, 0, options.meshed).elements);
  };
  const auto share = [&](const CountedMesh& c) { return planned_share(c.spacing, c.leaves, options.meshed); };
  const auto fits = [&](const CountedMesh& c) { return planned(c) <= (share(c) + 0.04) * double(elements); };
  const CountedMesh first = count(1);
  CountedMesh counted = first;
  double chosen = 1;
  for (int counts = 1; counts <= 4; ++counts) { // plans are exact near the spacing that is counted
    const double s = spacing_for(counted.leaves, counted.spacing, options.meshed, elements);
    if (!(s > 0))
      fail(Status::usage, "--elements: found " + std::to_string(elements) + ", expected more: no spacing fits");
    const double before = chosen;
    chosen = std::ceil(200 * s) / 200;
    if (std::fabs(std::log(chosen / before)) < 0.1)
      break;
    counted = count(chosen);
  }
  const auto shown = [&](const CountedMesh& c) { return c.volume / first.volume; };
  if (!(chosen > first.spacing))
    return chosen;
  for (counted = count(chosen); !fits(counted); counted = count(chosen))
    if ((chosen = std::ceil(200 * 1.03 * chosen) / 200) > 20)
      fail(Status::usage, "--elements: found " + std::to_string(elements) + ", expected more: no spacing fits");
  CountedMesh best = counted, coarsens{};
  if (shown(best) >= least_shown)
    return chosen;
  for (double s = chosen; shown(counted) < well_shown && s > 1.06 * first.spacing;) {
    s = std::round(20 * s / 1.06) / 20;
    counted = count(s);
    if (fits(counted))
      best = counted;
    if (counted.leaves.halvings == 0 && coarsened * planned(counted) <= double(elements))
      coarsens = counted;
  }
  if (shown(best) >= least_shown)
    return best.spacing;
  char text[200];
  std::snprintf(text, sizeof text, "at %.3g Å the grid shows %.0f %% of the volume that it shows at %.3g Å",
                best.spacing, 100 * shown(best), first.spacing);
  std::string note = text;
  if (coarsens.volume > best.volume) {
    std::snprintf(text, sizeof text,
                  "; --spacing %.4g shows %.0f %%, and tetsmooth --coarsen brings it to about %s elements",
                  coarsens.spacing, 100 * shown(coarsens), grouped(elements).c_str());
    note += text;
  }
  if (counted.spacing != coarsens.spacing) {
    const double enough = planned(counted) / share(counted);
    std::snprintf(text, sizeof text, "; --elements %.0f shows 90 %% or more", 1e4 * std::ceil(1e-4 * enough));
    note += text;
  }
  run.note(note);
  return best.spacing;
}

} // namespace molmesh
