// pdb_unsaid_test.cpp — what a structure file leaves unsaid or says in too few columns, and that nothing is lost
// silently.
#include "pdb_text.hpp"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

namespace {

std::string first_element(const std::string& text) {
  const Converted c = convert(text);
  return c.hierarchy.names[c.hierarchy.atom[0].element];
}

bool notes(const Converted& c, const std::string& part) {
  return std::any_of(c.report.notes.begin(), c.report.notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

} // namespace

TEST_CASE("PQR in the columns of the PDB format is told by what stands behind the coordinates") {
  const auto format = [](const std::string& tail) {
    return convert("ATOM      1  N   ALA A   7      10.500  -2.250   3.125" + tail + "\n", {}, "<stdin>")
        .report.format;
  };
  CHECK(format("  1.00 20.00           N") == "PDB");
  CHECK(format("  1.00 20.00") == "PDB");
  CHECK(format("  1.00 20.00      SEG1") == "PDB");
  CHECK(format("") == "PDB");
  CHECK(format("   0.185   1.824") == "PQR");
  CHECK(format(" -0.30  1.85") == "PQR");
  CHECK(format("  0.1414 1.8240") == "PQR");
  // The first line that could not be either decides.
  const std::string both = "ATOM      1  N   ALA A   7      10.500  -2.250   3.125  0.30  1.85\n";
  CHECK(convert(both + "ATOM      2  C   ALA A   7      10.500  -2.250   3.125 -0.30  1.85\n").report.format ==
        "PQR");
  // A field that is too wide moves the rest, of PDB too.
  const auto moved = [](const std::string& line) { return convert(line + "\n", {}, "<stdin>"); };
  for (const char* line : {"ATOM      1  N   ALA A10000       1.000   2.000   3.000  1.00 20.00",
                           "ATOM  1000000  N   ALA A   1       1.000   2.000   3.000  1.00 20.00"}) {
    const Converted c = moved(line);
    CHECK(c.report.format == "PDB");
    CHECK(c.hierarchy.atom[0].center == Vec3d{1, 2, 3});
    CHECK(c.hierarchy.atom[0].radius == 1.55);
  }
}

TEST_CASE("ions without an element are not taken for carbon or nitrogen") {
  CHECK(first_element(pdb_atom(" NA", " NA", "A", 1, 1, "  ")) == "Na");
  CHECK(first_element(pdb_atom(" CL", " CL", "A", 1, 1, "  ")) == "Cl");
  CHECK(first_element(pdb_atom("SOD", "SOD", "A", 1, 1, "  ")) == "Na");
  CHECK(first_element(pdb_atom("NA", "SOD", "A", 1, 1, "  ")) == "Na");
  CHECK(first_element(pdb_atom("CA", "CAL", "A", 1, 1, "  ")) == "Ca");
  CHECK(first_element(pdb_atom("NA", "CLA", "A", 1, 1, "  ")) == "N"); // of chlorophyll
  CHECK(first_element(pdb_atom(" CLA", "CLA", "A", 1, 1, "  ")) == "Cl");
  CHECK(first_element(pdb_atom(" POT", "POT", "A", 1, 1, "  ")) == "K");
  CHECK(first_element(pdb_atom(" CAL", "CAL", "A", 1, 1, "  ")) == "Ca");
  CHECK(first_element(pdb_atom(" CD2", "LEU", "A", 1, 1, "  ")) == "C");
  CHECK(notes(convert(pdb_atom(" NA", " NA", "A", 1, 1, "  ")), "taken from the name: 1"));
}

TEST_CASE("amino acids named for their protons hold no metals") {
  for (const char* residue : {"HID", "HSD", "CYX", "ASH", "GLH", "LYN"})
    for (const char* name : {"CA  ", "CD  ", "CE  ", "HG  "}) {
      INFO(residue << ' ' << name);
      CHECK(first_element(pdb_atom(name, residue, "A", 1, 1, "  ")) == std::string(1, name[0]));
    }
}

TEST_CASE("an element may stand in column 77 alone, or have its charge behind it in mmCIF") {
  std::string line = pdb_atom(" A1", "LIG", "A", 1, 1, "C ");
  line.erase(77, 1); // as editors strip blanks
  CHECK(first_element(line) == "C");
  const std::string loop = "data_x\nloop_\n_atom_site.type_symbol\n_atom_site.label_atom_id\n_atom_site.Cartn_x\n"
                           "_atom_site.Cartn_y\n_atom_site.Cartn_z\n";
  CHECK(first_element(loop + "O1- OXT 1 2 3\n") == "O");
  CHECK(first_element(loop + "Fe3+ X 1 2 3\n") == "Fe");
}

TEST_CASE("mmCIF without element symbols: the names tell, counted") {
  const std::string loop =
      "data_x\nloop_\n_atom_site.label_atom_id\n_atom_site.label_comp_id\n_atom_site.Cartn_x\n_"
      "atom_site.Cartn_y\n_atom_site.Cartn_z\n";
  const Converted c = convert(loop + "CA ALA 1 2 3\nCA CA 4 5 6\nFE HEM 7 8 9\n");
  std::string elements;
  for (const Atom& a : c.hierarchy.atom)
    elements += c.hierarchy.names[a.element] + " ";
  CHECK(elements == "C Ca Fe ");
  CHECK(notes(c, "taken from the name: 3"));
}

TEST_CASE("mmCIF: residue numbers are integers of at most nine digits") {
  const std::string loop =
      "data_x\nloop_\n_atom_site.label_atom_id\n_atom_site.auth_seq_id\n_atom_site.label_seq_id\n_"
      "atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n";
  CHECK(convert(loop + "CA 15A 3 1 2 3\nCA ? . 1 2 3\n").report.atoms == 2);
  CHECK(refusal(loop + "CA 15 3 1 2 3\nCA 9999999999 3 1 2 3\n") ==
        "x.pdb:10: found '9999999999' as auth_seq_id, expected an integer");
  CHECK(refusal(loop + "CA 15 x 1 2 3\n") == "x.pdb:9: found 'x' as label_seq_id, expected an integer");
}

TEST_CASE("a serial wider than its columns may move the rest of its line to the right") {
  std::string line = pdb_atom(" CA", "GLY", "A", 7, 12, "C");
  line.replace(6, 5, "123456");
  const Converted c = convert(line);
  CHECK(listing(c.hierarchy) == "A/GLY:7/CA");
  CHECK(c.hierarchy.atom[0].center.x == 12);
  CHECK(notes(c, "wide serial"));
  line = pdb_atom(" CA", "GLY", "A", 7, 12, "C"); // six digits that leave the rest where it belongs
  line.replace(5, 6, "123456");
  CHECK(listing(convert(line).hierarchy) == "A/GLY:7/CA");
}

TEST_CASE("a file that ends within an atom's line is said to") {
  const std::string two = pdb_atom(" N", "GLY", "A", 7, 10, "N") + pdb_atom(" CA", "GLY", "A", 7, 12, "C");
  const size_t begin = two.size() / 2;
  for (const size_t end : {begin + 3, begin + 60, begin + 76}) {
    INFO(end);
    CHECK(notes(convert(two.substr(0, end)), "is it cut off?"));
  }
  for (const size_t end : {begin, two.size() - 1, two.size()})
    CHECK(!notes(convert(two.substr(0, end)), "is it cut off?"));
}

TEST_CASE("residue numbers that are none are counted") {
  std::string line = pdb_atom(" CA", "GLY", "A", 7, 12, "C");
  CHECK(!notes(convert(line), "residue numbers"));
  line.replace(22, 4, "****");
  CHECK(notes(convert(pdb_atom(" N", "GLY", "A", 7, 12, "N") + line), "the first in line 2"));
  line.replace(22, 4, "A000"); // hybrid-36
  CHECK(!notes(convert(line), "residue numbers"));
  for (const char* number : {"a000", "-999"}) // its further half, and what gemmi takes for none
    CHECK(notes(convert(line.replace(22, 4, number)), "residue numbers that are none"));
}

TEST_CASE("atoms of radius 0 stay for their charge, an assembly's missing chains are counted") {
  const std::string ion = "ATOM 1 NA NA 1 0 0 0 1.0 2.0\n";
  CHECK(notes(convert(ion + "ATOM 2 H1 SER 2 5 0 0 0.25 0.0\nATOM 3 H2 SER 2 6 0 0 0.25 0.0\n", {}, "x.pqr"),
              "total charge 1.5 e, no whole number; 2 of radius 0 are charges without a body"));

  formats::PdbOptions o;
  o.assembly = "1";
  const auto remark = [](const char* first_row) {
    return "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n" + std::string(first_row) +
           "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n"
           "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n";
  };
  const std::string atoms = pdb_atom(" CA", "GLY", "A", 1, 1, "C") + pdb_atom(" CA", "GLY", "B", 1, 4, "C") +
                            pdb_atom(" CA", "GLY", "C", 1, 8, "C");
  const Converted c =
      convert(remark("REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n") + atoms, o);
  CHECK(c.report.unassembled == 2);
  CHECK(notes(c, "2 in chains outside assembly 1"));
  CHECK(refusal(remark("REMARK 350   BIOMT1   1  0.000000  0.000000  0.000000        0.00000\n") + atoms, o)
            .find("expected a rotation and a shift") != std::string::npos);
}

TEST_CASE("a letter of alternative locations that no atom has is said") {
  formats::PdbOptions o;
  o.altloc = "B";
  const std::string a = pdb_atom(" CA", "GLY", "A", 1, 1, "C", 'A');
  CHECK(notes(convert(a, o), "no atom has this letter"));
  CHECK(!notes(convert(a + pdb_atom(" CA", "GLY", "A", 1, 2, "C", 'B'), o), "no atom has this letter"));
}
