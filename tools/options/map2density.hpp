// map2density.hpp — options and page of map2density.
#pragma once
#include "cli/run.hpp"
#include <optional>

namespace molmesh {

struct Options : cli::Common {
  std::optional<double> level, spacing;
  std::string grid, like;
  double isovalue = 1, decay = 1;
};

inline void describe(cli::Table& t, Options& o) {
  t.group("map");
  t.add("--level", o.level, "contour level: values above it are inside; required, but for level sets (0)")
      .unit("X");
  t.add("--grid", o.grid, "grid of an OpenVDB file, where it has several").unit("NAME");
  t.group("density");
  t.add("--spacing", o.spacing,
        "grid spacing h; by default the map's own, the smallest of three where they differ. Other spacings and "
        "axes are interpolated by cubic convolution")
      .unit("Å")
      .positive()
      .shown_default("the map's own");
  t.add("--like", o.like,
        "a density (.vdb) that the new one shall join: its spacing, lattice, isovalue and decay rate are taken")
      .unit("FILE");
  t.add("--isovalue", o.isovalue, "isovalue of the density, which the level becomes").positive();
  t.add("--decay", o.decay, "decay rate that the density names, so that it joins one of atoms with that rate")
      .unit("Å⁻²")
      .positive();
  t.page.about =
      "Makes the density near the contour of a map (cryo-EM, electrostatics, a level set), so that density2tet and "
      "tetsmooth mesh the body inside it. The density is isovalue·exp(s·(m - level)) of the map's values m: its "
      "logarithm, which those programs interpolate, is the map itself but for the factor s, which gives it the "
      "slope "
      "of 1/Å at half of the surface, about that of atoms. Only the band near the contour is kept. Beyond the "
      "map's "
      "walls is outside; where the contour reaches them the body is closed there, and a note says so.";
  t.page.examples = {
      {"map2density --level 0.025 MAP.map.gz -o map.vdb", "a cryo-EM map at its recommended level"},
      {"map2density --level 0.025 --spacing 1 MAP.map -o map.vdb", "on a grid of 1 Å"},
      {"map2density CLOUD.vdb --grid density --level 0.1 -o cloud.density.vdb", "a fog volume"},
      {"map2density --level 0.025 --like MODEL.vdb MAP.map -o map.vdb",
       "on the lattice of the fitted model's density"},
      {"densityjoin --combine max --piece map.vdb --piece MODEL.vdb -o both.vdb", "with the model in the map"}};
  t.page.files = {
      {".map, .mrc, .ccp4, .dx (with or without .gz), .vdb",
       "maps and OpenVDB grids of other programs, read: formats/map/MAP.md, formats/openvdb/OPENVDB.md"},
      {".vdb", "density grid, written: formats/vdb/VDBv1.md"}};
  t.page.see_also = {"densityjoin", "density2tet", "density2map"};
}

} // namespace molmesh
