// pdb_hierarchy_test.cpp — assemblies, levels, domains, rules.
#include "formats/pdb/mmcif_assembly.hpp"
#include "pdb_text.hpp"
#include <catch2/catch.hpp>
#include <cmath>

using namespace molmesh;
using namespace molmesh::test;

namespace {

/// Chains A and B of two residues, 10 Å apart along x.
std::string structure() {
  std::string s;
  for (int c = 0; c < 2; ++c)
    for (int r = 0; r < 2; ++r)
      for (const char* name : {" N", " CA"})
        s += pdb_atom(name, "GLY", c == 0 ? "A" : "B", r + 1, 10 * c + 4 * r + (name[1] == 'C'),
                      name[1] == 'C' ? "C" : "N");
  return s;
}

/// Twice the structure, the second copy 100 Å along x; chain B in another generator.
const std::string remarks = "REMARK 350 BIOMOLECULE: 1\n"
                            "REMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n"
                            "REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n"
                            "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n"
                            "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n"
                            "REMARK 350   BIOMT1   2  1.000000  0.000000  0.000000      100.00000\n"
                            "REMARK 350   BIOMT2   2  0.000000  1.000000  0.000000        0.00000\n"
                            "REMARK 350   BIOMT3   2  0.000000  0.000000  1.000000        0.00000\n"
                            "REMARK 350 APPLY THE FOLLOWING TO CHAINS: B\n"
                            "REMARK 350   BIOMT1  1000  1.000000  0.000000  0.000000       50.00000\n"
                            "REMARK 350   BIOMT2  1000  0.000000  1.000000  0.000000        0.00000\n"
                            "REMARK 350   BIOMT3  1000  0.000000  0.000000  1.000000        0.00000\n";

formats::PdbOptions with_rules(const std::vector<std::string>& rules) {
  formats::PdbOptions o;
  for (const std::string& rule : rules)
    o.rules.push_back(parse_rule(rule, "-r"));
  return o;
}

formats::PdbOptions with_domains(const std::string& text, std::vector<std::string> levels) {
  formats::PdbOptions o;
  std::istringstream in(text);
  o.domains = formats::PdbOptions::Domains::file;
  o.domain_parts = read_domains(in, "D");
  o.levels = std::move(levels);
  return o;
}

/// "A=1(GLY:1=0.3 …) …": the exponents of two levels.
std::string exponents(const Hierarchy& h) {
  std::ostringstream s;
  for (const Group& outer : h.level.at(0).group) {
    s << outer.name << '=' << outer.exponent << '(';
    for (int64_t i = outer.begin; i < outer.end; ++i)
      s << (i > outer.begin ? " " : "") << h.level.at(1).group[i].exponent;
    s << ") ";
  }
  return s.str();
}

} // namespace

TEST_CASE("rules set exponents in order, on all that they touch") {
  CHECK(exponents(convert(structure()).hierarchy) == "A=1(0.3 0.3) B=1(0.3 0.3) ");
  CHECK(exponents(convert(structure(), with_rules({"* P_R=0.5", "//B/2 P_R=0.9 P_C=2"})).hierarchy) ==
        "A=1(0.5 0.5) B=2(0.5 0.9) ");
  CHECK(exponents(convert(structure(), with_rules({"//B/2/CA P_R=0.9", "//A,B P_R=0.1"})).hierarchy) ==
        "A=1(0.1 0.1) B=1(0.1 0.1) ");
  CHECK(refusal(structure(), with_rules({"//C P_R=0.9"})) ==
        "-r: found no atom in selection '//C', expected some; chains here: A, B (for example '//A', '//A/45-60', "
        "'//A/(HEM)')");
  CHECK(refusal(structure(), with_rules({"//A[ P_R=0.9"})).substr(0, 3) == "-r:");
}

