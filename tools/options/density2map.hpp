// density2map.hpp — options and page of density2map.
#pragma once
#include "cli/run.hpp"

namespace molmesh {

struct Options : cli::Common {
  Options() { chooses_format = true; }
  std::string format = "auto";
};

inline void describe(cli::Table& t, Options& o) {
  t.group("map");
  t.add("--format", o.format,
        "ccp4: CCP4/MRC map, binary; dx: OpenDX, text; auto: by the output's name, ccp4 where it has no ending")
      .unit("FORMAT")
      .one_of({"auto", "ccp4", "dx"});
  t.page.about =
      "Writes the density that hier2density computed as a dense map, for viewers that do not read OpenVDB files: "
      "ChimeraX, PyMOL, VMD, Coot. The map covers the whole grid. Grid points beyond the band around the surface "
      "have one value inside and one outside, and the isosurface is within 0.06 spacings of the surface that "
      "density2tet meshes, which is that of log G.";
  t.page.examples = {{"density2map 1tii.vdb -o 1tii.mrc", "a CCP4/MRC map"},
                     {"density2map 1tii.vdb -o 1tii.dx", "an OpenDX map"},
                     {"hier2density 1tii.hier | density2map >1tii.map", "a CCP4/MRC map from a pipe"}};
  t.page.files = {{".vdb", "density grid (OpenVDB), read: formats/vdb/VDBv1.md"},
                  {".map, .ccp4, .mrc, .dx", "dense map, written: formats/map/MAP.md"}};
  t.page.see_also = {"hier2density", "density2tet"};
}

} // namespace molmesh
