// distance_test.cpp — distances to molecular surfaces against trying every place, on clouds of atoms and on those
// whose spheres meet in many places at once.
#include "distance/distance.hpp"
#include "unit/distance/oracle.hpp"
#include "unit/distance/sampled.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using distance::Surface;

namespace {

BlockGrid compute(const Hierarchy& h, const distance::Body& body, const density::Options& o) {
  density::Counts counts;
  return to_block_grid(distance::compute(h, body, o, counts), 1);
}

Hierarchy atoms(const std::vector<std::pair<Vec3d, double>>& list) {
  Hierarchy h;
  for (const auto& [center, radius] : list) {
    h.atom.emplace_back();
    h.atom.back().center = center;
    h.atom.back().radius = radius;
  }
  return h;
}

Hierarchy cloud(int n, double width, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<std::pair<Vec3d, double>> list;
  for (int i = 0; i < n; ++i)
    list.push_back({{width * u(random), width * u(random), width * u(random)}, 1 + u(random)});
  return atoms(list);
}

const std::vector<distance::Body> bodies = {{Surface::van_der_waals, 0},      {Surface::solvent_accessible, 1.4},
                                            {Surface::solvent_excluded, 1.4}, {Surface::solvent_excluded, 0.5},
                                            {Surface::solvent_excluded, 0},   {Surface::solvent_excluded, 3}};

/// Every point of the grid: values, sides, and active points exactly on the corners of band cells.
void check(const Hierarchy& h, const distance::Body& body, density::Options o) {
  INFO("surface " << int(body.surface) << ", probe " << body.probe << ", spacing " << o.spacing);
  const test::SurfaceOracle oracle(h, body);
  const BlockGrid g = compute(h, body, o);
  const BlockIndex index(g);
  const Vec3i n = g.frame.points;
  const auto at = [&](int x, int y, int z) { return size_t((x * n.y + y) * n.z + z); };
  std::vector<double> d(at(n.x - 1, n.y - 1, n.z - 1) + 1);
  for (int x = 0; x < n.x; ++x)
    for (int y = 0; y < n.y; ++y)
      for (int z = 0; z < n.z; ++z)
        d[at(x, y, z)] = oracle.distance(g.frame.position(g.frame.lower + Vec3i{x, y, z}));
  std::vector<char> surely(d.size()), maybe(d.size());
  const double slack = 1e-5, lower = std::log(o.band_lower), upper = std::log(o.band_upper);
  for (int x = 0; x + 1 < n.x; ++x)
    for (int y = 0; y + 1 < n.y; ++y)
      for (int z = 0; z + 1 < n.z; ++z) {
        double lo = 1e300, hi = -1e300;
        for (int c = 0; c < 8; ++c) {
          const double v = d[at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))];
          lo = std::min(lo, v);
          hi = std::max(hi, v);
        }
        for (int c = 0; c < 8; ++c) {
          const size_t p = at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
          surely[p] |= lo <= upper - slack && hi >= lower + slack;
          maybe[p] |= lo <= upper + slack && hi >= lower - slack;
        }
      }
  int64_t missed = 0, extra = 0, wrong_side = 0, active = 0;
  double worst = 0;
  for (int x = 0; x < n.x; ++x)
    for (int y = 0; y < n.y; ++y)
      for (int z = 0; z < n.z; ++z) {
        const Vec3i p = g.frame.lower + Vec3i{x, y, z};
        const double exact = d[at(x, y, z)], v = value_at(g, index, p);
        if (is_active(g, index, p)) {
          ++active;
          extra += !maybe[at(x, y, z)];
          worst = std::max(worst, std::abs(v - std::exp(exact)) / std::max(1.0, std::exp(exact)));
        } else {
          missed += surely[at(x, y, z)];
          wrong_side += v != (exact > 0 ? float(g.info.inside_value) : 0.0f);
        }
      }
  CHECK(active > 0);
  CHECK(missed == 0);
  CHECK(extra == 0);
  CHECK(wrong_side == 0);
  CHECK(worst <= o.tolerance);
}

} // namespace

TEST_CASE("distances to the surfaces of clouds of atoms are those of the nearest place") {
  for (const unsigned seed : {1u, 2u, 3u})
    for (const distance::Body& body : bodies) {
      density::Options o;
      o.spacing = seed == 1 ? 0.7 : seed == 2 ? 1.1 : 2.3;
      o.tolerance = 1e-6;
      check(cloud(6 + 5 * int(seed), 3.0 + 2 * seed, seed), body, o);
    }
}

