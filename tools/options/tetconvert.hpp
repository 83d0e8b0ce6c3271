// tetconvert.hpp — options and page of tetconvert.
#pragma once
#include "cli/run.hpp"

namespace molmesh {

struct Options : cli::Common {
  Options() { uses_threads = false; }
  std::string format = "auto";
  std::vector<std::string> outputs() const override;
};

inline void describe(cli::Table& t, Options& o) {
  t.group("format");
  t.add("--format", o.format,
        "gmsh: .msh 4.1; gmsh22: .msh 2.2; medit: .mesh; tetgen: .node, .ele, .face; xdmf: .xdmf, .h5; "
        "mcsf: FEtk's .m; of the molecular surface alone: stl, ply, off; auto: by the output's name")
      .unit("FORMAT")
      .one_of({"auto", "gmsh", "gmsh22", "medit", "tetgen", "xdmf", "mcsf", "stl", "ply", "off"});
  t.page.about =
      "Writes a mesh in the formats of solvers and viewers. Regions, boundaries and named boundaries become the "
      "format's own tags; what a format has no place for is said on standard error. A format of several files is "
      "named by any of them.";
  t.page.examples = {{"tetconvert 1tii.vtu -o 1tii.msh", "for Gmsh, with physical groups and their names"},
                     {"tetconvert 1tii.vtu -o 1tii.xdmf", "for DOLFINx: writes 1tii.xdmf and 1tii.h5"},
                     {"tetconvert 1tii.vtu -o 1tii.stl", "the molecular surface alone"}};
  t.page.files = {{".vtu", "mesh (VTK), read: formats/vtu/VTUv1.md"},
                  {".msh, .msh2", "Gmsh 4.1 and 2.2, written: formats/gmsh/GMSH.md"},
                  {".mesh", "MEDIT, for FreeFEM and Mmg, written: formats/medit/MEDIT.md"},
                  {".node, .ele, .face", "TetGen, written: formats/tetgen/TETGEN.md"},
                  {".xdmf, .h5", "XDMF and HDF5, written: formats/xdmf/XDMF.md"},
                  {".m", "FEtk's MCSF, written: formats/mcsf/MCSF.md"},
                  {".stl, .ply, .off", "molecular surface, written: formats/surface/SURFACE.md"}};
  t.page.see_also = {"tetsmooth", "tetlabel", "tetstat"};
}

} // namespace molmesh