TEST_CASE("a residue number alone is that residue, with a dash a range") {
  const auto with = [](const std::string& selection) {
    return exponents(convert(structure(), with_rules({selection + " P_R=2"})).hierarchy);
  };
  for (const char* first : {"//A/1", "/1/A/1", "A/1", "A/1/", "//A/-1", "//A/1.", "//A/1(GLY)", "//A/1;q>0"}) {
    INFO(first);
    CHECK(with(first) == "A=1(2 0.3) B=1(0.3 0.3) ");
  }
  CHECK(with("1") == "A=1(2 0.3) B=1(2 0.3) ");
  for (const char* all : {"//A/1-", "//A/1-2", "A/1-/CA", "//A", "//A/*", "//A/(GLY)"}) {
    INFO(all);
    CHECK(with(all) == "A=1(2 2) B=1(0.3 0.3) ");
  }
}

TEST_CASE("a lens touches what has an atom within the distance") {
  // atoms at 0, 1, 4, 5 (chain A) and 10, 11, 14, 15 (chain B); around CA of A/1, at 1
  CHECK(exponents(convert(structure(), with_rules({"around //A/1/CA 3.0 P_R=0.9"})).hierarchy) ==
        "A=1(0.9 0.9) B=1(0.3 0.3) ");
  CHECK(exponents(convert(structure(), with_rules({"around //A/1/CA 2.9 P_R=0.9"})).hierarchy) ==
        "A=1(0.9 0.3) B=1(0.3 0.3) ");
  CHECK(exponents(convert(structure(), with_rules({"around //A/2 5 P_R=0.9 P_C=2"})).hierarchy) ==
        "A=2(0.9 0.9) B=2(0.9 0.3) ");
  for (const char* bad :
       {"around //A P_R=1", "around P_R=1", "around //A 0 P_R=1", "around //A -1 P_R=1", "around //A x P_R=1"})
    CHECK(refusal(structure(), with_rules({bad})).substr(0, 3) == "-r:");
}

TEST_CASE("a lens agrees with all pairs of distances") {
  std::string text;
  std::vector<Vec3d> at;
  uint32_t seed = 5;
  const auto next = [&] { return static_cast<double>((seed = seed * 1664525u + 1013904223u) >> 16) / 65536.0; };
  for (int r = 1; r <= 400; ++r) {
    const Vec3d p{std::round(40000 * next()) / 1000 - 20, std::round(40000 * next()) / 1000 - 20,
                  std::round(40000 * next()) / 1000 - 20};
    std::string line = pdb_atom(" CA", "GLY", "A", r, 0, "C");
    char xyz[80];
    std::snprintf(xyz, sizeof xyz, "%8.3f%8.3f%8.3f", p.x, p.y, p.z);
    text += line.replace(30, 24, xyz);
    at.push_back(p);
  }
  const Hierarchy h = convert(text, with_rules({"around //A/1-7 6.5 P_R=0.9"})).hierarchy;
  int touched = 0;
  for (size_t i = 0; i < at.size(); ++i) {
    bool near = false;
    for (size_t j = 0; j < 7; ++j)
      near = near || norm2(at[i] - at[j]) <= 6.5 * 6.5;
    CHECK(h.level[1].group[i].exponent == (near ? 0.9 : 0.3));
    touched += near;
  }
  CHECK(touched > 7);
  CHECK(touched < 300);
}

TEST_CASE("levels may be any, in any sensible order") {
  formats::PdbOptions o;
  o.levels = {};
  CHECK(convert(structure(), o).hierarchy.level.empty());
  CHECK(convert(structure(), o).hierarchy.atom.size() == 8);
  o.levels = {"residue"};
  CHECK(convert(structure(), o).hierarchy.level.at(0).group.size() == 4);
  o.levels = {"chain"};
  CHECK(convert(structure(), o).hierarchy.level.at(0).group.at(1).end == 8);
  for (const std::vector<std::string>& bad :
       {std::vector<std::string>{"residue", "chain"}, {"chain", "chain"}, {"atom"}, {"domain", "residue"}}) {
    o.levels = bad;
    CHECK_FALSE(refusal(structure(), o, "x.pdb", Status::usage).empty());
  }
}

