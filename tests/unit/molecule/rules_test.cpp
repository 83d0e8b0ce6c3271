// rules_test.cpp — the text of rules, domains and radii.
#include "base/error.hpp"
#include "molecule/exponents.hpp"
#include "molecule/molecular_body.hpp"
#include "molecule/radii.hpp"
#include <catch2/catch.hpp>
#include <sstream>

using namespace molmesh;

namespace {

template <class F>
std::string message(F f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

} // namespace

TEST_CASE("a rule is a selection and exponents") {
  const Rule rule = parse_rule("  //B/45-80  P_R=0.5 P_D=2e-1 ", "-r");
  CHECK(rule.selection == "//B/45-80");
  CHECK(rule.residue == 0.5);
  CHECK_FALSE(rule.chain.has_value());
  CHECK(rule.domain == 0.2);
  CHECK(parse_rule("around //B/45 8.0 P_R=1", "-r").selection == "around //B/45 8.0");
  CHECK(parse_rule("//A; q<0.5 P_C=3", "-r").selection == "//A; q<0.5");
}

TEST_CASE("a rule may give a weight") {
  CHECK(parse_rule("* P_R=0.4 W_R=0.6", "-r").weight == 0.6);
  CHECK(parse_rule("//A W_R=0.6", "-r").selection == "//A");
  CHECK_FALSE(parse_rule("* P_R=0.4", "-r").weight.has_value());
  CHECK(message([] { parse_rule("* P_R=1e-300", "-r"); }) == "-r: found 'P_R=1e-300', expected at least 0.0001");
  CHECK(message([] { parse_rule("* W_R=0.0001", "-r"); }) == "-r: found 'W_R=0.0001', expected at least 0.001");
}

TEST_CASE("an atom alone keeps its sphere, and residues of many atoms get nearly the whole weight") {
  CHECK(residue_weight(0.62, 1) == 1);
  CHECK(residue_weight(0.62, 0) == 1);
  CHECK(residue_weight(0.62, 2) == 0.7874);
  CHECK(residue_weight(0.62, 15) == 0.6401);
}

TEST_CASE("hydrogens are told by how many there are for each carbon") {
  CHECK(hydrogens_of(0, 300, 600) == Hydrogens::none);
  CHECK(hydrogens_of(3, 300, 600) == Hydrogens::none); // of a ligand
  CHECK(hydrogens_of(130, 300, 600) == Hydrogens::polar);
  CHECK(hydrogens_of(620, 380, 602) == Hydrogens::all);
  CHECK(hydrogens_of(272, 230, 486) == Hydrogens::all); // DNA
  CHECK(hydrogens_of(4, 0, 2) == Hydrogens::polar);
}

TEST_CASE("what is no rule is refused, with its place") {
  const auto refused = [](const char* text) { return message([&] { parse_rule(text, "f:3", Status::usage); }); };
  for (const char* text : {"", "*", "P_R=1", "* P_R=", "* P_R=0", "* P_R=-1", "* P_R=nan", "* P_R=inf", "* P_X=1",
                           "* P_R=1 P_R=2", "* P_R=1x", "* P_R =1", "* P_R=1 # why P_C=2"}) {
    INFO(text);
    CHECK(refused(text).substr(0, 5) == "f:3: ");
  }
  CHECK(refused("* P_R=0") == "f:3: found 'P_R=0', expected a number > 0");
  try {
    parse_rule("*", "x", Status::usage);
  } catch (const Error& e) {
    CHECK(e.status == Status::usage);
  }
}

TEST_CASE("files of rules and domains have comments, and errors have lines") {
  std::istringstream rules("# all\n\n* P_R=0.1\r\n\t//A P_R=0.5  P_C=1\n");
  const std::vector<Rule> read = read_rules(rules, "rules");
  REQUIRE(read.size() == 2);
  CHECK(read[0].selection == "*");
  CHECK(read[0].where == "rules:3");
  CHECK(read[1].chain == 1);

  std::istringstream domains("left //A,B\nright\t //C\n");
  const std::vector<DomainPart> parts = read_domains(domains, "domains");
  REQUIRE(parts.size() == 2);
  CHECK(parts[1].name == "right");
  CHECK(parts[1].selection == "//C");
  std::istringstream marked("\xEF\xBB\xBFleft //A\n");
  CHECK(read_domains(marked, "domains").at(0).name == "left");

  const auto refused = [](auto read_file, const std::string& text) {
    std::istringstream in(text);
    return message([&] { read_file(in, "F"); });
  };
  CHECK(refused(read_domains, "left\n") == "F:1: found 'left', expected NAME SELECTION");
  CHECK(refused(read_domains, "# none\n").find("no domain") != std::string::npos);
  CHECK(refused(read_rules, "* P_R=1\n*\n").substr(0, 5) == "F:2: ");
  CHECK(refused(read_rules, std::string("* P_R=1\0\n", 9)) == "F:1: found a NUL byte, expected text");
}

TEST_CASE("radii: Bondi's, Mantina's, and a user's over them") {
  CHECK(bondi_radius("C") == 1.70);
  CHECK(bondi_radius("Zn") == 1.39);
  CHECK(bondi_radius("d") == 1.20);
  CHECK(bondi_radius("Ca") == 2.31);
  CHECK_FALSE(bondi_radius("Fe").has_value());
  CHECK_FALSE(bondi_radius("X").has_value());

  std::istringstream in("# own\nC 1.9\nfe 1.5\n* CA 2.0\nALA CA 2.1\n");
  const Radii radii = read_radii(in, "F");
  CHECK(radii.find("GLY", "C", "C") == 1.9);
  CHECK(radii.find("GLY", "CA", "C") == 2.0);
  CHECK(radii.find("ALA", "CA", "C") == 2.1);
  CHECK(radii.find("HEM", "FE", "Fe") == 1.5);
  CHECK(radii.find("GLY", "N", "N") == 1.55);
  CHECK_FALSE(radii.find("X", "MN", "Mn").has_value());
  std::istringstream hydrogens("H 1\n"), both("H 1\nD 1.1\n");
  CHECK(read_radii(hydrogens, "F").find("GLY", "DA", "D") == 1);
  CHECK(read_radii(both, "F").find("GLY", "DA", "D") == 1.1);

  const auto refused = [](const std::string& text) {
    std::istringstream bad(text);
    return message([&] { read_radii(bad, "F"); });
  };
  for (const char* text : {"C\n", "C 0\n", "C -1\n", "C x\n", "A B C 1\n", "C nan\n"}) {
    INFO(text);
    CHECK(refused(text).substr(0, 5) == "F:1: ");
  }
}
