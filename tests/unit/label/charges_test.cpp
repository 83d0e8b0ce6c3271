// charges_test.cpp — atoms of radius 0 make no density and own no place: all is as without them, bit for bit.
#include "label/label.hpp"
#include "molecule/bodies.hpp"
#include "unit/density/completeness.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;

namespace {

/// A charge without a body after every third atom, a residue of such charges in every chain and a chain of them.
Hierarchy with_charges(const Hierarchy& h) {
  Hierarchy c;
  c.level = {{"chain", {}}, {"residue", {}}};
  const auto add_charge = [&](Vec3d p) { c.atom.push_back({p, 0, 0.4}); };
  const auto close = [](Level& level, const char* name, double exponent, int64_t begin, size_t end,
                        double weight = 1) {
    level.group.push_back({name, exponent, begin, static_cast<int64_t>(end), weight});
  };
  for (const Group& chain : h.level[0].group) {
    const auto first = static_cast<int64_t>(c.level[1].group.size());
    for (int64_t r = chain.begin; r < chain.end; ++r) {
      const Group& residue = h.level[1].group[r];
      const auto begin = static_cast<int64_t>(c.atom.size());
      for (int64_t a = residue.begin; a < residue.end; ++a) {
        c.atom.push_back(h.atom[a]);
        if (a % 3 == 0)
          add_charge(h.atom[a].center);
      }
      close(c.level[1], "r", residue.exponent, begin, c.atom.size(), residue.weight);
    }
    add_charge({50, 60, 70}); // beyond the grid of the bodies
    close(c.level[1], "charges", 4, static_cast<int64_t>(c.atom.size()) - 1, c.atom.size());
    close(c.level[0], "c", chain.exponent, first, c.level[1].group.size(), chain.weight);
  }
  add_charge({0, 0, 0});
  close(c.level[1], "charges", 4, static_cast<int64_t>(c.atom.size()) - 1, c.atom.size());
  close(c.level[0], "charges", 4, static_cast<int64_t>(c.level[1].group.size()) - 1, c.level[1].group.size());
  return c;
}

} // namespace

TEST_CASE("a charge without a body changes no density and owns no place") {
  const Hierarchy h = test::with_weights(test::random_chains(3, 12, 7, {0.3, 1}, 11), 4), c = with_charges(h);
  check(c, "c");
  CHECK(all_have_bodies(h));
  REQUIRE(!all_have_bodies(c));
  const Bodies bodies = bodies_of(c);
  check(bodies.hierarchy, "bodies");
  REQUIRE(bodies.hierarchy.atom.size() == h.atom.size());
  CHECK(bodies.hierarchy.level[0].group.size() == h.level[0].group.size());
  CHECK(bodies.hierarchy.level[1].group.size() == h.level[1].group.size());

  density::Options o;
  o.spacing = 0.9;
  const BlockGrid with = test::compute(c, o), without = test::compute(h, o);
  test::check_equal(with, without);
  CHECK(with.frame.points == without.frame.points);
  CHECK(with.info.atoms == without.info.atoms);

  std::vector<Vec3d> place;
  for (size_t a = 0; a < h.atom.size(); a += 2)
    place.push_back(h.atom[a].center + Vec3d{0, 0.3, 1});
  const label::Labels labels = label::find_labels(c, place, {}), plain = label::find_labels(h, place, {});
  CHECK(labels.share == plain.share);
  for (size_t l = 0; l < labels.index.size(); ++l)
    for (size_t i = 0; i < place.size(); ++i)
      REQUIRE(labels.index[l][i] == bodies.index[l][plain.index[l][i]]);
  for (size_t i = 0; i < place.size(); ++i)
    REQUIRE(c.atom[labels.index[2][i]].center == h.atom[plain.index[2][i]].center);
  CHECK(c.atom[nearest_atom(c, {50, 60, 70})].radius > 0);

  for (const size_t level : {size_t{0}, size_t{1}}) {
    const auto shares = label::ShareFinder(c, level, {}).at(place);
    const auto plain_shares = label::ShareFinder(h, level, {}).at(place);
    for (size_t i = 0; i < place.size(); ++i) {
      REQUIRE(shares[i].ln == plain_shares[i].ln);
      for (size_t k = 0; k < label::Shares::most; ++k)
        REQUIRE(shares[i].group[k] ==
                (plain_shares[i].group[k] < 0 ? -1 : bodies.index[level][plain_shares[i].group[k]]));
    }
  }
}
