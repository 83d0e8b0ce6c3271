// densityjoin.hpp — options and page of densityjoin.
#pragma once
#include "cli/run.hpp"

namespace molmesh {

struct Options : cli::Common {
  std::vector<std::string> piece, tiles;
  std::string combine = "sum";
  std::string band = "auto";
  double unknown = 0.02;
};

inline void describe(cli::Table& t, Options& o) {
  t.group("pieces");
  t.add("--piece", o.piece,
        "a line of a plan, in place of the plan: a .vdb and its places, as 'a.vdb translate=0,0,60'")
      .unit("TEXT");
  t.add("--combine", o.combine,
        "sum: densities add up (equation 6 of the paper), where files know them; max: the larger one, which is the "
        "union of the bodies")
      .unit("HOW")
      .one_of({"sum", "max"});
  t.add("--unknown", o.unknown,
        "with sum: how much of the sum may be missing at a point because a file does not hold it, in isovalues")
      .unit("X")
      .within(0, 0.09);
  t.group("tiles");
  t.add("--tiles", o.tiles,
        "the tiles of one density, all of them in any order, instead of pieces: gives what one run gives")
      .unit("FILE")
      .several_at_once()
      .not_reported();
  t.group("result");
  t.add("--band", o.band,
        "lower and upper limit of the densities to keep, in isovalues; auto: what all pieces know, for sums from "
        "0.9")
      .unit("LO,HI");
  t.page.about =
      "Joins densities of hier2density into one, as the paper assembles a lattice of filaments (its section "
      "6): the pieces, with their copies, stand in a plan, one line each. A piece that is moved by whole "
      "spacings is copied bit for bit. Any other motion resamples it, by a fit of quadratic polynomials to log "
      "G; the error is measured by resampling back, noted, and written into the file. All pieces have one "
      "spacing, isovalue and decay rate. Files hold the density near their surface alone. Sums are right where "
      "the pieces are so far apart that they do not change each other's surface, or where they were computed "
      "with a wide band (hier2density --band 0.01,1.1); else densityjoin refuses, and hierjoin or --combine "
      "max will do. Pieces marked 'subtract' are cut out of all others. Tiles of one density (hier2density "
      "--tile) become the density that one run makes.";
  t.page.examples = {
      {"densityjoin --piece A.vdb --piece 'A.vdb translate=0,0,60' -o two.vdb",
       "a density and a copy 60 Å above it"},
      {"densityjoin LATTICE.join -o lattice.vdb", "by a plan"},
      {"densityjoin --tiles BIG.*.tile -o big.vdb", "the tiles of one density"},
      {"densityjoin --combine max --piece MAP.vdb --piece MODEL.vdb -o both.vdb", "a map and the model in it"},
      {"densityjoin --piece ALL.vdb --piece 'PORE.vdb combine=subtract' -o open.vdb", "one body without another"}};
  t.page.files = {{".join", "plan of pieces, read: formats/plan/PLAN.md"},
                  {".vdb", "density grids (OpenVDB), read and written: formats/vdb/VDBv1.md"}};
  t.page.several = "name several with --piece each";
  t.page.see_also = {"hier2density", "density2tet"};
}

} // namespace molmesh
