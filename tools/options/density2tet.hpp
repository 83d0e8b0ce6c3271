// density2tet.hpp — options and page of density2tet.
#pragma once
#include "cli/plan.hpp"
#include "cli/run.hpp"
#include "cuda/par/device.hpp"

namespace molmesh {

struct Options : cli::Common, cli::PlanOptions {
  Options() {
    require_device = cuda::require_device;
    chooses_mode = true;
  }
  std::string region = "interior", box = "auto", adapt = "auto", cavities = "keep", regions = "molecule", hier;
  double drop_below = 0;
  int64_t elements = 0;
  std::vector<std::string> size;
};

inline void describe(cli::Table& t, Options& o) {
  t.group("mesh");
  t.add("--region", o.region, "what to mesh: interior (the molecule), exterior (up to the box or sphere), both")
      .one_of({"interior", "exterior", "both"});
  t.add("--box", o.box,
        "outer box: auto (interior: the grid; else at least twice the surface's extents), tight (the grid), a "
        "factor of the surface's extents (2x; up to 10 without the x), a distance round the surface in Å (+30), or "
        "x0,y0,z0,x1,y1,z1 in Å, which may cut the molecule; or a sphere: sphere:2x (of the surface's radius "
        "about the middle of its extents), sphere:+30 (round that), sphere:X,Y,Z,RADIUS in Å")
      .unit("BOX");
  t.add("--adapt", o.adapt,
        "auto or 0 to 100: how far the surface may lie from a coarser cell's mean plane, in grid spacings, and "
        "less where chords would cost a small body volume; 0: uniform cells; auto: 0.1, or as many as 0.2 Å are, "
        "at most 0.4; bodies of few spacings get halves or quarters")
      .unit("ERROR");
  t.add("--elements", o.elements, "at most so many tetrahedra, by --adapt and layers of small cells; 0: no limit")
      .within(0, 1e9);
  t.add("--size", o.size,
        "'SELECTION Å': cells near these atoms of --hier are no larger; or 'around SELECTION Å Å'")
      .unit("SIZE");
  t.add("--regions", o.regions,
        "molecule (one region), or a level of the .hier (domain, chain): each of its groups is a region, where its "
        "share of the density is the largest; they meet in labelled faces of equal shares")
      .unit("LEVEL");
  t.add("--hier", o.hier, "hierarchy (.hier) of the density, for --regions and --size").unit("FILE");
  t.group("small parts");
  t.add("--cavities", o.cavities, "closed cavities: region 3, or 1").one_of({"keep", "fill"});
  t.add("--drop-below", o.drop_below,
        "parts of the molecule smaller than this become what is round them; those that the box cuts stay")
      .unit("Å³")
      .within(0, 1e300);
  cli::add_plan_options(t, o);
  t.quantity("margin", "hier2density --margin");
  t.page.about =
      "Meshes the isosurface of a density grid by dual contouring on an octree: the inside of the molecule, "
      "its surroundings up to a box or a sphere, or both in one conforming mesh. The mesh is valid by "
      "construction: positive volumes, every face in one or two tetrahedra, every region's boundary a closed "
      "manifold. Cells are larger where the surface is flat. Regions of tetrahedra are 1 the molecule, 2 "
      "outside and 3 closed cavities; boundaries of triangles are 1 the molecular surface and 2 to 7 the walls "
      "of the box, or 2 the outer sphere. With --regions the groups of a level are regions 4, 5, … in the "
      "order of the .hier, and the faces between two of them have boundaries 8, 9, …; the file has the names "
      "of all. With --elements the mesh has at most so many tetrahedra, and 0.7 of them where the grid has so "
      "many; the summary line says how far the surface is from the isosurface for it. With --size no cell near "
      "the atoms is larger, from the grid's spacing on; sizes above twice the spacing let the surface's cells "
      "be larger there; cells double with the distance from there.";
  t.page.examples = {
      {"density2tet 1tii.vdb -o 1tii.tet.vtu", "the molecule alone"},
      {"density2tet --region both --box 3x 1tii.vdb -o 1tii.tet.vtu",
       "the molecule and its surroundings, in a box three times its extents"},
      {"density2tet --region exterior --box sphere:3x 1tii.vdb -o 1tii.tet.vtu",
       "the surroundings, up to a sphere of three times the molecule's radius"},
      {"density2tet --regions chain --hier 1tii.hier 1tii.vdb -o 1tii.tet.vtu", "each chain a volume of its own"},
      {"density2tet --elements 100000 1tii.vdb -o 1tii.tet.vtu", "the best mesh of at most 100,000 tetrahedra"}};
  t.page.files = {{".vdb", "density grid (OpenVDB), read: formats/vdb/VDBv1.md"},
                  {".hier", "molecular hierarchy, read: formats/hier/HIERv1.md"},
                  {".vtu", "mesh (VTK), written: formats/vtu/VTUv1.md"}};
  t.page.see_also = {"hier2density", "tetsmooth", "tetstat"};
}

} // namespace molmesh
