// hier_selection_test.cpp — what gemmi's selections select in a .hier.
#include "base/error.hpp"
#include "formats/hier/hier.hpp"
#include "formats/pdb/hier_selection.hpp"
#include "formats/pdb/pdb.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>
#include <fstream>
#include <numeric>
#include <sstream>

using namespace molmesh;

namespace {

const char text[] =
    "hier 1\nlevels chain residue\n"
    "chain A_1 1\nresidue GLY:1 1\natom N N 0 0 0 1\natom CA C 1 0 0 1\nresidue ALA:2A 1\natom CA C 5 0 0 1\n"
    "chain A_2 1\nresidue GLY:1 1\natom CA C 9 0 0 1\nchain B 1\nresidue ZN:-3 1\natom ZN ZN 20 0 0 1\n"
    "residue odd 1\natom CA C 30 0 0 1\n";

Hierarchy hierarchy(const std::string& t = text) {
  std::istringstream in(t);
  return formats::read_hier(in, "x.hier");
}

/// Indices of the atoms that are selected: "0 2".
std::string selected(const std::string& selection, const Hierarchy& h = hierarchy()) {
  std::string s;
  const std::vector<uint8_t> atom = formats::select_atoms(h, selection, "here");
  for (size_t a = 0; a < atom.size(); ++a)
    s += atom[a] ? (s.empty() ? "" : " ") + std::to_string(a) : "";
  return s;
}

std::string refusal(const std::string& selection, const Hierarchy& h = hierarchy(),
                    Status status = Status::bad_input) {
  return test::refusal(status, [&] { selected(selection, h); });
}

} // namespace

TEST_CASE("Selections on a .hier: chains and their copies, residues, insertion codes, atoms, elements, lenses") {
  CHECK(selected("*") == "0 1 2 3 4 5");
  CHECK(selected("//A") == "0 1 2 3");
  CHECK(selected("//A_2") == "3");
  CHECK(selected("//B") == "4 5");
  CHECK(selected("//A/1") == "0 1 3");
  CHECK(selected("//A/1-2") == "0 1 3");
  CHECK(selected("//A/1-2.A") == "0 1 2 3");
  CHECK(selected("//A_1/2.A") == "2");
  CHECK(selected("//*/(GLY)") == "0 1 3");
  CHECK(selected("//*/-3") == "0 1 2 3 4"); // all up to 3
  CHECK(selected("//*/(odd)") == "5");
  CHECK(selected("/1/A_1/1/CA") == "1");
  CHECK(selected("//*//[ZN]") == "4");
  CHECK(selected("around //A_1/1/N 5.0") == "0 1 2");
  CHECK(selected("around //A_1/1/N 4.9") == "0 1");
}

TEST_CASE("Selections that a .hier cannot answer are refused with one line") {
  CHECK(refusal("//C").find("expected one that some atom fits") != std::string::npos);
  CHECK(refusal("//A/99").find("here: found selection") == 0);
  const Hierarchy some = hierarchy("hier 1\nlevels chain residue\nchain A 1\nresidue GLY:1 1\natom CA C 0 0 0 1\n"
                                   "residue GLY:2 1\natom CA C 4 0 0 1\nresidue GLY:9 1\natom CA C 8 0 0 1\n"
                                   "residue ANS:20 1\natom C C 12 0 0 1\nresidue SER:21 1\natom C C 14 0 0 1\n"
                                   "chain B 1\nresidue HEM:1 1\natom CA C 0 9 0 1\n");
  CHECK(refusal("//A/(ANX)", some).find("fits; residues there: //A/20(ANS), //A/21(SER), //A/1(GLY)") !=
        std::string::npos);
  CHECK(refusal("//A/10-12", some).find("fits; residues there: //A/9(GLY), //A/2(GLY), //A/1(GLY), //A/20(ANS)") !=
        std::string::npos);
  CHECK(refusal("//C/10", some).find("fits; chains here: A, B (") != std::string::npos);
  CHECK(refusal("//A//CA:A").find("a .hier holds nothing else") != std::string::npos);
  CHECK(refusal("/2/A").find("a .hier holds nothing else") != std::string::npos);
  CHECK(refusal("//A;q>0.5").find("a .hier holds nothing else") != std::string::npos);
  CHECK(refusal("//A///x/y", hierarchy(), Status::usage).find("gemmi's syntax") != std::string::npos);
  CHECK(refusal("around //A -1", hierarchy(), Status::usage).find("DISTANCE > 0") != std::string::npos);
  const Hierarchy plain = hierarchy("hier 1\nlevels\natom CA C 0 0 0 1\n");
  CHECK(refusal("//A", plain).find("no level 'chain'") != std::string::npos);
  CHECK(refusal("//*/5", plain).find("no level 'residue'") != std::string::npos);
  CHECK(selected("*", plain) == "0");
}

