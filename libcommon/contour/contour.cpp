// contour.cpp — the stages of contour() in order.
#include "contour/contour.hpp"
#include "base/error.hpp"
#include "contour/outer_sphere/cut_to_sphere.hpp"
#include "contour/outer_sphere/outer_sphere.hpp"
#include "contour/small_bodies/finer_grid.hpp"

namespace molmesh::contour {

TetMesh contour(const BlockGrid& grid, const Options& asked, Summary& summary,
                const std::function<void(const std::string&)>& on_phase, Stages& stages) {
  Options options = asked;
  options.box = with_sphere(grid, asked.box, asked.threads);
  const bool with_outside = options.meshed != Options::interior;
  on_phase("surface cells");
  const FinerGrid finer = finer_grid(grid, options);
  summary.halvings = finer.halvings;
  const Lattice lattice(finer.grid ? *finer.grid : grid, options.box, with_outside, options.threads);
  const struct ReleaseGrid {
    Stages& stages;
    ~ReleaseGrid() { stages.release_grid(); }
  } before_the_grid_is_gone{stages};
  stages.find_surface(lattice);
  on_phase("octree");
  summary.adapt = options.adapt.value_or(default_adapt(grid.frame.spacing));
  stages.select_leaves(refine_options(lattice, options, grid.frame.spacing, finer.halvings));
  stages.make_dual(options.unmeshed_side(), on_phase);
  on_phase("relaxation");
  stages.relax();
  on_phase("regions");
  const std::vector<Component> parts = stages.find_regions({options.fill_cavities, options.drop_below});
  on_phase("assembly");
  TetMesh mesh = stages.assemble(options.meshed);
  if (mesh.tet.empty())
    fail(Status::failed,
         "the region asked for has no part in the box" +
             std::string(options.drop_below > 0 ? ", or all of it is smaller than drop-below" : "") +
             ": nothing to mesh",
         options.drop_below > 0 ? std::vector<std::string>{"drop-below"} : std::vector<std::string>{});
  if (options.box.is_sphere()) {
    on_phase("sphere");
    cut_to_sphere(mesh, options.box.outer, options.threads);
  }
  mesh.isovalue = grid.info.isovalue;
  mesh.decay = grid.info.decay;
  mesh.source = grid.info.source;
  mesh.atoms = grid.info.atoms;

  stages.count(summary);
  for (const Component& c : parts) {
    if (c.region == molecule && !c.joined)
      summary.molecule_volumes.push_back(c.volume);
    if (c.inside && c.region != molecule)
      ++summary.dropped_parts;
    if (c.region == cavity && !c.joined)
      summary.cavity_volumes.push_back(c.volume);
    if (!c.inside && c.region == molecule)
      ++summary.filled_cavities;
  }
  return mesh;
}

TetMesh contour(const BlockGrid& grid, const Options& options, Summary& summary,
                const std::function<void(const std::string&)>& on_phase) {
  HostStages stages(options.threads);
  return contour(grid, options, summary, on_phase, stages);
}

} // namespace molmesh::contour
