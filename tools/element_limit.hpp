// element_limit.hpp — density2tet's --elements: the mesh that fits, or the spacing that would.
#pragma once
#include "base/grouped.hpp"
#include "cli/run.hpp"
#include "cli/text.hpp"
#include "contour/fit.hpp"
#include "contour/surface_distance/surface_error.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

namespace molmesh {

/// Of a --region.
inline contour::Options::Meshed meshed_of(const std::string& region) {
  return region == "interior"   ? contour::Options::interior
         : region == "exterior" ? contour::Options::exterior
                                : contour::Options::both;
}

/// The share of a limit that a mesh is planned to have: some are larger than their plan.
constexpr double planned_share = 0.9;

/// The finest spacing, in steps of 3 %, at which that share of `most` elements is planned with the default
/// tolerance, from those at a spacing of h; 0: none up to 20 Å.
inline double spacing_for(const contour::Leaves& leaves, double h, contour::Options::Meshed meshed, int64_t most) {
  for (double s = 0.02; s < 20; s *= 1.03)
    if (double(contour::plan(contour::at_spacing(leaves, h, s), 0, meshed).elements) <=
        planned_share * double(most))
      return s;
  return 0;
}

/// "hier2density --elements 100000 --region both makes a grid that fits". Its spacing is told there: this grid does
/// not show from which one on cells are halved, which are more.
inline std::string fitting_grid(const BlockGrid& grid, contour::Options options, int64_t most) {
  options.adapt = {};
  options.layers = 1;
  if (!(spacing_for(contour::count_leaves(grid, options), grid.frame.spacing, options.meshed, most) > 0))
    return "no spacing fits";
  return "hier2density --elements " + std::to_string(most) +
         (options.meshed == contour::Options::both       ? " --region both"
          : options.meshed == contour::Options::exterior ? " --region exterior"
                                                         : "") +
         " makes a grid that fits";
}

[[noreturn]] inline void refuse_elements(const BlockGrid& grid, const contour::Options& options, int64_t most,
                                         const contour::Fit& least) {
  fail(Status::usage,
       "elements: found " + std::to_string(most) + ", expected at least about " +
           std::to_string(std::llround(least.elements)) + " for this surface at a spacing of " +
           cli::length_text(grid.frame.spacing) + ": " + fitting_grid(grid, options, most) +
           "; tetsmooth --coarsen leaves about half of a default mesh",
       {"elements"});
}

/// Of the octree that fitted_mesh() tries first. Throws Error(usage) where no mesh of the grid has so few elements.
inline contour::Fit planned_fit(const BlockGrid& grid, const contour::Options& options, int64_t most) {
  const contour::LeafCounter counter(grid, options);
  const contour::Fit f = contour::fit(counter, grid, options.meshed, double(most) / contour::usual_ratio);
  if (f.coarsest && contour::least_ratio * f.elements > double(most))
    refuse_elements(grid, options, most, f);
  return f;
}

/// make: as contour::fitted_mesh. cost: in surface distance, for the summary line. Throws as planned_fit().
inline TetMesh limited_mesh(const contour::LeafCounter& counter, const BlockGrid& grid,
                            const contour::Options& options, int64_t most, cli::Run& run, std::string& cost,
                            const std::function<TetMesh(const contour::Options&)>& make) {
  contour::Fit fit;
  TetMesh mesh = contour::fitted_mesh(counter, grid, options, most, make, fit);
  if (mesh.tet.empty())
    refuse_elements(grid, options, most, fit);
  run.phase("surface distance");
  const contour::SurfaceError error = contour::surface_error(mesh, grid, options.threads);
  run.counts["layers"] = fit.fineness.layers;
  run.counts["surface_error"] = cli::Value{{"worst", error.worst}, {"rms", error.rms}};
  if (fit.finest && 10 * std::ssize(mesh.tet) < 7 * most)
    run.note("this grid has " + grouped(std::ssize(mesh.tet)) +
             " elements at the most: " + fitting_grid(grid, options, most));
  char text[96];
  std::snprintf(text, sizeof text, "surface off by %.2g Å at the most, %.2g Å rms, ", error.worst, error.rms);
  cost = text;
  return mesh;
}

} // namespace molmesh