TEST_CASE("A selection finds the same atoms in the .hier as pdb2hier finds in the structure") {
  const std::string path = MOLMESH_SOURCE_DIR "/tests/data/1tii.pdb";
  const auto read = [&](const formats::PdbOptions& options) {
    std::ifstream in(path);
    std::stringstream out;
    formats::PdbHierarchy(in, path, options).write(out);
    return formats::read_hier(out, path);
  };
  const Hierarchy all = read({});
  for (const char* selection :
       {"//D/45-80", "//A,C", "//*/(GLY)", "//*//CA", "//E/16(SER)", "//!A/1-20/N,C[N]", "//D/45-"}) {
    INFO(selection);
    formats::PdbOptions options;
    options.select = selection;
    const Hierarchy part = read(options);
    const std::vector<uint8_t> chosen = formats::select_atoms(all, selection, "here");
    REQUIRE(std::accumulate(chosen.begin(), chosen.end(), size_t{0}) == part.atom.size());
    for (size_t a = 0, b = 0; a < chosen.size(); ++a)
      if (chosen[a])
        CHECK(all.atom[a].center == part.atom[b++].center);
  }
}

TEST_CASE(
    "Chains of any name are selected as printed, or in double quotes, by every option that takes a selection") {
  const std::string path = MOLMESH_SOURCE_DIR "/tests/data/cases/chain_names.cif";
  const auto read = [&](const formats::PdbOptions& options) {
    std::ifstream in(path);
    std::stringstream out;
    formats::PdbHierarchy(in, path, options).write(out);
    return formats::read_hier(out, path);
  };
  const Hierarchy all = read({});
  REQUIRE(all.level[0].group.size() == 9);
  const auto is_chain = [&](const std::string& selection, const std::string& name) {
    INFO(selection);
    formats::PdbOptions options;
    options.select = selection;
    const Hierarchy part = read(options);
    REQUIRE(part.level[0].group.size() == 1);
    CHECK(part.level[0].group[0].name == name);
    REQUIRE(part.atom.size() == 2);

    options = {};
    options.rules = {{selection, 0.7, {}, {}, "here", Status::usage, {}}};
    const Hierarchy ruled = read(options);
    size_t sharp = 0;
    for (const Group& residue : ruled.level[1].group)
      sharp += residue.exponent == 0.7;
    CHECK(sharp == 1);

    options = {};
    options.levels = {"domain", "chain", "residue"};
    options.domains = formats::PdbOptions::Domains::file;
    options.domain_parts = {{"one", selection, "here"}, {"rest", "//!" + selection.substr(2), "here"}};
    const Hierarchy divided = read(options);
    REQUIRE(divided.level[0].group.size() == 2);
    CHECK(divided.level[1].group[divided.level[0].group[0].begin].name == name);

    const std::vector<uint8_t> chosen = formats::select_atoms(all, selection, "here");
    CHECK(std::accumulate(chosen.begin(), chosen.end(), size_t{0}) == 2);
    const std::vector<uint8_t> lens = formats::select_atoms(all, "around " + selection + " 0.1", "here");
    CHECK(lens == chosen);
  };
  for (const char* name : {"A", "A-2", "A.1", "A'"}) {
    is_chain("//" + std::string(name), name);
    is_chain("//\"" + std::string(name) + "\"", name);
  }
  for (const char* name : {"A,B", "A/1", "A B", "*"})
    is_chain("//\"" + std::string(name) + "\"", name);
  is_chain("//A%20B", "A B");
  is_chain("//A\"", "A\"");       // a quote opens at the beginning of a name alone
  is_chain("//\"A\"\"\"", "A\""); // within quotes it is written twice
  const auto count = [&](const std::string& selection) {
    const std::vector<uint8_t> chosen = formats::select_atoms(all, selection, "here");
    return std::accumulate(chosen.begin(), chosen.end(), size_t{0});
  };
  CHECK(count("//A-2,\"A,B\"/2-3/CA") == 2);
  CHECK(count("//!A,\"A/1\"") == 14);
  CHECK(count("\"A,B\"/3/N") == 1);
  CHECK(refusal("//\"A", all, Status::usage).find("without its second quote") != std::string::npos);
  CHECK(refusal("//\"A\"B", all, Status::usage).find("behind a quoted name") != std::string::npos);
  CHECK(refusal("//A(1)", all, Status::usage).find("needs double quotes") != std::string::npos);
}

