// contour.cpp — the stages in order, then the mesh put together region by region.
#include "contour/contour.hpp"
#include "contour/complex.hpp"
#include "contour/components.hpp"
#include "contour/detail/at.hpp"
#include "contour/elements.hpp"
#include "contour/leaves.hpp"
#include "contour/relax.hpp"
#include "error.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::contour {

using detail::at;
namespace {

/// Elements of the wanted regions, ordered by their first vertex of the complex, that is along the octree's curve;
/// points in the order in which these elements first use them.
TetMesh assemble(const Elements& elements, const Components& parts, const Options& options) {
  const auto region = [&](int32_t vertex) { return parts.component[at(parts.of_vertex[at(vertex)])].region; };
  const auto wanted = [&](int32_t r) {
    return options.meshed == Options::both || (options.meshed == Options::interior ? r == molecule : r == outside);
  };
  std::vector<int64_t> start(parts.of_vertex.size() + 1, 0);
  for (const Tet& t : elements.tet)
    if (wanted(region(t[0])))
      ++start[at(t[0])];
  const int64_t tets = par::exclusive_scan(start);
  TetMesh mesh;
  mesh.tet.resize(at(tets));
  mesh.region.resize(at(tets));
  for (const Tet& t : elements.tet) {
    const int32_t r = region(t[0]);
    if (!wanted(r))
      continue;
    const size_t slot = at(start[at(t[0])]++);
    mesh.tet[slot] = t;
    mesh.region[slot] = r;
  }
  std::vector<int32_t> number(elements.position.size(), -1);
  for (Tet& t : mesh.tet)
    for (int32_t& v : t) {
      int32_t& n = number[at(v)];
      if (n < 0) {
        n = static_cast<int32_t>(mesh.point.size());
        mesh.point.push_back(elements.position[at(v)]);
      }
      v = n;
    }
  for (size_t i = 0; i < elements.tri.size(); ++i) {
    const auto [behind, front] = elements.tri_sides[i];
    const int32_t a = region(behind), b = region(front);
    const bool kept = elements.boundary[i] == surface ? a != b && (wanted(a) || wanted(b)) : wanted(a);
    if (!kept)
      continue;
    const Tri& t = elements.tri[i];
    mesh.tri.push_back({number[at(t[0])], number[at(t[1])], number[at(t[2])]});
    mesh.boundary.push_back(elements.boundary[i]);
  }
  return mesh;
}

/// Moved grid points that elements without positive volume hang on: themselves, or through the dual vertex of a
/// cell with such a corner; all that are moved where that is none, since a ring may hang on a face point, and that
/// on grid points further on.
std::vector<int32_t> spoiling_vertices(const Complex& complex, const std::vector<int32_t>& spoiled, bool all) {
  std::vector<int32_t> spoiling;
  const auto add = [&](int32_t v) {
    if (complex.moved(v))
      spoiling.push_back(v);
  };
  for (int32_t v : spoiled) {
    add(v);
    const int32_t leaf = complex.leaf_of(v);
    for (int c = 0; leaf >= 0 && c < 8; ++c)
      add(complex.grid_vertex[at(int64_t{8} * leaf + c)]);
  }
  const bool none = spoiling.empty();
  for (int32_t v = 0; (all || none) && v < complex.grid_vertices; ++v)
    add(v);
  par::sort_unique(spoiling, 1);
  if (spoiling.empty())
    fail(Status::failed, "contour: an element of unmoved boxes has no volume");
  return spoiling;
}

/// Validity is proven for cells that are boxes: where a moved grid point spoils it, it goes back. Returns how many
/// did.
int64_t restore_spoiling(Complex& complex, int threads) {
  std::vector<int32_t> spoiled = find_spoiled(complex, threads);
  constexpr int most_rounds = 8; // then all go back: time must be bounded
  int64_t restored = 0;
  for (int round = 0; !spoiled.empty(); ++round) {
    const std::vector<int32_t> spoiling = spoiling_vertices(complex, spoiled, round == most_rounds);
    restored += static_cast<int64_t>(spoiling.size());
    spoiled = spoiled_at(complex, complex.restore(spoiling, threads), threads);
  }
  return restored;
}

void refuse_surface_at_wall(const Complex& complex) {
  if (complex.lattice.cut_allowed())
    return;
  for (int32_t v = 0; v < complex.grid_vertices; ++v) {
    if (!complex.inside(v))
      continue;
    const Vec3i p = complex.point[at(v)], cells = complex.lattice.cells;
    for (int a = 0; a < 3; ++a)
      if (p[a] == 0 || p[a] == cells[a])
        fail(Status::failed, "the surface meets the wall of the box: give hier2density a larger --margin, or ask "
                             "for the cut with --box "
                             "x0,y0,z0,x1,y1,z1");
  }
}

} // namespace

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
  const Octree tree(lattice.cells, stages.select_leaves(lattice, found, refine_options, threads));
  on_phase("dual vertices");
  Complex complex(lattice, tree, found.cells, found.samples, threads);
  refuse_surface_at_wall(complex);
  on_phase("elements");
  const bool on_inside = refine_options.inside || options.drop_below > 0,
             on_outside = with_outside || options.fill_cavities;
  summary.restored_points = restore_spoiling(complex, threads);
  Elements elements = stages.make_elements(complex, on_inside, on_outside, threads);
  on_phase("relaxation");
  summary.relaxed_points = relax(elements, complex.lattice_classes(), threads);
  on_phase("regions");
  RegionOptions region_options;
  region_options.fill_cavities = options.fill_cavities;
  region_options.drop_below = options.drop_below;
  const Components parts = find_components(complex, elements, region_options);
  on_phase("assembly");
  TetMesh mesh = assemble(elements, parts, options);
  if (mesh.tet.empty())
    fail(Status::failed, "the region asked for has no part in the box: nothing to mesh");
  mesh.isovalue = grid.info.isovalue;
  mesh.source = grid.info.source;

  summary.leaves = tree.size();
  summary.surface_cells = static_cast<int64_t>(found.cells.size());
  for (int32_t leaf = 0; leaf < tree.size(); ++leaf)
    summary.split_cells += complex.is_split(leaf);
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
