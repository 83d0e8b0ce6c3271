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

/// Counts default meshes of one body at one spacing after the other.
class MeshCounter {
public:
  MeshCounter(const Hierarchy& h, const std::optional<distance::Body>& body, const density::Options& d,
              const std::string& region)
      : hierarchy_(h), body_(body), density_(d) {
    density_.tile = {};
    options_.meshed = meshed_of(region);
    options_.threads = d.threads;
  }

  /// The spacing may be coarser than asked for: CountedMesh::spacing is the one that is counted.
  CountedMesh count(double spacing) {
    density_.spacing = spacing;
    const BlockGrid grid = to_block_grid(band(), density_.threads);
    const contour::LeafCounter counter(grid, options_);
    return {grid.frame.spacing, counter.count(), counter.volume()};
  }
  double planned(const CountedMesh& c) const {
    return double(contour::plan(c.leaves, 0, options_.meshed).elements);
  }
  bool fits(const CountedMesh& c, int64_t elements) const {
    return planned(c) <= (planned_share + 0.04) * double(elements);
  }
  /// In steps of 0.005 Å, from the leaves of another spacing near it.
  double spacing_for(const CountedMesh& c, int64_t elements) const {
    const double s = molmesh::spacing_for(c.leaves, c.spacing, options_.meshed, elements);
    if (!(s > 0))
      no_spacing_fits(elements);
    return std::ceil(200 * s) / 200;
  }
  [[noreturn]] static void no_spacing_fits(int64_t elements) {
    fail(Status::usage, "--elements: found " + std::to_string(elements) + ", expected more: no spacing fits");
  }

private:
  Band band() {
    if (!body_)
      return density::plan(hierarchy_, density_).band;
    density_.spacing = density::counted_spacing(density_.spacing, std::ssize(hierarchy_.atom));
    density::Counts counts;
    return distance::compute(hierarchy_, *body_, density_, counts);
  }

  const Hierarchy& hierarchy_;
  const std::optional<distance::Body>& body_;
  density::Options density_;
  contour::Options options_;
};

/// Of whose mesh so many elements are planned: plans are exact near the spacing that is counted.
inline double finest_planned(MeshCounter& counter, CountedMesh counted, int64_t elements) {
  double chosen = 1;
  for (int counts = 1;; ++counts) {
    const double before = chosen;
    chosen = counter.spacing_for(counted, elements);
    if (counts == 4 || std::fabs(std::log(chosen / before)) < 0.1)
      return chosen;
    counted = counter.count(chosen);
  }
}

/// From a spacing on, in steps of 3 %.
inline CountedMesh first_that_fits(MeshCounter& counter, double spacing, int64_t elements) {
  for (;; spacing = std::ceil(200 * 1.03 * spacing) / 200) {
    if (spacing > 20)
      MeshCounter::no_spacing_fits(elements);
    const CountedMesh counted = counter.count(spacing);
    if (counter.fits(counted, elements))
      return counted;
  }
}

// Shares of the volume at 1 Å. Nine tenths are left at 2 to 3 Å of 240 to 2,000 atoms, at 2.9 to 3.9 Å of 2,300
// to 13,000.
constexpr double least_shown = 0.85, well_shown = 0.91;

/// Where a body is a caricature, finer spacings may show more of it in as many elements.
struct FinerMeshes {
  CountedMesh fits;      ///< the finest that does
  CountedMesh coarsened; ///< the finest that fits after tetsmooth --coarsen; spacing 0: none
  CountedMesh finest;    ///< that was counted
};

inline FinerMeshes finer_meshes(MeshCounter& counter, const CountedMesh& fine, const CountedMesh& fitting,
                                int64_t elements, const std::string& region) {
  const double coarsened = region == "interior" ? 0.68 : 0.55; // of the planned elements, at most
  FinerMeshes found{fitting, {}, fitting};
  for (double s = fitting.spacing; found.finest.volume < well_shown * fine.volume && s > 1.06 * fine.spacing;) {
    s = std::round(20 * s / 1.06) / 20;
    const CountedMesh& counted = found.finest = counter.count(s);
    if (counter.fits(counted, elements))
      found.fits = counted;
    if (counted.leaves.halvings == 0 && coarsened * counter.planned(counted) <= double(elements))
      found.coarsened = counted;
  }
  return found;
}

inline std::string better_ways(const MeshCounter& counter, const CountedMesh& fine, const FinerMeshes& found,
                               int64_t elements) {
  char text[200];
  const auto percent = [&](const CountedMesh& c) { return 100 * c.volume / fine.volume; };
  std::snprintf(text, sizeof text, "at %.3g Å the grid shows %.0f %% of the volume that it shows at %.3g Å",
                found.fits.spacing, percent(found.fits), fine.spacing);
  std::string note = text;
  if (found.coarsened.volume > found.fits.volume) {
    std::snprintf(text, sizeof text,
                  "; --spacing %.4g shows %.0f %%, and tetsmooth --coarsen brings it to about %s elements",
                  found.coarsened.spacing, percent(found.coarsened), grouped(elements).c_str());
    note += text;
  }
  if (found.finest.spacing != found.coarsened.spacing) {
    const double enough = counter.planned(found.finest) / planned_share;
    std::snprintf(text, sizeof text, "; --elements %.0f shows 90 %% or more", 1e4 * std::ceil(1e-4 * enough));
    note += text;
  }
  return note;
}

/// The finest spacing, in steps of 0.005 Å, of whose default mesh nine tenths of so many elements are planned. A
/// note tells better ways where the body is a caricature there. Throws Error(usage) where none up to 20 Å has so
/// few, and as density::plan().
inline double spacing_of_elements(const Hierarchy& h, const std::optional<distance::Body>& body,
                                  const density::Options& d, int64_t elements, const std::string& region,
                                  const cli::Run& run) {
  MeshCounter counter(h, body, d, region);
  const CountedMesh fine = counter.count(1);
  const double spacing = finest_planned(counter, fine, elements);
  if (!(spacing > fine.spacing))
    return spacing;
  const CountedMesh fitting = first_that_fits(counter, spacing, elements);
  if (fitting.volume >= least_shown * fine.volume)
    return fitting.spacing;
  const FinerMeshes found = finer_meshes(counter, fine, fitting, elements, region);
  if (found.fits.volume < least_shown * fine.volume)
    run.note(better_ways(counter, fine, found, elements));
  return found.fits.spacing;
}

} // namespace molmesh