TEST_CASE("Residues may be a list of numbers and ranges, their and atoms' names may be quoted") {
  CHECK(selected("//*/1,2-9") == selected("//*/1-9"));
  CHECK(selected("//A_1/1,2.A") == "0 1 2");
  CHECK(selected("//A/1,2.A(ALA)") == "2");
  CHECK(selected("//A_1/2.A,1/N,CA") == "0 1 2");
  CHECK(selected("//*/(\"GLY\",odd)") == "0 1 3 5");
  CHECK(selected("//*/*/\"N\"[N]") == "0");
  CHECK(selected("1,2.A/CA") == "1 2 3");
  CHECK(selected("around //A_1/1,2.A/CA 3.9") == "0 1 2");
  for (const char* wrong : {"//A/1,,2", "//A/1,", "//A/1,x", "//A/1(GLY", "//A/1-2-3"}) {
    INFO(wrong);
    CHECK(refusal(wrong, hierarchy(), Status::usage).find("gemmi's syntax") != std::string::npos);
  }
}

TEST_CASE("a residue as it is printed selects that residue, and so does an atom") {
  const Hierarchy h = hierarchy(
      "hier 1\nlevels chain residue\nchain A_1 1\nresidue GLY:-3 1\natom N N 0 0 0 1\natom CA C 1 0 0 1\n"
      "residue GLY:3 1\natom CA C 5 0 0 1\nresidue GLY:-4B 1\natom CA C 6 0 0 1\nresidue GLY:-3A 1\natom O5' O 7 0 "
      "0 1\nresidue a,b:-2 1\natom CA C 8 0 0 1\nchain B%20* 1\nresidue GLY:3 1\natom CA C 9 0 0 1\nresidue "
      "GLY:3A 1\natom H*/1 H 20 0 0 1\nresidue odd 1\natom CA C 30 0 0 1\nresidue a:b:c 1\natom CA C 40 0 0 1\n"
      "residue :7 1\natom CA C 50 0 0 1\n");
  for (size_t a = 0; a < h.atom.size(); ++a) {
    const std::string atom = place_of(h, static_cast<int64_t>(a)), residue = atom.substr(0, atom.rfind(')') + 1);
    INFO(atom);
    CHECK(selected(atom, h) == std::to_string(a));
    CHECK(selected(residue, h) == (a < 2 ? "0 1" : std::to_string(a)));
  }
  CHECK(selected("//A_1/-4.B--3", h) == "0 1 3");
  CHECK(selected("//A_1/-3-3", h) == "0 1 2 4 5");
  CHECK(selected("//A_1/-2-", h) == "2 5");
  CHECK(selected("//A_1/-3--3,3", h) == "0 1 2");
  for (const char* wrong : {"//*/--3", "//*/-3--", "//*/-3--2-1", "//*/-3.-4x5", "//*/-x-2"})
    CHECK(refusal(wrong, h, Status::usage).find("gemmi's syntax") != std::string::npos);
}

