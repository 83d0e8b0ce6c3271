// pdb2hier.hpp — options and page of pdb2hier.
#pragma once
#include "cli/run.hpp"
#include "formats/pdb/pdb.hpp"

namespace molmesh {

struct Options : cli::Common {
  Options() { uses_threads = false; }
  formats::PdbOptions pdb;
  std::string levels = "chain,residue", radii = "bondi", unknown = "2";
  std::string surface = "auto", hydrogens = "keep", waters = "drop", hetatm = "keep";
  std::vector<std::string> domains, rules, resolution;
};

inline void describe(cli::Table& t, Options& o) {
  const std::vector<std::string> keep_or_drop = {"keep", "drop"};
  t.group("structure");
  t.add("--format", o.pdb.format, "of the input; auto: PQR where the name ends in .pqr, else from its contents")
      .unit("FORMAT")
      .one_of({"auto", "pdb", "mmcif", "bcif", "mmjson", "pqr", "gro", "xyzr"});
  t.add("--model", o.pdb.model, "first, all, or a model's number").unit("MODEL");
  t.add("--assembly", o.pdb.assembly, "identifier of a biological assembly, or none").unit("ID");
  t.group("levels and resolution");
  t.add("--levels", o.levels, "group levels, outermost first, of domain, chain, residue; or none").unit("LEVELS");
  t.add("--domains", o.domains, "file of lines NAME SELECTION, or entity, or copy (of the assembly)").unit("FILE");
  t.add(
       "--surface", o.surface,
       "exponents and weights without rules: molecular: the molecular surface's volume, area and solvation energy, "
       "by the hydrogens of the file; plain: P_R=0.3; paper: P_R=0.5; auto: molecular for files with hydrogens or "
       "with radii of their own, else plain")
      .unit("WHICH")
      .one_of({"auto", "molecular", "plain", "paper"});
  t.add("-r,--rule", o.rules,
        "'SELECTION P_R=… W_R=… P_C=… P_D=…': exponents (> 0) of all residues, chains and domains that the "
        "selection touches, and the weight W_R of residues (1 where P_R stands alone); 'around SELECTION Å P_R=…' "
        "is a lens; "
        "later rules win")
      .unit("RULE");
  t.add("--resolution", o.resolution, "file of rules, one a line, applied before those of -r").unit("FILE");
  t.group("atoms");
  t.add("--select", o.pdb.select, "keep only these atoms (gemmi's selection syntax)").unit("SELECTION");
  t.add("--hydrogens", o.hydrogens, "keep or drop").unit("WHAT").one_of(keep_or_drop);
  t.add("--waters", o.waters, "keep or drop").unit("WHAT").one_of(keep_or_drop);
  t.add("--hetatm", o.hetatm,
        "ligands, ions, sugars (HETATM), without waters and modified residues of chains: keep or drop")
      .unit("WHAT")
      .one_of(keep_or_drop);
  t.add("--altloc", o.pdb.altloc,
        "alternative locations: occupancy (the highest), first, all, or the letter to prefer")
      .unit("WHICH");
  t.add("--radii", o.radii,
        "bondi, or a file of lines ELEMENT Å or RESIDUE ATOM Å over it; PQR keeps its own unless a file is given")
      .unit("FILE");
  t.add("--unknown", o.unknown, "radius of elements that have none (Å, > 0), or refuse").unit("Å");
  t.page.about =
      "Reads the atoms of a structure, gives each a radius and writes who belongs to which residue, chain and "
      "domain. "
      "Every group has an exponent P that says how sharp it is drawn: a small one blurs the group, a large one "
      "shows its members. Rules set the exponents; by default P_R (residues) is 0.3, P_C (chains) and P_D "
      "(domains) are 1. For files with hydrogens or radii of their own, P_R and weights W_R of the residues' sums "
      "are those that give the molecular surface. Input may be plain or gzip. What is dropped is said on standard "
      "error.";
  t.page.examples = {
      {"pdb2hier 1tii.pdb -o 1tii.hier", "the whole structure with the default exponents"},
      {"pdb2hier -r '* P_R=0.05 P_C=0.5' -r '//D P_R=0.5 P_C=1' 1tii.pdb -o 1tii.hier", "blurred, but for chain D"},
      {"pdb2hier --assembly 1 --select //A,B --waters keep ENTRY.cif.gz -o entry.hier",
       "chains A and B of a biological assembly, with waters"}};
  t.page.files = {
      {".pdb, .cif, .bcif, .json, .pqr, .gro, .xyzr", "atomic structure, also as .gz, read: formats/pdb/PDB.md"},
      {".hier", "molecular hierarchy, written: formats/hier/HIERv1.md, formats/hier/HIERv2.md"}};
  t.page.several = "many structures at once: make -f Makefile.pipeline IN=FOLDER OUT=MESHES all";
  t.page.see_also = {"hier2density", "hierjoin", "tetlabel"};
}

} // namespace molmesh
