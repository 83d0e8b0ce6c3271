// pqr_test.cpp — the dialects of PQR.
#include "pdb_text.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

namespace {

struct Read {
  std::string listing, element;
  Vec3d center;
  double charge, radius;
};

Read one(const std::string& line, const std::string& name = "x.pqr") {
  const Converted c = convert(line + "\n", {}, name);
  CHECK(c.report.format == "PQR");
  const Atom& a = c.hierarchy.atom.at(0);
  return {listing(c.hierarchy), c.hierarchy.names[a.element], a.center, a.charge, a.radius};
}

} // namespace

TEST_CASE("PQR: fields between blanks, with and without a chain") {
  for (const char* line : {"ATOM      1  N   ALA A   7      10.5  -2.25   3.125  -0.3000 1.8500", // columns
                           "ATOM 1 N ALA A 7 10.5 -2.25 3.125 -0.3 1.85",                         // APBS
                           "ATOM  1 N      ALA A  7   10.50000  -2.25000   3.12500  -0.30000 1.85000"}) {
    INFO(line);
    const Read r = one(line);
    CHECK(r.listing == "A/ALA:7/N");
    CHECK(r.center == Vec3d{10.5, -2.25, 3.125});
    CHECK(r.charge == -0.3);
    CHECK(r.radius == 1.85);
    CHECK(r.element == "N");
  }
  CHECK(one("ATOM      1  N   ALA     7      10.5  -2.25   3.125  -0.3000 1.8500").listing == "_/ALA:7/N");
  CHECK(one("ATOM      1  N   ALA A1007      10.5  -2.25   3.125  -0.3000 1.8500").listing == "A/ALA:1007/N");
  CHECK(one("ATOM      1  N   ALA A  52A     10.5  -2.25   3.125  -0.3000 1.8500").listing == "A/ALA:52A/N");
  CHECK(one("ATOM      1  N   ALA    -3      10.5  -2.25   3.125  -0.3000 1.8500").listing == "_/ALA:-3/N");
}

TEST_CASE("PQR: coordinates that run together stand in the columns of the PDB format") {
  const Read r = one("ATOM      2  CA  ALA     1    1999.9993000.064-900.490  0.0962 1.9080");
  CHECK(r.listing == "_/ALA:1/CA");
  CHECK(r.center == Vec3d{1999.999, 3000.064, -900.49});
  CHECK(r.charge == 0.0962);
  CHECK(r.radius == 1.908);
}

TEST_CASE("PQR: a name beside its residue's, plus signs") {
  CHECK(one("ATOM      2 HD11ALEU A   7      10.500  -2.250   3.125  0.0962 1.9080").listing == "A/LEU:7/HD11");
  CHECK(one("ATOM 1 N ALA A 7 +10.5 -2.25 3.125 +0.3 1.85").charge == 0.3);
}

TEST_CASE("PQR: models as the PDB format has them") {
  const std::string text =
      "MODEL 1\nATOM 1 N ALA A 7 1 0 0 0 1\nENDMDL\nMODEL 2\nATOM 1 N ALA A 7 2 0 0 0 1\nENDMDL\n";
  formats::PdbOptions o;
  CHECK(convert(text, o, "x.pqr").report.other_models == 1);
  o.model = "2";
  CHECK(convert(text, o, "x.pqr").hierarchy.atom[0].center.x == 2);
  o.model = "all";
  CHECK(convert(text, o, "x.pqr").report.atoms == 2);
}

TEST_CASE("PQR: an element behind the radius, as GROMACS and Open Babel write it") {
  for (const char* line : {"ATOM      1  CA  CA  A   7      10.500  -2.250   3.125  0.30  1.85          Ca", // ion
                           "ATOM      1  CA   CA A   7      10.500  -2.250   3.125  0.30000000   1.850 CA  ",
                           "ATOM 1 CA CA A 7 10.5 -2.25 3.125 0.3 1.85 ca"}) {
    INFO(line);
    const Read r = one(line);
    CHECK(r.listing == "A/CA:7/CA");
    CHECK(r.charge == 0.3);
    CHECK(r.radius == 1.85);
    CHECK(r.element == "Ca");
  }
  CHECK(one("ATOM 1 CA LIG A 7 10.5 -2.25 3.125 0.3 1.85 Ca").element == "Ca"); // by the name C
  CHECK(one("ATOM      2  CA  ALA     1    1999.9993000.064-900.490  0.0962 1.9080  C").radius == 1.908);
  CHECK(refusal("ATOM 1 N ALA A 7 10.5 -2.25 3.125 -0.3 1.85 Qq\n", {}, "x.pqr").substr(0, 8) == "x.pqr:1:");
}

