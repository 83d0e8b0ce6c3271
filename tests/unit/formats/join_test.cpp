// join_test.cpp — the records and keys of JOINv1.md.
#include "formats/join/join.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

using namespace molmesh;

namespace {

std::vector<Rigid> two_operators(const std::string& file, const std::string& id, const std::string&) {
  CHECK(file == "x y.pdb");
  CHECK(id == "1");
  return {Rigid{}, rotation({0, 0, 1}, 180, {})};
}

formats::JoinPlan plan(const std::string& text) {
  std::istringstream in(text);
  return formats::read_join(in, "P", two_operators);
}

std::string refusal(const std::string& piece) {
  return test::refusal(Status::bad_input, [&] { plan("join 1\npiece a.hier " + piece + "\n"); });
}

} // namespace

TEST_CASE("a plan of pieces, motions and rules is read") {
  const formats::JoinPlan p = plan("# a plan\njoin 1\n\npiece \"a b.hier\" domain=membrane \"suffix= x\" P_R=0.5\n"
                                   "piece c.hier chains=A:B,B:A carve=2.5 P_C=2 P_D=0.1\nrule //A P_R=0.8\n");
  REQUIRE(p.piece.size() == 2);
  CHECK(p.file[0] == "a b.hier");
  CHECK(p.piece[0].where == "P:4");
  CHECK(p.piece[0].domain == "membrane");
  CHECK(p.piece[0].suffix == " x");
  CHECK(p.piece[0].residue == 0.5);
  REQUIRE(p.piece[0].copies.size() == 1);
  CHECK(p.piece[0].copies[0].is_identity());
  CHECK(p.piece[1].rename.at("A") == "B");
  CHECK(p.piece[1].carve == 2.5);
  CHECK(p.piece[1].chain == 2);
  CHECK(p.piece[1].domain_exponent == 0.1);
  REQUIRE(p.rule.size() == 1);
  CHECK(p.rule[0].selection == "//A");
  CHECK(p.rule[0].where == "P:6");
}

TEST_CASE("every sample of a plan is read") {
  for (const char* name : {"motions", "bodies"}) {
    std::ifstream in(MOLMESH_SOURCE_DIR "/formats/join/samples/passed/" + std::string(name) + ".join");
    const auto one = [](const std::string&, const std::string&, const std::string&) {
      return std::vector{Rigid{}};
    };
    CHECK(formats::read_join(in, name, one).piece.size() >= 4);
  }
}

TEST_CASE("motions act in order, each on the copies so far") {
  const auto copies = [](const std::string& keys) { return plan("join 1\npiece a.hier " + keys).piece[0].copies; };
  const Vec3d at{1, 2, 3};
  CHECK(copies("translate=1,0,0 rotate=0,0,1,90")[0](at) == Vec3d{-2, 2, 3});
  CHECK(copies("rotate=0,0,1,90 translate=1,0,0")[0](at) == Vec3d{-1, 1, 3});
  CHECK(copies("rotate=0,0,1,180,1,0,0")[0](at) == Vec3d{1, -2, 3});
  CHECK(copies("matrix=0,-1,0,1,0,0,0,0,1")[0](at) == Vec3d{-2, 1, 3});
  CHECK(copies("matrix=0,-1,0,10,1,0,0,20,0,0,1,30")[0](at) == Vec3d{8, 21, 33});
  const std::vector<Rigid> helix = copies("helix=4,2.5,90");
  REQUIRE(helix.size() == 4);
  CHECK(helix[0](at) == at);
  CHECK(helix[3](at) == Vec3d{2, -1, 10.5});
  CHECK(copies("helix=2,1,180,1,0,0,0,1,0")[1](at) == Vec3d{2, 0, -3});
  const std::vector<Rigid> lattice = copies("lattice=2,1,3,10,20,30");
  REQUIRE(lattice.size() == 6);
  CHECK(lattice[2](at) == Vec3d{1, 2, 63});
  CHECK(lattice[5](at) == Vec3d{11, 2, 63});
  CHECK(copies("lattice=2,2,1,1,1,0,0,1,1,0,0,1")[3](at) == Vec3d{2, 4, 4});
  const std::vector<Rigid> both = copies("helix=2,1,0 lattice=2,1,1,10,10,10");
  REQUIRE(both.size() == 4);
  CHECK(both[1](at) == Vec3d{1, 2, 4});
  CHECK(both[2](at) == Vec3d{11, 2, 3});
  CHECK(copies("\"assembly=x y.pdb:1\" translate=1,0,0")[1](at) == Vec3d{0, -2, 3});
}

