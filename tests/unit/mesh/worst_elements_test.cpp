// worst_elements_test.cpp — the tetrahedra furthest beyond the quality asked for, and the atom that is nearest.
#include "mesh/worst_elements.hpp"
#include "molecule/hierarchy.hpp"
#include <catch2/catch.hpp>
#include <cmath>

using namespace molmesh;

TEST_CASE("the worst tetrahedra come first, and only those beyond the limits") {
  TetMesh m; // regular ones flattened more and more: their smallest angle falls, their largest grows
  for (int n = 0; n < 2000; ++n) {
    const auto v = static_cast<int32_t>(m.point.size());
    const double height = std::sqrt(2. / 3) * (1 - 0.0004 * ((n * 7) % 2000)), x = 3. * n;
    m.point.insert(m.point.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x + 0.5, std::sqrt(0.75), 0}});
    m.point.push_back({x + 0.5, std::sqrt(0.75) / 3, height});
    m.tet.push_back({v, v + 1, v + 2, v + 3});
    m.region.push_back(1);
  }
  const auto worst = worst_tets(m, {30, 180}, 5, 2);
  REQUIRE(worst.size() == 5);
  for (size_t i = 0; i < 5; ++i)
    CHECK((worst[i].tet * 7) % 2000 == 1999 - int64_t(i));
  CHECK(worst[0].min ==
        Approx(std::atan(std::sqrt(8.) * (1 - 0.0004 * 1999)) * 180 / 3.14159265358979).epsilon(1e-6));
  CHECK(worst[0].centre.x == Approx(3. * double(worst[0].tet) + 0.5));
  CHECK(worst_tets(m, {0, 180}, 5, 1).empty());
  CHECK(count_beyond(m, {30, 180}, 2) == static_cast<int64_t>(worst_tets(m, {30, 180}, m.tet.size(), 1).size()));
  CHECK(count_beyond(m, {0, 180}, 2) == 0);
  CHECK(worst_tets(m, {30, 180}, 5, 1).back().tet == worst.back().tet);
}

TEST_CASE("the nearest atom is that whose sphere is nearest, called by a selection that is it") {
  Hierarchy h;
  h.level = {{"chain", {{"A", 1, 0, 2}, {"B", 1, 2, 3}}},
             {"residue", {{"GLY:1", 1, 0, 2}, {"ALA:2", 1, 2, 3}, {"SER:-1", 1, 3, 4}}}};
  h.atom.resize(4);
  for (size_t i = 0; i < 4; ++i) {
    h.atom[i].center = {double(i), 0, 0};
    h.atom[i].radius = i == 3 ? 0.9 : 0.1;
  }
  CHECK(nearest_atom(h, {0.2, 0, 0}) == 0);
  CHECK(nearest_atom(h, {1.9, 0, 0}) == 2);
  CHECK(nearest_atom(h, {2.2, 0, 0}) == 3);
  CHECK(place_of(h, 1) == "//A/1(GLY)/X");
  CHECK(place_of(h, 2) == "//A/2(ALA)/X");
  CHECK(place_of(h, 3) == "//B/-1--1(SER)/X");
  CHECK(nearest_name(h, {2.2, 0, 0}) == place_of(h, 3));
  h.level.insert(h.level.begin(), {"domain", {{"one", 1, 0, 2}}});
  CHECK(place_of(h, 1) == "domain one //A/1(GLY)/X");
  h.level = {h.level[2]};
  CHECK(place_of(h, 2) == "//*/2(ALA)/X");
  h.level = {{"chain", {{"B 1", 1, 0, 4}}}};
  CHECK(place_of(h, 2) == "//\"B 1\"//X");
  h.level.clear();
  CHECK(place_of(h, 2) == "X");
}
