// components.hpp — connected components of the inside and the outside, and the region each belongs to.
#pragma once
#include "contour/complex/complex.hpp"
#include "contour/elements/elements.hpp"
#include "contour/regions/region_items.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::contour {

struct Component {
  bool inside = false;
  bool at_wall = false;
  double volume = 0;   ///< Å³, without what is in it; 0 for an outside one that reaches the wall
  int32_t region = 0;  ///< Region
  bool joined = false; ///< to one before it, of the same region now, which has its volume
};

struct Components {
  std::vector<Component> component;     ///< ordered by their first vertex
  LargeArray<uint8_t> region_of_vertex; ///< [vertices of the complex] Region, 0 for dual vertices
};

struct RegionOptions {
  bool fill_cavities = false;
  double drop_below = 0; ///< Å³: smaller inside components become what surrounds them
};

/// Vertices of one side are joined by edges of the complex. Outside components that do not reach a wall are
/// cavities.
Components find_components(const ComplexView& c, const Elements& elements, const RegionOptions& options,
                           int threads);

/// Volumes and regions of components with these surfaces. A filled cavity and what is round it are one component.
void assign_regions(std::vector<Component>& part, const std::vector<ComponentSurface>& surfaces,
                    const RegionOptions& options);

} // namespace molmesh::contour
