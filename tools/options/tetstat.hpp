// tetstat.hpp — options and page of tetstat.
#pragma once
#include "cli/limits.hpp"
#include "tools/options/mesh_input.hpp"

namespace molmesh {

struct Options : cli::Common {
  bool json = false, crossings = false, bodies = false;
  std::string compare, hierarchy;
  double min_dihedral = 0, max_dihedral = 180; // degrees
  MeshInput mesh;
};

inline void describe(cli::Table& t, Options& o) {
  t.group("report");
  t.add("--json", o.json, "one JSON object instead of text (formats/tetstat/TETSTATv1.md)");
  t.add("--crossings", o.crossings, "also look for surface triangles that cross (exact)");
  t.add("--bodies", o.bodies,
        "list the bodies, cavities and boundaries of a valid mesh with volume, area and centre, in place of the "
        "report");
  t.add(
       "--hier", o.hierarchy,
       "the structure (.hier) that the mesh was made from: --bodies names the residues round each body and cavity, "
       "those with the most triangles first. A mesh of tetlabel has them by itself")
      .unit("FILE");
  t.add("--compare", o.compare, "a mesh to compare with: --compare BEFORE AFTER; the status is AFTER's")
      .unit("FILE");
  t.group("quality");
  cli::add_dihedral_limits(t, o.min_dihedral, o.max_dihedral);
  describe_mesh_input(t, o.mesh);
  t.page.about =
      "Says whether a tetrahedral mesh is valid and how good its elements are: orientation by an exact predicate; "
      "every "
      "face, edge and vertex of every region's boundary; volumes and areas; dihedral angles, Joe-Liu's Q and η, "
      "edge ratio. Any tetrahedral .vtu will do. The exit status is 5 when the mesh is invalid or has angles "
      "outside those asked for.";
  t.page.examples = {{"tetstat 1tii.vtu", "the report on one screen"},
                     {"tetstat --min-dihedral 20 --json 1tii.vtu -o 1tii.json", "for programs; status 5 below 20°"},
                     {"tetstat --bodies 1tii.labels.vtu", "volume of each cavity, area of each named boundary"},
                     {"tetstat --bodies --hier 1tii.hier 1tii.vtu", "and the residues that line each cavity"},
                     {"tetstat --compare 1tii.tet.vtu 1tii.vtu", "two meshes side by side"}};
  t.page.files = {{".vtu, .msh, .mesh, .vtk", "mesh, read: formats/mesh/MESH.md"},
                  {".hier", "molecular hierarchy, read: formats/hier/HIERv1.md"},
                  {".txt", "the report, written"},
                  {".json", "the report for programs, written: formats/tetstat/TETSTATv1.md"}};
  t.page.see_also = {"tetsmooth", "density2tet"};
}

} // namespace molmesh