TEST_CASE("spheres that meet in one place, coincide, touch or lie within each other keep the nearest place") {
  using List = std::vector<std::pair<Vec3d, double>>;
  const double s = 1.5;
  std::vector<List> lists = {
      {{{0, 0, 0}, 1.5}},
      {{{0, 0, 0}, 1.5}, {{0, 0, 0}, 1.5}, {{0, 0, 0}, 1.2}},             // coincident, concentric
      {{{0, 0, 0}, 1.5}, {{0.3, 0, 0}, 1}, {{0.5, 0, 0}, 1}},             // within, touching from within
      {{{0, 0, 0}, 1.5}, {{3, 0, 0}, 1.5}},                               // touching
      {{{0, 0, 0}, 1.5}, {{5.8, 0, 0}, 1.5}},                             // touching with the probe
      {{{-s, 0, 0}, 2}, {{s, 0, 0}, 2}, {{0, -s, 0}, 2}, {{0, s, 0}, 2}}, // a square: two places with four
      {{{-s, 0, 0}, 1}, {{s, 0, 0}, 1}, {{0, -s, 0}, 1}, {{0, s, 0}, 1}, {{0, 0, -s}, 1}, {{0, 0, s}, 1}},
      {{{0, 0, 0}, 2}, {{0, 0, 1}, std::sqrt(5.0)}, {{0, 0, -1}, std::sqrt(5.0)}}, // three through one circle
      {{{0, 0, 0}, 1}, {{2, 0, 0}, 1}, {{1, std::sqrt(3.0), 0}, 1}},               // three that touch
      {{{1e-9, 0, 0}, 1.5}, {{0, 0, 0}, 1.5}, {{0, 1e-12, 0}, 1.5}},               // nearly the same
      {{{0, 0, 0}, 1.5}, {{1.7, 0, 0}, 0}, {{2, 0, 0}, 1}}};                       // no body in the middle
  List cube;
  for (int c = 0; c < 8; ++c)
    cube.push_back({{2.0 * (c & 1), 2.0 * (c >> 1 & 1), 2.0 * (c >> 2)}, std::sqrt(3.0)}); // eight in one place
  lists.push_back(cube);
  for (const List& list : lists)
    for (const distance::Body& body : bodies)
      for (const double spacing : {0.5, 1.0}) {
        INFO("list " << &list - lists.data());
        density::Options o;
        o.spacing = spacing;
        o.margin = spacing * std::ceil(5 / spacing); // grid points on the planes of symmetry
        o.tolerance = 1e-6;
        check(atoms(list), body, o);
      }
}

TEST_CASE("the solvent-excluded body is what no probe reaches, by probes all over the atoms") {
  const double step = 0.06;
  for (const double probe : {1.4, 0.7}) {
    const Hierarchy h = cloud(30, 8, 11);
    const test::SampledSurface sampled(h, probe, step);
    density::Options o;
    o.spacing = 0.55;
    const BlockGrid g = compute(h, {Surface::solvent_excluded, probe}, o);
    double lowest = 1e300, highest = -1e300;
    for (size_t b = 0; b < g.corner.size(); ++b)
      for (size_t s = 0; s < 512; s += 5)
        if (g.active[8 * b + (s >> 6)] >> (s & 63) & 1) {
          const double there = std::log(double(g.value[512 * b + s])), most = 1.5;
          const double off =
              sampled.distance(g.frame.position(g.corner[b] + within_block(static_cast<int>(s))), most) -
              std::min(there, most);
          lowest = std::min(lowest, off);
          highest = std::max(highest, off);
        }
    CHECK(lowest > -1e-4); // the tolerance of the values
    CHECK(highest < step); // the nearest place may be one that is not taken
  }
}

TEST_CASE("distances of tiles are those of the whole grid") {
  const Hierarchy h = cloud(150, 14, 5);
  for (const distance::Body& body : bodies)
    for (const double h_grid : {0.2, 0.7}) {
      density::Options o;
      o.spacing = h_grid;
      const BlockGrid whole = compute(h, body, o);
      const int32_t count = h_grid < 0.5 ? 3 : 2;
      INFO("surface " << int(body.surface) << ", probe " << body.probe << ", spacing " << o.spacing);
      size_t blocks = 0, inside = 0;
      int64_t points = 0;
      for (int32_t number = 1; number <= count; ++number) {
        o.tile = {number, count};
        o.threads = number;
        const BlockGrid tile = compute(h, body, o);
        for (const Vec3i& c : tile.inside)
          REQUIRE(std::binary_search(whole.inside.begin(), whole.inside.end(), c));
        for (size_t b = 0; b < tile.corner.size(); ++b) {
          const auto at = std::lower_bound(whole.corner.begin(), whole.corner.end(), tile.corner[b]);
          REQUIRE((at != whole.corner.end() && *at == tile.corner[b]));
          const auto w = static_cast<size_t>(at - whole.corner.begin());
          REQUIRE(std::equal(&tile.value[512 * b], &tile.value[512 * b] + 512, &whole.value[512 * w]));
          REQUIRE(std::equal(&tile.active[8 * b], &tile.active[8 * b] + 8, &whole.active[8 * w]));
        }
        blocks += tile.corner.size();
        inside += tile.inside.size();
        points += tile.info.analyzed_points;
      }
      CHECK(blocks == whole.corner.size());
      CHECK(inside == whole.inside.size());
      CHECK(points == whole.info.analyzed_points);
    }
}
