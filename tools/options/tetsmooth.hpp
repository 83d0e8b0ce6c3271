// tetsmooth.hpp — options and page of tetsmooth.
#pragma once
#include "cli/limits.hpp"
#include "cli/plan.hpp"
#include "cuda/par/device.hpp"
#include "optimize/optimize.hpp"
#include "tools/options/mesh_input.hpp"

namespace molmesh {

struct Options : cli::Common, cli::PlanOptions {
  Options() {
    require_device = cuda::require_device;
    keep_input = false; // a mesh may be improved in its place
  }
  std::string density, hier, effort = "good";
  int iterations = 15, parts = 8;
  bool coarsen = false;
  double min_dihedral = 0, max_dihedral = 180; // degrees asked for
  MeshInput mesh;

  optimize::Effort chosen() const {
    return effort == "fast"   ? optimize::Effort::fast
           : effort == "best" ? optimize::Effort::best
                              : optimize::Effort::good;
  }
};

inline void describe(cli::Table& t, Options& o) {
  t.group("improvement");
  t.add("--density", o.density, "density grid (.vdb): surface points are kept on its isosurface").unit("FILE");
  t.add("--hier", o.hier,
        "hierarchy (.hier): names what is nearest to elements that miss the quality; with --density it also keeps "
        "interfaces between domains (density2tet --regions) where their shares are equal")
      .unit("FILE");
  t.add("--effort", o.effort,
        "fast: 15° to 155°, some points off the isosurface; good: 25° to 140°, Q 0.30; best: 28° to 134°, Q 0.35, "
        "but for a few elements")
      .one_of({"fast", "good", "best"});
  t.add("--coarsen", o.coarsen,
        "makes a smaller mesh: edges inside, on walls and (with --density) on the surface contract as far as "
        "curvature, neighboring sizes and quality allow");
  t.add("--iterations", o.iterations, "rounds at most; 0 leaves the mesh as it is").within(0, 1000);
  t.add("--parts", o.parts, "parts (METIS) that the elements are numbered by in the output, one an element at most")
      .within(1, 1000000);
  t.group("quality");
  cli::add_dihedral_limits(t, o.min_dihedral, o.max_dihedral, ", and sought up to 34 and 125");
  describe_mesh_input(t, o.mesh);
  cli::add_plan_options(t, o);
  t.page.about =
      "Improves a tetrahedral mesh by swaps, contractions, moves and splits. It never inverts an element and never "
      "makes the worst one worse. With a density, surface points are put on the isosurface and kept there; "
      "without, they move on the surface of the input. Interfaces between domains are kept like the surface, and "
      "so are the lines where they meet. Regions, boundaries and labels stay. It aims at dihedral angles from 26° "
      "to 138.5° and Q 0.31; narrower limits are aims too, and take longer. A mesh "
      "outside the limits is valid and written all the same, and the exit status is 5.";
  t.page.examples = {
      {"tetsmooth --density 1tii.vdb 1tii.tet.vtu -o 1tii.vtu", "better elements, the surface on the isosurface"},
      {"tetsmooth --min-dihedral 20 --hier 1tii.hier 1tii.tet.vtu -o 1tii.vtu",
       "status 5 below 20°, and what is nearest to the elements that miss it"},
      {"tetsmooth --parts 64 --density 1tii.vdb 1tii.tet.vtu -o 1tii.vtu",
       "elements in 64 parts for a parallel solver"},
      {"tetsmooth --coarsen --density 1tii.vdb 1tii.tet.vtu -o 1tii.vtu",
       "a smaller mesh of the same angles and volume"}};
  t.page.files = {{".vtu", "mesh (VTK), read and written: formats/vtu/VTUv1.md"},
                  {".msh, .mesh, .vtk", "meshes of other programs, read: formats/mesh/MESH.md"},
                  {".vdb", "density grid (OpenVDB), read: formats/vdb/VDBv1.md"},
                  {".hier", "molecular hierarchy, read: formats/hier/HIERv1.md"}};
  t.page.see_also = {"density2tet", "tetstat", "tetlabel", "tetconvert"};
}

} // namespace molmesh
