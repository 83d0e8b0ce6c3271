// sizes.hpp — density2tet's --size: cells of a size near the atoms of a selection.
#pragma once
#include "base/error.hpp"
#include "cli/file.hpp"
#include "cli/plan.hpp"
#include "contour/octree/sized_nodes.hpp"
#include "formats/hier/hier.hpp"
#include "formats/pdb/hier_selection.hpp"
#include "molecule/words.hpp"
#include <cstdio>
#include <string>
#include <vector>

namespace molmesh {

/// Å beyond the balls of the selected atoms: the surface lies up to so far from them, but where exponents blur it.
inline constexpr double size_reach = 2;

/// "SELECTION Å", as a rule of pdb2hier is "SELECTION P_R=…". Throws Error(usage) for one of another form, or a
/// size below the grid's spacing, and as select_atoms().
inline std::vector<contour::SizeBall> size_balls(const std::vector<std::string>& sizes, const Hierarchy& h,
                                                 double spacing) {
  std::vector<contour::SizeBall> balls;
  for (const std::string& text : sizes) {
    const std::string where = "--size '" + text + "'";
    const std::string_view all = trimmed(text);
    const size_t blank = all.find_last_of(" \t");
    const std::optional<double> size = decimal(all.substr(blank == std::string_view::npos ? 0 : blank + 1));
    if (blank == std::string_view::npos || !size || !(*size > 0))
      fail(Status::usage, where + ": expected SELECTION Å, such as '//A/45 0.5' or 'around //A/45 8 0.5'");
    if (*size < spacing * (1 - 1e-9)) {
      char fine[32];
      std::snprintf(fine, sizeof fine, "%g", *size);
      fail(Status::usage, where + ": expected at least the grid's spacing, " + cli::length_text(spacing) +
                              ": hier2density --spacing " + fine + " fits");
    }
    const std::vector<uint8_t> chosen = formats::select_atoms(h, std::string(trimmed(all.substr(0, blank))), where);
    for (size_t a = 0; a < chosen.size(); ++a)
      if (chosen[a])
        balls.push_back({h.atom[a].center, h.atom[a].radius + size_reach, *size});
  }
  return balls;
}

} // namespace molmesh