TEST_CASE("domains hold chains, or lie within them") {
  const std::string halves = "two //B\none //A\n";
  const Hierarchy h = convert(structure(), with_domains(halves, {"domain", "chain", "residue"})).hierarchy;
  CHECK(h.level[0].group[0].name == "two");
  CHECK(h.level[1].group[0].name == "B");
  CHECK(h.level[1].group[1].name == "A");

  const std::string within = "first //A,B/1\nlast //A,B/2\n";
  const Hierarchy w = convert(structure(), with_domains(within, {"chain", "domain", "residue"})).hierarchy;
  CHECK(w.level[1].group.size() == 4);
  CHECK(w.level[1].group[0].name == "first");
  CHECK(w.level[1].group[1].name == "last");
  const Hierarchy across = convert(structure(), with_domains(within, {"domain", "residue"})).hierarchy;
  CHECK(across.level[0].group[0].end == 2);
  CHECK(across.atom[2].center.x == 10); // residue 1 of B follows residue 1 of A

  formats::PdbOptions o = with_domains(halves, {"domain", "chain", "residue"});
  o.rules = {parse_rule("//A/1 P_D=0.7", "-r")};
  const Hierarchy r = convert(structure(), o).hierarchy;
  CHECK(r.level[0].group[0].exponent == 1);
  CHECK(r.level[0].group[1].exponent == 0.7);
}

TEST_CASE("domains by entity: chains of the same SEQRES") {
  const std::string text = "SEQRES   1 A    2  GLY GLY\nSEQRES   1 B    2  GLY GLY\nSEQRES   1 C    1  ALA\n" +
                           structure() + pdb_atom(" CA", "ALA", "C", 1, 30, "C");
  formats::PdbOptions o;
  o.domains = formats::PdbOptions::Domains::entity;
  o.levels = {"domain", "chain", "residue"};
  const Hierarchy h = convert(text, o).hierarchy;
  REQUIRE(h.level[0].group.size() == 2);
  CHECK(h.level[0].group[0].end == 2); // A and B
  CHECK(h.level[1].group[2].name == "C");
}

TEST_CASE("gaps, overlaps and torn residues or chains name an atom") {
  const std::vector<std::string> levels = {"domain", "chain", "residue"};
  CHECK(refusal(structure(), with_domains("one //A\n", levels)) ==
        "D: found atom //B/1(GLY)/N in no domain, expected each in exactly one");
  CHECK(refusal(structure(), with_domains("one //A,B\ntwo //B\n", levels)) ==
        "D:2: found atom //B/1(GLY)/N in domains 'one' (D:1) and 'two', expected exactly one");
  CHECK(refusal(structure(), with_domains("one //A,B\none //B\n", levels))
            .empty()); // parts of one domain may overlap
  CHECK(refusal(structure(), with_domains("one //A\ntwo //B//CA\n", levels)) ==
        "D:2: found atom //B/1(GLY)/N outside domain 'two' that holds other atoms of its residue, expected whole "
        "residues");
  CHECK(refusal(structure(), with_domains("one //A\ntwo //B/1\none //B/2\n", levels))
            .find("found chain B in domains 'two' (//B/1(GLY)/N) and 'one' (//B/2(GLY)/N)") != std::string::npos);
  CHECK(refusal(structure(), with_domains("one *\ntwo //C\n", levels)) ==
        "D:2: found no atom in '//C', expected some in domain 'two'; chains here: A, B (for example '//A', "
        "'//A/45-60', '//A/(HEM)')");
}