TEST_CASE("what a plan may not say is refused in its line") {
  for (const char* keys : {"translate=1,2",
                           "translate=1,2,x",
                           "translate",
                           "rotate=0,0,0,90",
                           "rotate=0,0,1",
                           "matrix=1,0,0,0,1,0,0,0,2",
                           "matrix=1,0,0,0,1,0,0,0,-1",
                           "matrix=1,0,0,0,1,0.02,0,0,1",
                           "matrix=1,0,0",
                           "matrix=1,0,0,0,1,0,0,0,nan",
                           "helix=0,1,1",
                           "helix=1.5,1,1",
                           "helix=100001,1,1",
                           "helix=2,1,1,0,0,0",
                           "lattice=1,1,1",
                           "lattice=0,1,1,1,1,1",
                           "lattice=1000,1000,1000,1,1,1",
                           "lattice=400,1,1,1,1,1 helix=400,1,1",
                           "assembly=x",
                           "assembly=:1",
                           "domain=",
                           "domain=a domain=b",
                           "chains=A",
                           "chains=A:B,A:C",
                           "chains=A:C,B:C",
                           "chains=A:B:C",
                           "carve=0",
                           "carve=-1",
                           "carve=x",
                           "P_R=0",
                           "P_C=1001",
                           "what=1",
                           "=1",
                           "\"domain=a"}) {
    INFO(keys);
    const std::string what = refusal(keys);
    CHECK(what.substr(0, 5) == "P:2: ");
    CHECK(what.find("expected") != std::string::npos);
  }
  const auto whole = [](const std::string& text) { return test::refusal(Status::bad_input, [&] { plan(text); }); };
  CHECK(whole("") == "P:1: the file is empty, expected 'join 1'");
  CHECK(whole("join 2\npiece a\n") == "P:1: found 'join 2', expected 'join 1'");
  CHECK(whole("join 1\n") == "P: found no piece, expected at least one");
  CHECK(whole("join 1\npiece\n").substr(0, 4) == "P:2:");
  CHECK(whole("join 1\npieces a.hier\n") == "P:2: found 'pieces', expected piece, body or rule");
  CHECK(whole("join 1\npiece a\nrule //A\n").substr(0, 4) == "P:3:");
}

TEST_CASE("bodies without atoms are pieces of a plan") {
  const formats::JoinPlan p =
      plan("join 1\nbody ball sphere center=1,2,3 radius=5 P_R=0.5 domain=d translate=1,0,0\n"
           "body rod cylinder from=0,0,0 to=0,0,10 radius=4 skin=2 chain=R\n"
           "body pill capsule from=0,0,0 to=6,0,0 radius=2\n"
           "body brick box center=0,0,0 edges=10,20,30\n"
           "body film slab center=0,0,5 normal=0,0,-2 thickness=8 width=100\n");
  REQUIRE(p.body.size() == 5);
  const auto body = [&](size_t i) { return p.body[i].value(); };
  CHECK(p.file[0] == "ball");
  CHECK(p.piece[0].domain == "d");
  CHECK(p.piece[0].residue == 0.5);
  CHECK(p.piece[0].copies[0](body(0).center) == Vec3d{2, 2, 3});
  CHECK(body(0).size == 5);
  CHECK(body(0).skin == 1.7);
  CHECK(body(1).center == Vec3d{0, 0, 5});
  CHECK(body(1).u == Vec3d{0, 0, 5});
  CHECK(body(1).skin == 2);
  CHECK(p.piece[1].rename.at("rod") == "R");
  CHECK(body(2).u == Vec3d{3, 0, 0});
  CHECK(body(3).u == Vec3d{5, 0, 0});
  CHECK(body(3).v == Vec3d{0, 10, 0});
  CHECK(body(3).size == 15);
  CHECK(body(4).u == Vec3d{0, 0, -4});
  CHECK(body(4).size == 50);
  const Hierarchy h = hierarchy_of(body(1), "rod", {"chain", "residue"});
  CHECK_NOTHROW(check(h, "h"));
  CHECK(h.names[h.atom[0].name] == "rod");

  for (const char* line :
       {"rod", "rod tube radius=1", "rod cylinder from=0,0,0 radius=4", "rod cylinder from=0,0,0 to=0,0,0 radius=4",
        "rod cylinder from=0,0,0 to=0,0,10 radius=4 center=0,0,0", "ball sphere center=0,0,0 radius=0",
        "ball sphere center=0,0,0 radius=1", "ball sphere center=0,0,0 radius=5 radius=6", "ball sphere radius=5",
        "ball sphere center=0,0,0 radius=5 skin=-1", "film slab center=0,0,0 normal=0,0,0 thickness=9 width=9",
        "brick box center=0,0,0 edges=1,20,30", "ball sphere center=0,0,0 radius=5 carve=2",
        "ball sphere center=0,0,0 radius=5 chains=a:b"}) {
    INFO(line);
    const std::string what =
        test::refusal(Status::bad_input, [&] { plan(std::string("join 1\nbody ") + line + "\n"); });
    CHECK(what.substr(0, 5) == "P:2: ");
    CHECK(what.find("expected") != std::string::npos);
  }
}
