// label_test.cpp — labels and shares against the tree of sums computed term by term.
#include "label/label.hpp"
#include "unit/density/oracle.hpp"
#include <catch2/catch.hpp>
#include <hwy/targets.h>

using namespace molmesh;

namespace {

/// ln of the term of child i of level l: F of a group, or an atom's term.
double ln_term(const Hierarchy& h, size_t l, int64_t i, double decay, Vec3d p) {
  const auto s = static_cast<size_t>(i);
  if (l == h.level.size())
    return -decay * (test::term_distance2(h, i, p) - h.atom[s].radius * h.atom[s].radius);
  const Group& g = h.level[l].group[s];
  return g.exponent * (std::log(g.weight) + test::log_children(h, l + 1, g.begin, g.end, decay, p));
}

/// The label by its definition, checked with what was found. Near ties either is right.
void check_place(const Hierarchy& h, const label::Labels& found, size_t place, double decay, Vec3d p,
                 double within) {
  int64_t begin = 0, end = static_cast<int64_t>(h.level.empty() ? h.atom.size() : h.level[0].group.size());
  double ln_share = 0;
  for (size_t l = 0; l <= h.level.size(); ++l) {
    const double ln_sum = test::log_children(h, l, begin, end, decay, p);
    int64_t best = begin;
    for (int64_t i = begin; i < end; ++i)
      if (ln_term(h, l, i, decay, p) > ln_term(h, l, best, decay, p))
        best = i;
    const int64_t index = found.index[l][place];
    REQUIRE(index >= begin);
    REQUIRE(index < end);
    if (index != best)
      CHECK(ln_term(h, l, index, decay, p) == Approx(ln_term(h, l, best, decay, p)).margin(1e-9));
    ln_share += ln_term(h, l, index, decay, p) - ln_sum;
    CHECK(found.share[l][place] == Approx(std::exp(ln_share)).margin(within));
    if (l == h.level.size())
      return;
    begin = h.level[l].group[index].begin;
    end = h.level[l].group[index].end;
  }
}

std::vector<Vec3d> places_near(const Hierarchy& h, int n, double spread, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> step(0, spread);
  std::vector<Vec3d> place;
  for (int i = 0; i < n; ++i)
    place.push_back(h.atom[random() % h.atom.size()].center + Vec3d{step(random), step(random), step(random)});
  return place;
}

} // namespace

TEST_CASE("Labels and shares are those of the sums, at any depth and with any exponents") {
  const std::vector<std::vector<double>> exponents = {
      {}, {0.3}, {0.3, 1}, {0.5, 0.2}, {0.05, 0.5}, {0.3, 1, 0.5}, {0.7, 1.5}, {2, 1, 1}, {0.8, 0.2}, {1.5, 0.3}};
  unsigned seed = 1;
  for (const std::vector<double>& e : exponents) {
    INFO("levels " << e.size());
    Hierarchy h = test::random_chains(4, 12, 6, e, seed++);
    if (seed % 2 == 0)
      h = test::with_weights(h, seed);
    double power = 1;
    for (const double p : e)
      power *= std::min(p, 1.0);
    for (const double decay : {1.0, 0.4, 0.15}) {
      std::vector<Vec3d> place = places_near(h, 150, 1.5, seed), far = places_near(h, 50, 30, seed + 1);
      place.insert(place.end(), far.begin(), far.end());
      const label::Labels found = label::find_labels(h, place, {decay, 1, 2});
      REQUIRE(found.level.size() == e.size() + 1);
      CHECK(found.level.back() == "atom");
      for (size_t i = 0; i < place.size(); ++i) {
        check_place(h, found, i, decay, place[i], 1e-6 / power);
        const size_t n = h.level.empty() ? h.atom.size() : h.level[0].group.size();
        const double exact = test::log_children(h, 0, 0, static_cast<int64_t>(n), decay, place[i]);
        CHECK(found.ln_field[i] == Approx(exact).margin(1e-6));
      }
    }
  }
}

TEST_CASE("Labels do not depend on the number of threads, nor on the isovalue beyond their error") {
  const Hierarchy h = test::random_chains(3, 40, 7, {0.3, 1}, 7);
  const std::vector<Vec3d> place = places_near(h, 5000, 2, 8);
  const label::Labels one = label::find_labels(h, place, {1, 1, 1}), five = label::find_labels(h, place, {1, 1, 5}),
                      other = label::find_labels(h, place, {1, 100, 1});
  for (size_t l = 0; l < one.level.size(); ++l) {
    CHECK(one.index[l] == five.index[l]);
    CHECK(one.share[l] == five.share[l]);
    for (size_t i = 0; i < place.size(); ++i)
      CHECK(other.share[l][i] == Approx(one.share[l][i]).margin(4e-6));
  }
}