TEST_CASE("PQR is told from PDB by contents or name") {
  CHECK(one("ATOM  1 N      ALA A  7   10.50000  -2.25000   3.12500  -0.30000 1.85000", "<stdin>").radius == 1.85);
  CHECK(one("ATOM      1  I   ION     1       0.000   0.000  0.000  1.00  3.00", "<stdin>").radius == 3);
  CHECK(one("ATOM      1  N   ALA A   7      10.500  -2.250   3.125 -0.3000 1.8500", "dir.pdb/x.PQR").radius ==
        1.85);
  formats::PdbOptions o;
  o.format = "pdb";
  CHECK(convert("ATOM      1  N   ALA A   7      10.500  -2.250   3.125 -0.3000 1.8500\n", o, "x.pqr")
            .report.format == "PDB");
}

TEST_CASE("PQR: elements from names") {
  CHECK(one("ATOM 1 CA ALA A 7 0 0 0 0 1").element == "C");
  CHECK(one("ATOM 1 CA CA A 7 0 0 0 0 1").element == "Ca");
  CHECK(one("ATOM 1 ZN ZN2 A 7 0 0 0 0 1").element == "Zn");
  CHECK(one("ATOM 1 1HB ALA A 7 0 0 0 0 1").element == "H");
  CHECK(one("ATOM 1 CL CL- A 7 0 0 0 0 1").element == "Cl");
  CHECK(one("ATOM 1 I ION 1 0 0 0 1 3").element == "I");
  CHECK(one("ATOM 1 123 UNK A 7 0 0 0 0 1").element == "X");
}

TEST_CASE("PQR: an atom of radius 0 keeps its charge, goes without one") {
  const Converted c = convert(
      "ATOM 1 O HO A 7 0 0 0 -0.4 1.5\nATOM 2 H HO A 7 1 0 0 0.4 0\nATOM 3 M HO A 7 1 0 1 0 0\n", {}, "x.pqr");
  CHECK(c.report.atoms == 2);
  CHECK(c.report.no_radius == 1);
  CHECK(c.report.charges_alone == 1);
  CHECK(c.report.charge == 0);
  CHECK(c.text.substr(0, 7) == "hier 2\n");
  CHECK(c.hierarchy.atom[1].radius == 0);
  CHECK(c.hierarchy.atom[1].charge == 0.4);
  CHECK(refusal("ATOM 2 H HO A 7 1 0 0 0.4 0\n", {}, "x.pqr") ==
        "x.pqr: found no atom of a radius > 0 that is kept, expected at least one");
}

TEST_CASE("PQR: charges that are dropped are said") {
  const std::string text = "ATOM 1 OG SER A 7 0 0 0 -0.4 1.5\nATOM 2 HG SER A 7 1 0 0 0.25 0\n"
                           "ATOM 3 O HOH A 8 5 0 0 -0.8 1.5\nATOM 4 NA NA A 9 9 0 0 1 1.8\n";
  formats::PdbOptions o;
  o.hydrogens = false;
  o.select = "(SER,HOH)";
  const Converted c = convert(text, o, "x.pqr");
  REQUIRE(c.report.notes.size() >= 2);
  CHECK(c.report.notes[0].find(", total charge -0.4 e, no whole number") != std::string::npos);
  CHECK(c.report.notes[1] == "dropped atoms: 1 of waters (--waters) with a charge of -0.8 e in all, 1 hydrogens "
                             "(--hydrogens) with a charge "
                             "of 0.25 e in all, 1 outside --select with a charge of 1 e in all");
  CHECK(std::abs(c.report.dropped_charge.all() - 0.45) < 1e-12);
}

