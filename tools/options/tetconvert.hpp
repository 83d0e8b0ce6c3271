// tetconvert.hpp — options and page of tetconvert.
#pragma once
#include "tools/options/mesh_input.hpp"

namespace molmesh {

struct Options : cli::Common {
  Options() {
    uses_threads = false;
    chooses_format = true;
  }
  std::string format = "auto", charges;
  bool straddle = false;
  MeshInput mesh;
  std::vector<std::string> outputs() const override;
};

inline void describe(cli::Table& t, Options& o) {
  t.group("format");
  t.add(
       "--format", o.format,
       "gmsh, gmsh-binary: .msh 4.1; gmsh22: .msh 2.2; medit: .mesh; tetgen: .node, .ele, .face; xdmf: .xdmf, .h5; "
       "mcsf: FEtk's .m; abaqus: .inp; nastran: .bdf; vtu: .vtu; of the molecular surface alone: stl, ply, off; "
       "auto: by the output's name")
      .unit("FORMAT")
      .one_of({"auto", "gmsh", "gmsh-binary", "gmsh22", "medit", "tetgen", "xdmf", "mcsf", "abaqus", "nastran",
               "vtu", "stl", "ply", "off"});
  t.add("--charges", o.charges,
        "the structure (.hier) that the mesh was made from: writes its charges, and the mesh point nearest to "
        "each, beside the "
        "output: X.charges beside X.msh")
      .unit("FILE");
  t.add("--straddle", o.straddle,
        "for solvers with flat elements: points of the molecular surface move along their normals, by at most a "
        "tenth of an edge, so that each triangle lies as much outside of the curved surface as inside");
  describe_mesh_input(t, o.mesh);
  t.page.about =
      "Reads a mesh of any format that is read and writes it in another. Regions, boundaries and named boundaries "
      "become the format's own tags: region 1 is 1, boundary 1 is 11, so that no two have one number. What a "
      "format has "
      "no place for is said on standard error. A format of several files is named by any of them.";
  t.page.examples = {
      {"tetconvert 1tii.vtu -o 1tii.msh", "for Gmsh, with physical groups and their names"},
      {"tetconvert 1tii.vtu -o 1tii.xdmf", "for DOLFINx: writes 1tii.xdmf and 1tii.h5"},
      {"tetconvert --charges X.hier X.vtu -o X.mesh", "for FreeFEM, with X.charges; X.hier is of a PQR file"},
      {"tetconvert 1tii.vtu -o 1tii.stl", "the molecular surface alone"},
      {"tetconvert --scale 10 PART.msh -o part.vtu", "a mesh of Gmsh in nanometres as .vtu in Å"}};
  t.page.files = {{".vtu", "mesh (VTK), read and written: formats/vtu/VTUv1.md"},
                  {".msh, .msh2", "Gmsh 4.1 and 2.2, read and written: formats/gmsh/GMSH.md"},
                  {".mesh", "MEDIT, for FreeFEM and Mmg, read and written: formats/medit/MEDIT.md"},
                  {".vtk", "legacy VTK, read: formats/vtk/VTK.md"},
                  {".inp", "Abaqus, written: formats/abaqus/ABAQUS.md"},
                  {".bdf, .nas", "Nastran, written: formats/nastran/NASTRAN.md"},
                  {".node, .ele, .face", "TetGen, written: formats/tetgen/TETGEN.md"},
                  {".xdmf, .h5", "XDMF and HDF5, written: formats/xdmf/XDMF.md"},
                  {".hier", "molecular hierarchy, read: formats/hier/HIERv1.md"},
                  {".charges", "charges and the mesh points nearest to them, written: formats/charges/CHARGES.md"},
                  {".m", "FEtk's MCSF, written: formats/mcsf/MCSF.md"},
                  {".stl, .ply, .off", "molecular surface, written: formats/surface/SURFACE.md"}};
  t.page.see_also = {"tetsmooth", "tetlabel", "tetstat"};
}

} // namespace molmesh
