// tetlabel.hpp — options and page of tetlabel.
#pragma once
#include "tools/options/mesh_input.hpp"

namespace molmesh {

struct Options : cli::Common {
  Options() { keep_input = false; } // a mesh may be labelled in its place
  std::string hierarchy;
  std::string decay = "auto";
  std::vector<std::string> boundary;
  MeshInput mesh;
  bool other_structure = false;
};

inline void describe(cli::Table& t, Options& o) {
  t.add("hierarchy", o.hierarchy, "the structure (.hier) that the mesh was made from").unit("STRUCTURE").required();
  t.group("labels");
  t.add("--decay", o.decay,
        "decay rate of an atom's term (> 0), as hier2density had it; auto: as the mesh says, 1 where it does not")
      .unit("Å⁻²");
  t.add("--boundary", o.boundary,
        "NAME=SELECTION: triangles of the molecular surface that belong to these atoms (gemmi's selection "
        "syntax, or around SELECTION Å) are a boundary of their own in the array `patch`; later ones win, a name "
        "given again adds to it")
      .unit("BOUNDARY");
  t.add("--other-structure", o.other_structure,
        "take a structure whose checksum or number of atoms is not that of the one that the mesh was made from, "
        "as the PDB file of a PQR file's mesh");
  describe_mesh_input(t, o.mesh);
  t.page.about =
      "Gives every triangle of the molecular surface and every tetrahedron of the molecule its domain, chain, "
      "residue "
      "and atom: at each level of the hierarchy the structure with the largest share of the density there, and "
      "that share. A named boundary is a set of triangles for a solver's boundary condition. Boundaries of the "
      "input stay when no new ones are given.";
  t.page.examples = {
      {"tetlabel 1tii.vtu 1tii.hier -o 1tii.labels.vtu", "chain, residue and atom on the whole mesh"},
      {"tetlabel 1tii.vtu 1tii.hier --boundary site=//D/45-60 -o 1tii.labels.vtu",
       "residues 45 to 60 of chain D are the boundary `site`"},
      {"tetlabel 1tii.vtu 1tii.hier --boundary 'near=around //A/45 8.0' -o 1tii.labels.vtu",
       "what lies within 8 Å of residue 45 of chain A is the boundary `near`"}};
  t.page.files = {{".vtu", "mesh (VTK), read and written: formats/vtu/VTUv1.md"},
                  {".msh, .mesh, .vtk", "meshes of other programs, read: formats/mesh/MESH.md"},
                  {".hier", "molecular hierarchy, read: formats/hier/HIERv1.md"}};
  t.page.several = "the mesh comes first, then the .hier";
  t.page.see_also = {"tetsmooth", "tetconvert", "pdb2hier"};
}

} // namespace molmesh