TEST_CASE("PQR: a radius below 0 and what is no number are refused") {
  for (const char* line :
       {"ATOM 1 N ALA A 7 0 0 0 0 -1", "ATOM 1 N ALA A 7 0 0 nan 0 1", "ATOM 1 N ALA A 7 0 0 0 inf 1",
        "ATOM 1 N ALA A 7 0 0 0", "ATOM", "ATOM 1 N ALA A x 0 0 0 0 1", "ATOM 1 N ALA A 99999999999 0 0 0 0 1"}) {
    INFO(line);
    CHECK(refusal(std::string("REMARK\n") + line + "\n", {}, "x.pqr").substr(0, 8) == "x.pqr:2:");
  }
  CHECK(refusal("REMARK\n", {}, "x.pqr").substr(0, 8) == "x.pqr:1:");
}

TEST_CASE("PQR: a table of radii replaces the file's own when it is given") {
  formats::PdbOptions o;
  o.own_radii = false;
  const Converted c = convert("ATOM 1 N ALA A 7 0 0 0 -0.3 1.85\n", o, "x.pqr");
  CHECK(c.hierarchy.atom.at(0).radius == 1.55);
  CHECK(c.hierarchy.atom.at(0).charge == -0.3);
}

namespace {

/// Three residues: methane with its hydrogens, what is left without them, an ion.
const char* const methane = "ATOM 1 C CH4 A 1 0 0 0 0 1.9\nATOM 2 H1 CH4 A 1 0.6 0.6 0.6 0 1.4\n"
                            "ATOM 3 H2 CH4 A 1 -0.6 -0.6 0.6 0 1.4\nATOM 4 H3 CH4 A 1 0.6 -0.6 -0.6 0 1.4\n"
                            "ATOM 5 H4 CH4 A 1 -0.6 0.6 -0.6 0 1.4\nATOM 6 NA NA A 2 9 0 0 1 1.8\n";

} // namespace

TEST_CASE("PQR: exponents and weights by the hydrogens, and an ion without a weight") {
  const Converted c = convert(methane, {}, "x.pqr");
  CHECK(c.text.find("\nresidue CH4:1 0.4 0.691\n") != std::string::npos);
  CHECK(c.text.find("\nresidue NA:2 0.4\n") != std::string::npos);
  REQUIRE(c.report.notes.size() == 2);
  CHECK(c.report.notes[1] == "all hydrogens: a body near the molecular surface, P_R 0.4, W_R 0.63 (--surface)");
  formats::PdbOptions o;
  o.hydrogens = false;
  CHECK(convert(methane, o, "x.pqr").text.find("\nresidue CH4:1 0.3\n") != std::string::npos);
  o.own_radii = false; // a file without hydrogens and radii
  CHECK(convert(methane, o, "x.pqr").text.find("\nresidue CH4:1 0.3\n") != std::string::npos);
  o.surface = formats::PdbOptions::Surface::molecular;
  CHECK(convert(methane, o, "x.pqr").text.find("\nresidue CH4:1 0.3\n") != std::string::npos);
}

TEST_CASE("PQR: plain exponents, rules and fewer levels leave version 1") {
  formats::PdbOptions plain, ruled, weighted, none;
  plain.surface = formats::PdbOptions::Surface::plain;
  ruled.rules = {parse_rule("* P_R=0.5", "-r")};
  weighted.rules = {parse_rule("//A/1 W_R=0.5", "-r")};
  none.levels = {};
  CHECK(convert(methane, plain, "x.pqr").text.find("\nresidue CH4:1 0.3\n") != std::string::npos);
  CHECK(convert(methane, ruled, "x.pqr").text.find("\nresidue CH4:1 0.5\n") != std::string::npos);
  for (const formats::PdbOptions& o : {plain, ruled, none})
    CHECK(convert(methane, o, "x.pqr").text.substr(0, 7) == "hier 1\n");
  CHECK(convert(methane, weighted, "x.pqr").text.find("\nresidue CH4:1 0.4 0.5743\n") != std::string::npos);
}
