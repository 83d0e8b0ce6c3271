// hierarchy_test.cpp — check() finds each broken rule.
#include "base/error.hpp"
#include "molecule/bodies.hpp"
#include "molecule/hierarchy.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;

namespace {

Hierarchy good() {
  Hierarchy h;
  h.level = {{"chain", {{"A", 1, 0, 1}, {"B", 1, 1, 3}}},
             {"residue", {{"G:1", 0.5, 0, 2}, {"G:1", 0.5, 2, 3}, {"G:2", 0.5, 3, 4}}}};
  for (int i = 0; i < 4; ++i)
    h.atom.push_back({{1.0 * i, 0, 0}, 1.5});
  return h;
}

template <class Break>
std::string broken(Break b) {
  Hierarchy h = good();
  b(h);
  return test::refusal(Status::bad_input, [&] { check(h, "F"); });
}

} // namespace

TEST_CASE("check accepts a partition and finds what breaks it") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  CHECK(broken([](Hierarchy&) {}).empty());
  CHECK(broken([](Hierarchy& h) { h.level.clear(); }).empty());
  CHECK(broken([](Hierarchy& h) { h.atom.clear(); }) == "F: no atom, expected at least one");
  CHECK(broken([](Hierarchy& h) { h.level[0].group[1].begin = 2; }) ==
        "F: chain 'B': begins at child 2, expected 1");
  CHECK(broken([](Hierarchy& h) { h.level[1].group[2].end = 3; }) ==
        "F: residue 'G:2': is empty, expected at least one child");
  CHECK(broken([](Hierarchy& h) { h.atom.push_back(h.atom[0]); }) ==
        "F: level 'residue' covers 4 of 5 children, expected all");
  CHECK_FALSE(broken([](Hierarchy& h) { h.level[0].group[0].exponent = 0; }).empty());
  CHECK_FALSE(broken([](Hierarchy& h) { h.level[0].group[0].exponent = inf; }).empty());
  CHECK_FALSE(broken([](Hierarchy& h) { h.level[0].group[0].name.clear(); }).empty());
  CHECK_FALSE(broken([](Hierarchy& h) { h.level[1].name = "chain"; }).empty());
  CHECK(broken([](Hierarchy& h) { h.atom[2].center.y = nan; }) == "F: atom 2: position not finite");
  CHECK(broken([](Hierarchy& h) { h.atom[2].radius = -1; }) == "F: atom 2: radius not a finite number >= 0");
  CHECK(broken([](Hierarchy& h) { h.atom[2].charge = inf; }) == "F: atom 2: charge not finite");
  CHECK(broken([](Hierarchy& h) { h.atom[2].element = 1; }) == "F: atom 2: no element");
  CHECK(broken([](Hierarchy& h) { h.atom[0].center = {1e308, 1e308, 1e308}; }).empty());
}

TEST_CASE("a name has one entry") {
  Names names;
  CHECK(names[0] == "X");
  const int32_t ca = names.add("CA");
  CHECK(names.add("CA") == ca);
  CHECK(names.add("X") == 0);
  CHECK(names[ca] == "CA");
  CHECK(names.size() == 2);
}

TEST_CASE("names: each text has one entry and stays where it is") {
  Names names;
  CHECK(names[0] == "X");
  std::vector<const std::string*> at;
  for (int32_t i = 0; i < 5000; ++i) {
    const std::string text = "a name of many letters, number " + std::to_string(i);
    REQUIRE(names.add(text) == i + 1);
    REQUIRE(names.add(text) == i + 1);
    at.push_back(&names[i + 1]);
  }
  CHECK(names.size() == 5001);
  CHECK(names.add("X") == 0);
  const Names copy = names, moved = std::move(names);
  for (int32_t i = 0; i < 5000; ++i) {
    REQUIRE(&moved[i + 1] == at[i]);
    REQUIRE(copy[i + 1] == *at[i]);
  }
}
