// components.hpp — connected parts of the inside and the outside, and the region each belongs to (design §3).
#pragma once
#include "contour/complex.hpp"
#include "contour/elements.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::contour {

struct Component {
  bool inside = false;
  bool at_wall = false;
  double volume = 0;  ///< Å³, enclosed by its own surface; 0 for an outside part that reaches the wall
  int32_t region = 0; ///< Region
};

struct Components {
  std::vector<Component> component; ///< ordered by their first vertex
  LargeArray<int32_t> of_vertex;    ///< [vertices of the complex] -1 for dual vertices
};

struct RegionOptions {
  bool fill_cavities = false;
  double drop_below = 0; ///< Å³: smaller inside parts become what surrounds them
};

/// Parts of one side are joined by edges of the complex. Outside parts that do not reach a wall are cavities.
Components find_components(const ComplexView& c, const Elements& elements, const RegionOptions& options,
                           int threads);

} // namespace molmesh::contour
