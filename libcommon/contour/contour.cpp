// contour.cpp — the stages in order.
#include "contour/contour.hpp"
#include "contour/assembly.hpp"
#include "contour/components.hpp"
#include "contour/detail/at.hpp"
#include "contour/leaves.hpp"
#include "contour/relax.hpp"
#include "error.hpp"
#include "improve/isosurface.hpp"
#include "par/par.hpp"

namespace molmesh::contour {

using detail::at;

TetMesh contour(const BlockGrid& grid, const Options& options, Summary& summary,
                const std::function<void(const std::string&)>& on_phase, const Stages& stages) {
  const int threads = options.threads;
  const bool with_outside = options.meshed != Options::interior;
  on_phase("surface cells");
  const Lattice lattice(grid, options.box, with_outside, threads);
  const Surface found = stages.find_surface(lattice, threads);
  on_phase("octree");
  RefineOptions refine_options;
  refine_options.adapt = options.adapt;
  refine_options.inside = options.meshed != Options::exterior;
  refine_options.outside = with_outside;
  const Octree tree(lattice.cells, stages.select_leaves(lattice, found, refine_options, threads), threads);
  // Elements of both sides, whichever is asked for: the surface is to move.
  Dual dual = stages.make_dual({lattice, tree, found, threads}, on_phase);
  const Complex& complex = dual.complex;
  Elements& elements = dual.elements;
  summary.restored_points = dual.restored_points;
  on_phase("relaxation");
  const improve::Isosurface surface(grid, threads);
  summary.relaxed_points = relax(elements, lattice_classes(complex, threads), &surface, threads);
  on_phase("regions");
  RegionOptions region_options;
  region_options.fill_cavities = options.fill_cavities;
  region_options.drop_below = options.drop_below;
  const Components parts = find_components(complex.view, elements, region_options, threads);
  on_phase("assembly");
  TetMesh mesh = assemble(elements, parts, options.meshed, threads);
  if (mesh.tet.empty())
    fail(Status::failed, "the region asked for has no part in the box: nothing to mesh");
  mesh.isovalue = grid.info.isovalue;
  mesh.source = grid.info.source;

  summary.leaves = tree.size();
  summary.surface_cells = static_cast<int64_t>(found.cells.size());
  summary.split_cells = static_cast<int64_t>(
      par::select(tree.size(), threads, [&](int64_t leaf) { return complex.split[at(leaf)] >= 0; }).size());
  summary.face_points = elements.face_points;
  summary.edge_points = elements.edge_points;
  for (const Component& c : parts.component) {
    if (c.inside && c.region == molecule)
      summary.molecule_volumes.push_back(c.volume);
    if (c.inside && c.region != molecule)
      ++summary.dropped_parts;
    if (!c.inside && c.region == cavity)
      summary.cavity_volumes.push_back(c.volume);
    if (!c.inside && c.region == molecule)
      ++summary.filled_cavities;
  }
  return mesh;
}

} // namespace molmesh::contour
