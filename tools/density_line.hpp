// density_line.hpp — what a density grid is, in words for the line at the end of a run.
#pragma once
#include "base/grouped.hpp"
#include "cli/text.hpp"
#include "grid/active_values.hpp"
#include <sstream>

namespace molmesh {

/// "on 99 × 94 × 75 points, 0.5 Å apart"
inline std::string grid_words(const GridFrame& f) {
  std::ostringstream s;
  s << "on " << grouped(f.points.x) << " × " << grouped(f.points.y) << " × " << grouped(f.points.z) << " points, "
    << f.spacing << " Å apart";
  return s.str();
}

/// "12,345 values kept near the surface"
inline std::string kept_words(int64_t values) {
  return cli::counted(values, "value", "values") + " kept near the surface";
}

/// "on 99 × 94 × 75 points, 0.5 Å apart; 12,345 values kept near the surface, from 0.42 to 3.1"
inline std::string density_line(const BlockGrid& g, int threads) {
  const ActiveValues values = active_values(g, threads);
  std::ostringstream s;
  s.precision(3);
  s << grid_words(g.frame) << "; " << kept_words(values.count) << ", from " << values.least << " to "
    << values.most;
  return s.str();
}

} // namespace molmesh
