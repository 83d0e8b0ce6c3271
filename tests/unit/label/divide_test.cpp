// divide_test.cpp — regions of arbitrary owners are manifolds that fill the molecule; interfaces have equal shares.
#include "label/divide.hpp"
#include "label/equal_shares.hpp"
#include "mesh/region_order.hpp"
#include "mesh/validity.hpp"
#include "unit/mesh/meshes.hpp"
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

using namespace molmesh;

namespace {

/// One level, one atom of radius r at each place.
Hierarchy domains_of(const std::vector<std::vector<Vec3d>>& place, double r) {
  Hierarchy h;
  h.level.push_back({"domain", {}});
  for (const auto& of_domain : place) {
    const auto begin = static_cast<int64_t>(h.atom.size());
    for (const Vec3d& p : of_domain)
      h.atom.push_back({p, r});
    h.level[0].group.push_back(
        {"d" + std::to_string(h.level[0].group.size()), 1, begin, static_cast<int64_t>(h.atom.size())});
  }
  return h;
}

/// As density2tet names them: the order of regions needs it.
void name_regions(TetMesh& m, const label::Division& d) {
  std::string names;
  for (const int32_t g : d.group)
    names += std::to_string(label::first_domain + g) + " d" + std::to_string(g) + '\n';
  m.named_text.push_back({region_level_text, "domain"});
  m.named_text.push_back({region_names_text, names});
}

void require_valid(const TetMesh& m) {
  const Validity v = check_validity(m, 2);
  for (const Fault& f : v.faults)
    UNSCOPED_INFO(f.rule << " " << f.count << " " << f.example);
  REQUIRE(v.valid());
}

double volume(const TetMesh& m) {
  return check_validity(m, 1).volume;
}

} // namespace

TEST_CASE("Whatever the owners of the vertices, each region's boundary is a closed manifold") {
  std::mt19937 random(7);
  for (int trial = 0; trial < 12; ++trial) {
    const int n = 5, groups = 2 + trial % 5;
    const bool alone = trial % 3 == 0;
    TetMesh m = testing::cubes(n, [&](Vec3i c) {
      const bool in = c.x > 0 && c.y > 0 && c.z > 0 && c.x < n - 1 && c.y < n - 1 && c.z < n - 1;
      return alone || in ? molecule : outside;
    });
    std::vector<std::vector<Vec3d>> place(static_cast<size_t>(groups));
    for (const Vec3d& p : m.point)
      place[random() % place.size()].push_back(p);
    const label::ShareFinder shares(domains_of(place, 0.3), 0, {8, 1, 2});
    const double before = volume(m);
    std::vector<int32_t> owner;
    for (const label::Shares& s : shares.at(m.point))
      owner.push_back(s.owner());
    const size_t points = m.point.size();
    const label::Division d = label::divide(m, shares, 2);
    name_regions(m, d);
    INFO("trial " << trial);
    CHECK(d.group.size() == place.size());
    require_valid(m);
    CHECK(volume(m) == Approx(before).epsilon(1e-12));
    for (size_t t = 0; t < m.tet.size(); ++t)
      for (const int32_t v : m.tet[t])
        if (static_cast<size_t>(v) < points && m.region[t] >= label::first_domain)
          REQUIRE(m.region[t] == label::first_domain + owner[v]);
    const auto interfaces = label::interfaces_of(m);
    REQUIRE(interfaces.size() == d.between.size());
    for (const auto& [l, pair] : d.between)
      CHECK(interfaces.at(l).group == pair);
  }
}

TEST_CASE("Two equal atoms share the molecule at the plane between them, whichever tetrahedra it cuts") {
  TetMesh m = testing::cubes(4, testing::all_molecule);
  const Vec3d a{0.3, 1.1, 2.4}, b{3.4, 2.9, 1.2}, middle = 0.5 * (a + b);
  const label::ShareFinder shares(domains_of({{a}, {b}}, 1.5), 0, {0.5, 1, 1});
  const label::Division d = label::divide(m, shares, 1);
  name_regions(m, d);
  require_valid(m);
  REQUIRE(d.between.size() == 1);
  size_t triangles = 0, in_plane = 0;
  const Vec3d n = (b - a) / norm(b - a);
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (m.boundary[t] == d.between.begin()->first) {
      ++triangles;
      for (const int32_t v : m.tri[t]) {
        in_plane += std::abs(dot(m.point[v] - middle, n)) < 1e-9;
        CHECK(std::abs(dot(m.point[v] - middle, n)) < 0.2);
      }
      const Vec3d p = m.point[m.tri[t][0]];
      CHECK(dot(cross(m.point[m.tri[t][1]] - p, m.point[m.tri[t][2]] - p), n) > 0);
    }
  CHECK(triangles > 30);
  CHECK(double(in_plane) > 2.4 * double(triangles)); // others keep a tenth of their edge from its ends
}