TEST_CASE("Every instruction set of this machine finds the same labels") {
  const Hierarchy h = test::with_bodies(test::random_chains(4, 20, 9, {0.4, 1.2}, 21));
  const std::vector<Vec3d> place = places_near(h, 500, 4, 22);
  const label::Labels best = label::find_labels(h, place, {0.3, 1, 1});
  const int64_t here = hwy::SupportedTargets();
  for (const int64_t set : {HWY_SCALAR, HWY_SSE4, HWY_AVX2, HWY_AVX3}) {
    if (set != HWY_SCALAR && !(here & set))
      continue;
    hwy::SetSupportedTargetsForTest(set);
    const label::Labels found = label::find_labels(h, place, {0.3, 1, 1});
    for (size_t l = 0; l < best.level.size(); ++l) {
      CHECK(found.index[l] == best.index[l]);
      for (size_t i = 0; i < place.size(); ++i)
        CHECK(found.share[l][i] == Approx(best.share[l][i]).margin(1e-9));
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST_CASE("Shares do not depend on which other places are asked for, near atoms and far from all") {
  const Hierarchy h = test::random_chains(4, 20, 6, {0.5, 1.2}, 5);
  std::vector<Vec3d> place = places_near(h, 400, 5, 6);
  const label::ShareFinder finder(h, 0, {0.6, 1, 2});
  const std::vector<label::Shares> together = finder.at(place);
  int far = 0;
  for (size_t i = 0; i < place.size(); ++i) {
    const label::Shares alone = finder.at({place[i]}).front();
    CHECK(together[i].group == alone.group);
    CHECK(together[i].ln_field == Approx(alone.ln_field).margin(1e-6));
    for (size_t k = 0; k < label::Shares::most; ++k)
      if (alone.ln[k] > -12)
        CHECK(together[i].ln[k] == Approx(alone.ln[k]).margin(1e-3));
    far += alone.ln_field < -3;
  }
  CHECK(far > 20);
  CHECK(far < 380);
}

TEST_CASE("Labels by slow kernels, part of them sharpened, are those of the sums") {
  for (const std::vector<double>& e : {std::vector<double>{0.8, 0.3}, {1, 0.5}}) {
    Hierarchy h = test::random_chains(12, 40, 8, e, 11);
    for (Group& g : h.level[0].group) // far apart: most groups matter to few places
      for (int64_t r = g.begin; r < g.end; ++r)
        for (int64_t a = h.level[1].group[r].begin; a < h.level[1].group[r].end; ++a)
          h.atom[a].center.x += 12. * static_cast<double>(&g - h.level[0].group.data());
    h.level[0].group[3].exponent = 1.5;
    for (int64_t r = h.level[0].group[3].begin; r < h.level[0].group[3].end; ++r)
      h.level[1].group[r].exponent = 2;
    const std::vector<Vec3d> place = places_near(h, 600, 3, 12);
    const label::Labels found = label::find_labels(h, place, {0.15, 1, 2});
    for (size_t i = 0; i < place.size(); ++i)
      check_place(h, found, i, 0.15, place[i], 1e-6 / (e[0] * e[1]));
  }
}

TEST_CASE("Bodies without atoms have labels like atoms") {
  for (const std::vector<double>& e : {std::vector<double>{0.3, 1}, {0.5, 0.2}, {}}) {
    const Hierarchy h = test::with_bodies(test::random_chains(3, 10, 6, e, 3));
    const std::vector<Vec3d> place = places_near(h, 400, 6, 4);
    const label::Labels found = label::find_labels(h, place, {1, 1, 2});
    double within = 1e-6;
    for (const double p : e)
      within /= std::min(p, 1.0);
    int of_bodies = 0;
    for (size_t i = 0; i < place.size(); ++i) {
      check_place(h, found, i, 1, place[i], within);
      of_bodies += found.index.back()[i] >= h.body.front().atom;
    }
    CHECK(of_bodies > 20);
  }
}

TEST_CASE("Nothing underflows far from every atom, and of equal structures the first is taken") {
  Hierarchy h;
  h.level = {{"chain", {{"A", 1, 0, 1}, {"B", 1, 1, 2}}}, {"residue", {{"X:1", 0.3, 0, 2}, {"X:2", 0.3, 2, 4}}}};
  h.atom = {{{1, 0, 0}, 1.5}, {{-1, 0, 0}, 1.5}, {{0, 1, 0}, 1.5}, {{0, -1, 0}, 1.5}};
  const label::Labels l = label::find_labels(h, {{0, 0, 0}, {0, 0, 1000}, {300, 0, 0}, {1e200, 0, 0}}, {1, 1, 1});
  for (size_t level = 0; level < 3; ++level) {
    CHECK(l.index[level][0] == 0);
    CHECK(l.index[level][1] == 0);
    CHECK(l.share[level][1] == Approx(level == 2 ? 0.25 : 0.5));
    CHECK(l.index[level][2] == 0);
    CHECK(l.share[level][2] == Approx(1));
    CHECK(l.index[level][3] == -1); // squares of such distances are no doubles
    CHECK(l.share[level][3] == 0);
  }
  CHECK(l.ln_field[1] == Approx(-0.3 * 1e6).epsilon(1e-5));
}