TEST_CASE("an assembly of the PDB format: copies with unique names") {
  formats::PdbOptions o;
  CHECK(listing(convert(remarks + structure(), o).hierarchy).substr(0, 9) == "A/GLY:1/N");
  o.assembly = "1";
  const Converted c = convert(remarks + structure(), o);
  CHECK(c.report.copies == 3);
  std::string names;
  for (const Group& g : c.hierarchy.level[0].group)
    names += g.name + " ";
  CHECK(names == "A_1 A_2 B ");
  CHECK(c.hierarchy.atom[0].center.x == 0);
  CHECK(c.hierarchy.atom[4].center.x == 100);
  CHECK(c.hierarchy.atom[8].center.x == 60);

  o.rules = {parse_rule("//A P_R=0.5", "-r"), parse_rule("//A_2/1 P_R=0.9", "-r")};
  CHECK(exponents(convert(remarks + structure(), o).hierarchy) == "A_1=1(0.5 0.5) A_2=1(0.9 0.5) B=1(0.3 0.3) ");
  o.rules = {parse_rule("around //A_2 45 P_R=0.9", "-r")}; // A_2 from 100 to 105, B from 60 to 65
  CHECK(exponents(convert(remarks + structure(), o).hierarchy) == "A_1=1(0.3 0.3) A_2=1(0.9 0.9) B=1(0.9 0.9) ");

  o.rules.clear();
  o.domains = formats::PdbOptions::Domains::copy;
  o.levels = {"domain", "chain", "residue"};
  CHECK(convert(remarks + structure(), o).hierarchy.level[0].group.size() == 3);

  formats::PdbOptions missing;
  missing.assembly = "2";
  CHECK(refusal(remarks + structure(), missing) == "x.pdb: found no assembly 2, expected one of 1");
  CHECK(refusal(structure(), missing).find("lists no assemblies") != std::string::npos);
  missing.assembly = "1";
  std::string broken = remarks;
  broken.replace(broken.find("100.00000"), 9, "1e9999999");
  CHECK(refusal(broken + structure(), missing).substr(0, 8) == "x.pdb:6:");
  const size_t last_row = remarks.rfind("REMARK 350   BIOMT3");
  CHECK(refusal(remarks.substr(0, last_row) + structure(), missing).find("without BIOMT3") != std::string::npos);
  std::string other_serial = remarks;
  other_serial[remarks.find_first_not_of(' ', last_row + 19)] = '9';
  CHECK(refusal(other_serial + structure(), missing).find("expected BIOMT3") != std::string::npos);
}

TEST_CASE("operators of an assembly that shear or mirror are refused") {
  formats::PdbOptions o;
  o.assembly = "1";
  for (const char* row : {"1.000000  0.500000  0.000000", "-1.000000  0.000000  0.000000"}) {
    const std::string text = "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n"
                             "REMARK 350   BIOMT1   1  " +
                             std::string(row) +
                             "  0.00000\n"
                             "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000  0.00000\n"
                             "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000  0.00000\n";
    CHECK(refusal(text + structure(), o).find("expected a rotation and a shift") != std::string::npos);
  }
}

TEST_CASE("numbers of selections that overflow are refused") {
  formats::PdbOptions o;
  o.select = "//A/4294967301";
  CHECK(refusal(structure(), o, "x.pdb", Status::usage).find("nine digits") != std::string::npos);
}

TEST_CASE("operator expressions of mmCIF") {
  const auto joined = [](const std::string& expression) {
    std::string s;
    for (const auto& product : formats::parse_operators(expression, "x")) {
      for (const std::string& id : product)
        s += id + "*";
      s.back() = ' ';
    }
    return s;
  };
  CHECK(joined("1") == "1 ");
  CHECK(joined("1,2,P") == "1 2 P ");
  CHECK(joined("(1-3)") == "1 2 3 ");
  CHECK(joined("(X0)(1-2,5)") == "X0*1 X0*2 X0*5 ");
  CHECK(joined("(1-2)(3-4)") == "1*3 1*4 2*3 2*4 ");
  CHECK(formats::parse_operators("(1-60)(61-88)", "x").size() == 1680);
  for (const char* bad :
       {"", "(", "()", "(1", "1,", "(2-1)", "(1-1000000)", "(1-1000)(1-1000)", "(1-400)(1-400)(1-400)", "1)"}) {
    INFO(bad);
    CHECK_THROWS_AS(formats::parse_operators(bad, "x"), Error);
  }
}
