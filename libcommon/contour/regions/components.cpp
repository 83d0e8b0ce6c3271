// components.cpp — connected components on the host's threads; their volumes and regions.
#include "contour/regions/components.hpp"
#include "contour/regions/region_passes.hpp"
#include "par/launcher.hpp"
#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

namespace molmesh::contour {

namespace {

// The first of those of one region has the volume of all; what is outside has none.
void join_touching(std::vector<Component>& part, const std::vector<std::array<int32_t, 2>>& next_to) {
  std::vector<int32_t> first(part.size());
  std::iota(first.begin(), first.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [in, out] : next_to)
      if (part[in].region == part[out].region && first[in] != first[out]) {
        first[in] = first[out] = std::min(first[in], first[out]);
        changed = true;
      }
  }
  for (size_t i = 0; i < part.size(); ++i)
    if (static_cast<size_t>(first[i]) != i && part[i].region != outside) {
      part[first[i]].volume += std::exchange(part[i].volume, 0);
      part[i].joined = true;
    }
}

} // namespace

void assign_regions(std::vector<Component>& part, const std::vector<ComponentSurface>& surfaces,
                    const RegionOptions& options) {
  std::vector<std::array<int32_t, 2>> next_to; // (inside, outside component)
  for (const ComponentSurface& s : surfaces) {
    part[s.behind].volume += s.volume;
    if (s.behind == s.front)
      continue;
    part[s.front].volume -= s.volume;
    next_to.push_back({s.behind, s.front});
  }
  for (Component& c : part) {
    if (!c.inside && c.at_wall)
      c.volume = 0;
    c.region = c.inside ? molecule : c.at_wall ? outside : cavity;
  }
  // A dropped component takes the region round it; of components within each other the outermost decides first.
  std::vector<uint8_t> dropped(part.size(), 0);
  for (size_t i = 0; i < part.size(); ++i)
    if (Component& c = part[i]; c.inside && !c.at_wall && options.drop_below > 0 && c.volume < options.drop_below) {
      dropped[i] = 1;
      c.region = cavity;
    }
  par::sort_unique(next_to, 1);
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [in, out] : next_to) {
      Component &a = part[in], &b = part[out];
      if (!dropped[in])
        continue;
      if (a.region == outside && b.region == cavity)
        b.region = outside, changed = true;
      if (b.region == outside && a.region == cavity)
        a.region = outside, changed = true;
    }
  }
  for (Component& c : part) // what was dropped in one is filled with it
    if (options.fill_cavities && c.region == cavity)
      c.region = molecule;
  join_touching(part, next_to);
}

Components find_components(const ComplexView& c, const Elements& elements, const RegionOptions& options,
                           int threads) {
  par::HostLauncher launcher(threads);
  RegionPasses<par::HostLauncher> passes(launcher, c, elements.view(), options);
  return {std::move(passes.component), std::move(passes.region)};
}

} // namespace molmesh::contour