TEST_CASE("a selection of residues that is no syntax is refused with the one that is meant") {
  const auto expected = [](const std::string& selection) {
    const std::string line = refusal(selection, hierarchy(), Status::usage);
    const size_t at = line.find("expected ");
    return at == std::string::npos ? line : line.substr(at + 9);
  };
  CHECK(expected("//H/ANS") == "names of residues in parentheses: '//H/(ANS)'");
  CHECK(expected("//H/SO4,NAG/O1") == "names of residues in parentheses: '//H/(SO4,NAG)/O1'");
  CHECK(expected("H/ANS") == "names of residues in parentheses: 'H/(ANS)'");
  CHECK(expected("around //H/ANS 5.0") == "names of residues in parentheses: '//H/(ANS)'");
  CHECK(expected("//H/HIS57,ASP102") == "numbers of residues without names: '//H/57,102'");
  CHECK(expected("//H/HIS57-GLY60,102/CA") == "numbers of residues without names: '//H/57-60,102/CA'");
  CHECK(expected("//H/SER221A") == "numbers of residues without names: '//H/221.A'");
  CHECK(expected("!(NA)") == "'!' within the parentheses: '//*/(!NA)'");
  CHECK(expected("//A/!(NA,CL)") == "'!' within the parentheses: '//A/(!NA,CL)'");
  CHECK(expected("//A/!NA") == "'!' within the parentheses: '//A/(!NA)'");
  CHECK(expected("//A///x/y").find("gemmi's syntax, as '//D'") == 0);
  CHECK(expected("//A/x/y/z").find("gemmi's syntax, as '//D'") == 0);
  CHECK(expected("//A/57,x-y").find("gemmi's syntax") == 0);
  for (const char* fixed : {"//A/(ANS)", "//A/57,102", "//A/221.A", "//A/57-60,102/CA"})
    CHECK(test::refusal(Status::bad_input, [&] { selected(fixed); }).find("some atom fits") != std::string::npos);
  CHECK(selected("//*/(!ZN)") == "0 1 2 3 5");
}

TEST_CASE("a rule sets the weights of the residues in a hierarchy by their atoms, and P_R alone makes them 1") {
  Hierarchy h;
  h.level = {{"chain", {{"A", 1, 0, 3}}},
             {"residue", {{"GLY:1", 0.3, 0, 4}, {"ZN:2", 0.3, 4, 5}, {"GLY:3", 0.3, 5, 9}}}};
  for (int a = 0; a < 9; ++a)
    h.atom.push_back({{3.0 * a, 0, 0}, 1.5});
  h.atom[8].radius = 0; // a charge counts for nothing
  for (Group& g : h.level[1].group)
    g.weight = 0.9;
  formats::apply_rules(h, {parse_rule("//A W_R=0.5", "here")});
  CHECK(h.level[1].group[0].weight == 0.5946);
  CHECK(h.level[1].group[1].weight == 1);
  CHECK(h.level[1].group[2].weight == 0.63);
  CHECK(h.level[1].group[0].exponent == 0.3);
  formats::apply_rules(h, {parse_rule("//A/1 P_R=0.4", "here")});
  CHECK(h.level[1].group[0].weight == 1);
  CHECK(h.level[1].group[2].weight == 0.63);
  CHECK(test::refusal(Status::bad_input, [] {
          Hierarchy atoms;
          atoms.atom.push_back({{0, 0, 0}, 1});
          formats::apply_rules(atoms, {parse_rule("* W_R=0.5", "here")});
        }) == "here: found W_R, expected exponents of levels that there are: there is no level residue");
}

TEST_CASE("numbers that no residue has are told") {
  const auto absent = [](const std::string& selection) {
    std::vector<std::string> numbers;
    formats::select_atoms(hierarchy(), selection, "here", &numbers);
    std::string all;
    for (const std::string& number : numbers)
      all += (all.empty() ? "" : " ") + number;
    return all;
  };
  CHECK(absent("//A/1,2A").empty());
  CHECK(absent("//A/1,7,2A,9-12") == "7 9-12");
  CHECK(absent("//A_2/1,2A") == "2A"); // in that chain
  CHECK(absent("//*/1,2A(GLY)") == "2A");
  CHECK(absent("//A").empty());
  CHECK(absent("around //A/1,7 3.0") == "7");
}
