// region_passes.hpp — connected components and the region of each vertex, pass by pass, over a launcher.
#pragma once
#include "contour/regions/components.hpp"
#include "contour/regions/region_items.hpp"
#include "par/passes.hpp"
#include <algorithm>
#include <vector>

namespace molmesh::contour {

template <par::Launcher Launcher>
class RegionPasses {
  template <class T>
  using Array = typename Launcher::template Array<T>;

public:
  /// region: [vertices of the complex] Region, 0 for dual vertices
  RegionPasses(Launcher& m, const ComplexView& c, const ElementsView& e, const RegionOptions& options) {
    const int64_t vertices = c.vertices();
    part_ = m.template array<int32_t>(vertices);
    label_components(m, c);
    const auto surfaces = par::gather<ComponentSurface>(
        m, "component surfaces", (e.tris + ComponentSurfaces::run - 1) / ComponentSurfaces::run,
        ComponentSurfaces{e, part_.data(), c.lattice});
    assign_regions(component, par::downloaded<ComponentSurface>(m, surfaces.array, surfaces.n), options);
    std::vector<uint8_t> of_part;
    for (const Component& part : component)
      of_part.push_back(static_cast<uint8_t>(part.region));
    const auto region_of = m.upload(of_part.data(), static_cast<int64_t>(of_part.size()));
    region = m.template array<uint8_t>(vertices);
    m.for_n("set regions", vertices, SetRegions{part_.data(), region_of.data(), region.data()},
            {double(vertices) * 5});
    part_ = {};
  }
  std::vector<Component> component;
  Array<uint8_t> region;

private:
  /// component without volumes and regions.
  void label_components(Launcher& m, const ComplexView& c) {
    const int64_t vertices = c.vertices();
    auto parent = m.template array<uint32_t>(vertices);
    const Sets sets{parent.data()};
    m.for_n("start sets", vertices, StartSets{parent.data()}, {double(vertices) * 4});
    m.for_n("join leaves", c.tree.leaves, JoinLeaves{c, sets}, {double(c.tree.leaves) * 37});
    const auto start =
        par::gather<ComponentStart>(m, "components", c.grid_vertices, GatherComponents{c, parent.data()});
    auto at_wall = m.filled(start.n, uint8_t{0});
    m.for_n("number components", start.n, NumberComponents{start.data(), part_.data()});
    m.for_n("label components", vertices, LabelComponents{c, sets, part_.data(), at_wall.data()},
            {double(vertices) * 12 + double(c.grid_vertices) * 12});
    const std::vector<uint8_t> walls = par::downloaded<uint8_t>(m, at_wall, start.n);
    size_t i = 0;
    for (const ComponentStart& s : par::downloaded<ComponentStart>(m, start.array, start.n))
      component.push_back({s.inside != 0, walls[i++] != 0, 0, 0});
  }
  Array<int32_t> part_; ///< [vertices of the complex] -1 for dual vertices
};

} // namespace molmesh::contour
