// hier2density.hpp — options and page of hier2density.
#pragma once
#include "cli/plan.hpp"
#include "cli/run.hpp"
#include "cuda/par/device.hpp"

namespace molmesh {

struct Options : cli::Common, cli::PlanOptions {
  Options() {
    require_device = cuda::require_device;
    machine_limits = true;
  }
  std::optional<double> spacing;
  int64_t grid = 0, elements = 0;
  std::string margin = "auto";
  std::string surface = "gaussian", region = "interior";
  std::optional<double> probe, decay, isovalue;
  double tolerance = 1e-4;
  std::string tile = "1/1";
  std::string band = "0.9,1.1", search = "neighbor", atoms = "bvh";
};

inline void describe(cli::Table& t, Options& o) {
  t.group("grid");
  t.add("--spacing", o.spacing, "grid spacing h").unit("Å").positive().shown_default("0.5");
  t.add("--grid", o.grid, "points along the longest axis, 4 or more, instead of --spacing; 0: use --spacing")
      .within(0, 1 << 29);
  t.add("--elements", o.elements, "spacing for so many elements, if > 0").within(0, 1e9);
  t.add("--region", o.region, "of --elements").one_of({"interior", "exterior", "both"});
  t.add("--margin", o.margin,
        "grid beyond the outermost atom centres, 0 or more; auto: as far as the surface and its band can reach")
      .unit("Å");
  t.group("surface");
  t.add("--surface", o.surface,
        "gaussian: the density's; ses: solvent-excluded, where no probe reaches; sas: "
        "solvent-accessible, of spheres larger by the probe; vdw: van der Waals")
      .one_of({"gaussian", "ses", "sas", "vdw"});
  t.add("--probe", o.probe, "radius of the probe of ses and sas").unit("Å").within(0, 1e3).shown_default("1.4");
  t.group("density");
  t.add("--decay", o.decay, "decay rate of an atom's term; of gaussian alone")
      .unit("Å⁻²")
      .positive()
      .shown_default("1");
  t.add("--isovalue", o.isovalue, "the value of the field at the surface; of gaussian alone")
      .positive()
      .shown_default("1");
  t.add("--band", o.band, "band to keep, in isovalues, 0 < LO < 1 < HI").unit("LO,HI");
  t.add("--tolerance", o.tolerance, "largest error of G in units of max(1, G)").within(1e-6, 1e-2);
  t.group("search");
  t.add("--search", o.search, "neighbor: only near the surface, full: every grid point")
      .one_of({"neighbor", "full"});
  t.add("--atoms", o.atoms, "how contributing atoms are found: bvh: boxes of the hierarchy, kdtree, all")
      .one_of({"bvh", "kdtree", "all"});
  t.add("--tile", o.tile, "slab I of N of the grid alone, for densityjoin --tiles").unit("I/N");
  cli::add_plan_options(t, o);
  t.page.about =
      "Computes the density of a molecular hierarchy on a grid, near the surface alone. The density is the sum "
      "over the outermost groups of (the sum over the members)^P, where an atom of radius r at distance d is "
      "exp(-κ(d² - r²)), κ being the decay rate; the surface is where the density has the isovalue. Every "
      "stored value is within the tolerance of that sum, and every grid cell that the surface crosses is in "
      "the file. With --surface ses, sas or vdw the field is exp(d / 1 Å), where d is the signed distance to "
      "that surface of the atoms' balls, positive inside: groups and exponents have no effect. With --elements "
      "the grid has the spacing of which density2tet's default mesh has nine tenths of so many elements, for "
      "that --region; density2tet --elements takes the rest. A note tells better ways where that grid shows less "
      "than 0.85 of the volume that a grid of 1 Å shows.";
  t.page.examples = {
      {"hier2density --spacing 1 1tii.hier -o 1tii.vdb", "the density at a spacing of 1 Å"},
      {"hier2density --grid 257 1tii.hier -o 1tii.vdb", "257 grid points along the longest axis"},
      {"hier2density --surface ses 1tii.hier -o 1tii.vdb", "the solvent-excluded surface, probe 1.4 Å"},
      {"pdb2hier 1tii.pdb | hier2density --decay 0.5 -o 1tii.vdb", "a softer surface, from a pipe"}};
  t.page.files = {{".hier", "molecular hierarchy, read: formats/hier/HIERv1.md"},
                  {".vdb", "density grid (OpenVDB), written: formats/vdb/VDBv1.md"}};
  t.page.see_also = {"pdb2hier", "density2tet", "density2map"};
}

} // namespace molmesh
