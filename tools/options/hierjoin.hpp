// hierjoin.hpp — options and page of hierjoin.
#pragma once
#include "cli/run.hpp"
#include <optional>

namespace molmesh {

struct Options : cli::Common {
  Options() { uses_threads = false; }
  std::optional<double> carve;
  std::string clash = "refuse";
  std::vector<std::string> rules;
};

inline void describe(cli::Table& t, Options& o) {
  t.group("pieces");
  t.add(
       "--carve", o.carve,
       "leave out the residues of every piece but the first that have an atom's center within this distance of one "
       "of an earlier piece; `carve=` in a line of the plan wins")
      .unit("Å")
      .positive()
      .shown_default("none");
  t.add("--clash", o.clash, "chains or domains of one name: refuse, or number (NAME_1, NAME_2, …)")
      .unit("WHAT")
      .one_of({"refuse", "number"});
  t.group("resolution");
  t.add("-r,--rule", o.rules,
        "'SELECTION P_R=… W_R=… P_C=… P_D=…': exponents of all residues, chains and domains of the joined "
        "hierarchy that the selection touches; applied after the rules of the plan")
      .unit("RULE");
  t.page.about =
      "Joins structures into one hierarchy, atom by atom: proteins in a membrane, filaments, lattices. A plan has "
      "a "
      "line for each piece: its .hier, how it is moved, its copies along a helix, a lattice or an assembly's "
      "operators, names of its chains, the domain that it belongs to. Bodies without atoms (sphere, capsule, "
      "cylinder, box, slab) "
      "may stand among them. Atoms are moved in double precision, and "
      "nothing "
      "is rounded. Later pieces make room for earlier ones (--carve). Chains and domains keep distinct names.";
  t.page.examples = {
      {"hierjoin FILAMENT.join -o filament.hier", "all pieces of the plan"},
      {"hierjoin --carve 2.5 MEMBRANE.join | hier2density --spacing 1 -o membrane.vdb",
       "lipids and waters within 2.5 Å of the protein, which stands first, are left out"},
      {"hierjoin --clash number -r '//A P_R=0.5' PAIR.join -o pair.hier", "chains of one name become A_1, A_2"}};
  t.page.files = {
      {".join", "plan, read: formats/join/JOINv1.md"},
      {".hier", "molecular hierarchy, read and written: formats/hier/HIERv1.md, formats/hier/HIERv2.md"},
      {".pdb, .cif", "structure with an assembly, read where the plan names one: formats/pdb/PDB.md"}};
  t.page.several = "several stand in a plan, a line each";
  t.page.see_also = {"pdb2hier", "hier2density"};
}

} // namespace molmesh
