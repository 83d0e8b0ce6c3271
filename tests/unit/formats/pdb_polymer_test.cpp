// pdb_polymer_test.cpp — modified residues stay where ligands go.
#include "pdb_text.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

namespace {

/// N, CA and C on a line, so that the next residue's N at x + 4.1 is bonded.
std::string amino(const std::string& name, int number, double x, bool hetero, const std::string& alpha = "CA",
                  const std::string& chain = "A") {
  const char* record = hetero ? "HETATM" : "ATOM  ";
  return pdb_atom(" N", name, chain, number, x, "N", ' ', 1, ' ', record) +
         pdb_atom(" " + alpha, name, chain, number, x + 1.4, "C", ' ', 1, ' ', record) +
         pdb_atom(" C", name, chain, number, x + 2.8, "C", ' ', 1, ' ', record);
}

std::string hetero(const std::string& atom, const std::string& residue, int number, double x,
                   const std::string& element) {
  return pdb_atom(atom, residue, "A", number, x, element, ' ', 1, ' ', "HETATM");
}

/// What --hetatm drop keeps, by residue; and what it says.
struct Dropped {
  std::string residues, notes;
};

Dropped without_hetero(const std::string& text) {
  formats::PdbOptions o;
  o.hetatm = false;
  const Converted c = convert(text, o);
  Dropped d;
  for (const Group& residue : c.hierarchy.level.at(1).group)
    d.residues += (d.residues.empty() ? "" : " ") + residue.name;
  for (const std::string& note : c.report.notes)
    d.notes += note + "\n";
  return d;
}

} // namespace

TEST_CASE("a modified residue that is bonded into a chain stays with it, a ligand beside it goes by name") {
  const std::string text = amino("ALA", 1, 0, false) + amino("MSE", 2, 4.1, true) + amino("SEP", 3, 8.2, true) +
                           amino("GLY", 4, 12.3, false) + amino("GLY", 5, 30, true) +
                           hetero("CA", "CA", 6, 50, "Ca") + hetero("CA", "CA", 7, 60, "Ca");
  const Dropped d = without_hetero(text);
  CHECK(d.residues == "ALA:1 MSE:2 SEP:3 GLY:4");
  CHECK(d.notes == "PDB: kept 12 atoms in 4 residues and 1 chain\n"
                   "modified residues, links of the chains: //A/2(MSE), //A/3(SEP)\n"
                   "dropped atoms: 5 of hetero groups (--hetatm: //A/5(GLY), CA 2)\n");
  const Converted all = convert(text);
  CHECK(all.report.ligands.at("CA").residues == 2);
  CHECK(all.report.ligands.at("GLY").atoms == 3);
  CHECK(all.report.ligands.size() == 2);
  CHECK(all.report.modified.size() == 2);
}

TEST_CASE("an inhibitor of several residues goes as a whole, though these are bonded to each other") {
  CHECK(without_hetero(amino("ALA", 1, 0, false) + amino("DAR", 2, 20, true) + amino("2EP", 3, 24.1, true) +
                       amino("KTH", 4, 28.2, true))
            .residues == "ALA:1");
}

TEST_CASE("a link needs bonds on both sides, or one and a backbone") {
  CHECK(without_hetero(amino("ALA", 1, 0, false) + amino("CRO", 2, 4.1, true, "C9") + amino("GLY", 4, 8.2, false))
            .residues == "ALA:1 CRO:2 GLY:4");
  CHECK(without_hetero(hetero("C1", "MYR", 900, -1.3, "C") + amino("ALA", 1, 0, false)).residues == "ALA:1");
  CHECK(without_hetero(hetero("C", "ACE", 0, -1.3, "C") + amino("ALA", 1, 0, false)).residues == "ACE:0 ALA:1");
  // A sugar on a side chain.
  CHECK(without_hetero(amino("ASN", 1, 0, false) + pdb_atom(" ND2", "ASN", "A", 1, 9, "N") +
                       hetero("C1", "NAG", 2, 10.4, "C"))
            .residues == "ASN:1");
}

TEST_CASE("modified residues behind all chains are found by their numbers") {
  CHECK(without_hetero(amino("ALA", 1, 0, false) + amino("GLY", 3, 8.2, false) +
                       amino("ALA", 1, 0, false, "CA", "B") + amino("MSE", 2, 4.1, true))
            .residues == "ALA:1 GLY:3 MSE:2 ALA:1");
}

TEST_CASE("nucleotides are joined by phosphates") {
  CHECK(without_hetero(pdb_atom(" O3'", "DG", "A", 1, 0, "O") + hetero(" P", "5CM", 2, 1.6, "P") +
                       hetero(" C1'", "5CM", 2, 5, "C") + hetero("MG", "MG", 3, 9, "Mg"))
            .residues == "DG:1 5CM:2");
}

TEST_CASE("the sequence of the file says what no bond tells") {
  const std::string loose = amino("ALA", 1, 0, false) + amino("MSE", 9, 20, true);
  const std::string sequence = "SEQRES   1 A    2  ALA MSE\n";
  CHECK(without_hetero(loose + "TER\n").residues == "ALA:1");
  CHECK(without_hetero(sequence + loose).residues == "ALA:1");
  CHECK(without_hetero(sequence + loose + "TER\n").residues == "ALA:1 MSE:9");
  const std::string head =
      "data_x\nloop_\n_entity.id\n_entity.type\n1 polymer\n2 non-polymer\nloop_\n_struct_asym.id\n"
      "_struct_asym.entity_id\nA 1\nB 2\nloop_\n_atom_site.group_PDB\n_atom_site.id\n_atom_site.type_symbol\n"
      "_atom_site.label_atom_id\n_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.label_entity_id\n"
      "_atom_site.label_seq_id\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n_atom_site.auth_seq_"
      "id\n"
      "_atom_site.auth_asym_id\n";
  CHECK(without_hetero(head + "ATOM 1 C CA ALA A 1 1 0 0 0 1 A\nHETATM 2 C CA MSE A 1 2 20 0 0 9 A\n"
                              "HETATM 3 C CA GLY B 2 . 40 0 0 10 A\n")
            .residues == "ALA:1 MSE:9");
}

TEST_CASE("the residues of the most atoms are named first, twenty kinds of more, and a few kinds with selections") {
  const std::string protein = amino("ALA", 1, 0, false),
                    ligands = hetero("CA", "CA", 6, 50, "CA") + hetero("CA", "CA", 7, 60, "CA") +
                              hetero("C1", "LIG", 5, 80, "C") + hetero("C2", "LIG", 5, 81, "C"),
                    waters = hetero("O", "HOH", 8, 90, "O") + hetero("O", "HOH", 9, 95, "O");
  formats::PdbOptions o;
  o.waters = true;
  const Converted few = convert(protein + ligands + waters, o);
  REQUIRE(few.report.notes.size() == 3);
  CHECK(few.report.notes[1] == "kept ligands and ions (--hetatm): CA 2 (first //A/6(CA)), //A/5(LIG)");
  CHECK(few.report.notes[2] == "kept waters (--waters): HOH 2 (first //A/8(HOH))");
  std::string text = protein + ligands, listed = "CA 2, //A/5(LIG)";
  for (char c = 'A'; c < 'A' + 21; ++c) {
    const std::string name = std::string("X") + c + "1";
    text += hetero("C1", name, 10 + c, 100 + 5 * (c - 'A'), "C");
    if (c < 'A' + 18)
      listed += ", //A/" + std::to_string(10 + c) + "(" + name + ")";
  }
  CHECK(without_hetero(text).notes.find("(--hetatm: " + listed + " and 3 more kinds)") != std::string::npos);
}