TEST_CASE("Shares of a level are parts of the whole, the largest first, as labels have them") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> at(0, 6);
  const auto somewhere = [&] { return Vec3d{at(random), at(random), at(random)}; };
  std::vector<std::vector<Vec3d>> domain(3);
  for (auto& of : domain)
    for (int i = 0; i < 12; ++i)
      of.push_back(somewhere());
  Hierarchy h = domains_of(domain, 1.6);
  h.level.push_back({"residue", {}}); // of three atoms each
  for (int64_t a = 0; a < 36; a += 3)
    h.level[1].group.push_back({"r", 0.4, a, a + 3});
  for (size_t g = 0; g < 3; ++g)
    h.level[0].group[g] = {h.level[0].group[g].name, 0.8, static_cast<int64_t>(4 * g),
                           static_cast<int64_t>(4 * g + 4)};
  std::vector<Vec3d> place;
  for (int i = 0; i < 500; ++i)
    place.push_back(somewhere());
  const label::Options options{1, 1, 2};
  const label::Labels labels = label::find_labels(h, place, options);
  for (const size_t level : {size_t{0}, size_t{1}}) {
    const auto shares = label::ShareFinder(h, level, options).at(place);
    for (size_t i = 0; i < place.size(); ++i) {
      double sum = 0;
      for (size_t k = 0; k < label::Shares::most; ++k) {
        sum += shares[i].group[k] < 0 ? 0 : std::exp(shares[i].ln[k]);
        CHECK((k == 0 || shares[i].ln[k] <= shares[i].ln[k - 1]));
      }
      CHECK(sum <= 1 + 1e-9);
      if (level == 0) {
        CHECK(sum == Approx(1).margin(1e-6));
        CHECK(shares[i].owner() == labels.index[0][i]);
        CHECK(std::exp(shares[i].ln[0]) == Approx(labels.share[0][i]).margin(1e-9));
      } else {
        CHECK(std::exp(shares[i].ln_of(labels.index[1][i])) == Approx(labels.share[1][i]).margin(1e-9));
        CHECK(shares[i].ln[0] >= std::log(labels.share[1][i]) - 1e-9);
      }
    }
  }
}

TEST_CASE("The owner of a place has the largest share by direct sums, bodies without atoms among them") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(0, 9);
  const auto somewhere = [&] { return Vec3d{at(random), at(random), at(random)}; };
  Hierarchy h; // domains: two of residues of three atoms, a ball, and a cylinder along z
  h.level = {{"domain", {}}, {"residue", {}}};
  const std::vector<double> exponent{0.8, 1.3, 1, 0.6};
  const Body ball{Body::Shape::sphere, {3, 4, 5}, {}, {}, 2.4, 1.1, 24};
  const Body rod{Body::Shape::cylinder, {6, 5, 4}, {0, 0, 2.5}, {}, 1.9, 0.9, 25};
  for (int i = 0; i < 24; ++i)
    h.atom.push_back({somewhere(), 1.4});
  h.atom.push_back({ball.center, ball.skin});
  h.atom.push_back({rod.center, rod.skin});
  h.body = {ball, rod};
  for (int64_t a = 0; a < 24; a += 3)
    h.level[1].group.push_back({"r", 0.5, a, a + 3});
  h.level[1].group.push_back({"ball", 1, 24, 25});
  h.level[1].group.push_back({"rod", 0.7, 25, 26});
  const std::vector<int64_t> first{0, 4, 8, 9, 10}; // residues of the domains
  for (size_t d = 0; d < 4; ++d)
    h.level[0].group.push_back({"d" + std::to_string(d), exponent[d], first[d], first[d + 1]});
  check(h, "h");

  const double decay = 0.9;
  const auto square = [](double x) { return x > 0 ? x * x : 0; };
  const auto term = [&](int64_t a, Vec3d p) {
    const Vec3d v = p - h.atom[a].center;
    double d2 = norm2(v);
    if (a == 24)
      d2 = square(norm(v) - (ball.size - ball.skin));
    if (a == 25)
      d2 = square(std::hypot(v.x, v.y) - (rod.size - rod.skin)) + square(std::abs(v.z) - (2.5 - rod.skin));
    return std::exp(decay * (h.atom[a].radius * h.atom[a].radius - d2));
  };
  std::vector<Vec3d> place;
  for (int i = 0; i < 3000; ++i)
    place.push_back(somewhere());
  const auto shares = label::ShareFinder(h, 0, {decay, 1, 2}).at(place);
  std::vector<int> owned(4);
  for (size_t i = 0; i < place.size(); ++i) {
    std::vector<double> f(4);
    for (size_t d = 0; d < 4; ++d) {
      double sum = 0;
      for (int64_t r = first[d]; r < first[d + 1]; ++r) {
        const Group& residue = h.level[1].group[r];
        double atoms = 0;
        for (int64_t a = residue.begin; a < residue.end; ++a)
          atoms += term(a, place[i]);
        sum += std::pow(atoms, residue.exponent);
      }
      f[d] = std::pow(sum, exponent[d]);
    }
    const double all = std::accumulate(f.begin(), f.end(), 0.);
    const auto best = static_cast<int32_t>(std::max_element(f.begin(), f.end()) - f.begin());
    REQUIRE(shares[i].owner() == best);
    for (int32_t d = 0; d < 4; ++d)
      if (f[d] > 1e-6 * all)
        REQUIRE(shares[i].ln_of(d) == Approx(std::log(f[d] / all)).margin(1e-6));
    ++owned[static_cast<size_t>(best)];
  }
  for (const int n : owned)
    CHECK(n > 50);
}

TEST_CASE("The ratio of two shares is 1 where they are equal, and known near the places asked for") {
  const Vec3d a{0, 0, 0}, b{4, 0, 0};
  const label::ShareFinder shares(domains_of({{a}, {b}}, 2), 0, {0.7, 1, 1});
  GridFrame frame;
  frame.spacing = 0.5;
  const BlockGrid grid = label::share_ratio(shares, 0, 1, frame, {{2, 0.1, 0.2}}, 1, 2);
  const BlockIndex index(grid);
  for (int y = -2; y <= 2; ++y)
    for (int x = 2; x <= 6; ++x) {
      REQUIRE(is_active(grid, index, {x, y, 0}));
      CHECK(std::log(value_at(grid, index, {x, y, 0})) == Approx(0.7 * 4 * (4 - x)).margin(1e-4));
    }
}
