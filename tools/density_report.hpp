// density_report.hpp — what a density holds and what its search did, for the run report.
#pragma once
#include "cli/run.hpp"
#include "density/density.hpp"
#include "formats/vdb/leaves.hpp"

namespace molmesh {

inline void report(cli::Run& r, const Band& band, const formats::Leaves& leaves, const density::Counts& counts) {
  const Vec3i n = band.frame.points;
  r.counts["atoms"] = band.info.atoms;
  r.counts["grid_points"] = std::vector{n.x, n.y, n.z};
  const Vec3d first = band.frame.position(band.frame.lower);
  r.counts["origin"] = std::vector{first.x, first.y, first.z};
  r.counts["spacing"] = band.frame.spacing;
  r.counts["margin"] = counts.margin;
  r.counts["analyzed_points"] = band.info.analyzed_points;
  r.counts["k_A"] = double(band.info.analyzed_points) / (double(n.x) * n.y * n.z);
  r.counts["active_points"] = counts.search.active_points;
  r.counts["blocks"] = leaves.size();
  r.counts["inside_blocks"] = band.inside.size();
  r.counts["blocks_visited"] = counts.search.blocks_visited;
  r.counts["blocks_evaluated"] = counts.search.blocks_evaluated;
  r.counts["group_visits"] = counts.search.group_visits;
  r.counts["atom_visits"] = counts.search.atom_visits;
}

} // namespace molmesh
