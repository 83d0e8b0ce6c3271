// from_map_test.cpp — densities of maps: the same surface, complete, on their own lattice and on others.
#include "compose/from_map.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>
#include <cmath>

using namespace molmesh;
using compose::DenseMap;

namespace {

/// Two bumps; level 1 is a closed surface.
double field(Vec3d p) {
  return 3 * std::exp(-norm2(p - Vec3d{1, 0, 0}) / 18) + 2 * std::exp(-norm2(p - Vec3d{-5, 3, 1}) / 12);
}

DenseMap sampled(Vec3i points, Vec3d a, Vec3d b, Vec3d c) {
  DenseMap m;
  m.points = points;
  m.axis[0] = a, m.axis[1] = b, m.axis[2] = c;
  m.origin =
      -0.5 * (double(points.x - 1) * a + double(points.y - 1) * b + double(points.z - 1) * c) + Vec3d{-2, 1, 0.5};
  for (int k = 0; k < points.z; ++k)
    for (int j = 0; j < points.y; ++j)
      for (int i = 0; i < points.x; ++i)
        m.value.push_back(static_cast<float>(field(m.origin + double(i) * a + double(j) * b + double(k) * c)));
  return m;
}

struct Found {
  int64_t wrong_side = 0, incomplete = 0;
  double volume = 0, worst = 0; ///< Å³ by grid points inside; |ln G / s - (field - level)| on active points
};
Found compare(const BlockGrid& g, double level, double factor) {
  Found f;
  const BlockIndex index(g);
  const Vec3i n = g.frame.points;
  const double h = g.frame.spacing;
  for (int x = 0; x + 1 < n.x; ++x)
    for (int y = 0; y + 1 < n.y; ++y)
      for (int z = 0; z + 1 < n.z; ++z) {
        const Vec3i p = g.frame.lower + Vec3i{x, y, z};
        const double v = value_at(g, index, p), exact = field(g.frame.position(p)) - level;
        f.volume += v > g.info.isovalue ? h * h * h : 0;
        f.wrong_side += std::abs(exact) > 0.02 && (v > g.info.isovalue) != (exact > 0);
        if (is_active(g, index, p) && std::abs(exact) < 0.2)
          f.worst = std::max(f.worst, std::abs(std::log(v / g.info.isovalue) / factor - exact));
        bool low = false, high = false, all = true;
        for (int k = 0; k < 8; ++k) {
          const Vec3i q = p + Vec3i{k & 1, k >> 1 & 1, k >> 2};
          const bool in = value_at(g, index, q) > g.info.isovalue;
          low = low || !in;
          high = high || in;
          all = all && is_active(g, index, q);
        }
        f.incomplete += low && high && !all;
      }
  return f;
}

} // namespace

TEST_CASE("a map's contour is the density's surface on its own lattice and on others") {
  const DenseMap own = sampled({40, 38, 36}, {0.8, 0, 0}, {0, 0.8, 0}, {0, 0, 0.8}),
                 flat = sampled({40, 30, 36}, {0.8, 0, 0}, {0, 1, 0}, {0, 0, 0.8}),
                 skew = sampled({44, 40, 40}, {0.8, 0.1, 0}, {-0.2, 0.8, 0.1}, {0, 0.1, 0.8}),
                 left = sampled({40, 38, 36}, {0, 0, -0.8}, {0, 0.8, 0}, {-0.8, 0, 0});
  for (const DenseMap* map : {&own, &flat, &skew, &left})
    for (const double spacing : {0., 0.5, 1.3}) {
      compose::MapOptions o;
      o.level = 1;
      o.spacing = spacing;
      o.isovalue = 2;
      compose::MapCounts counts;
      const BlockGrid g = compose::from_map(*map, o, counts);
      INFO("map " << (map == &own    ? "own"
                      : map == &flat ? "flat"
                      : map == &skew ? "skew"
                                     : "left")
                  << ", spacing " << spacing);
      CHECK(counts.interpolated == (map != &own || spacing > 0));
      CHECK(counts.wall_points == 0);
      CHECK(g.frame.spacing == (spacing > 0 ? spacing : map == &skew ? norm(map->axis[0]) : 0.8));
      const Found f = compare(g, 1, o.slope / counts.slope_of_map);
      CHECK(f.wrong_side == 0);
      CHECK(f.incomplete == 0);
      CHECK(f.worst < (counts.interpolated ? 0.01 : 1e-5));
      CHECK(f.volume == Approx(548).epsilon(0.05));
    }
}

TEST_CASE("a lattice that is asked for is that of the density") {
  const DenseMap m = sampled({40, 38, 36}, {0.8, 0, 0}, {0, 0.8, 0}, {0, 0, 0.8});
  compose::MapOptions o;
  o.level = 1;
  o.lattice = m.origin + Vec3d{0.3, -100.1, 8};
  compose::MapCounts counts;
  const BlockGrid g = compose::from_map(m, o, counts);
  CHECK(counts.interpolated);
  for (int a = 0; a < 3; ++a)
    CHECK(std::abs(std::remainder(g.frame.origin[a] - (*o.lattice)[a], 0.8)) < 1e-9);
  const Found f = compare(g, 1, o.slope / counts.slope_of_map);
  CHECK(f.wrong_side == 0);
  CHECK(f.incomplete == 0);
  CHECK(f.worst < 0.01);
  o.lattice = m.origin + Vec3d{1.6, -80, 8};
  compose::from_map(m, o, counts);
  CHECK_FALSE(counts.interpolated);
}

TEST_CASE("a contour that reaches the walls is closed there") {
  const DenseMap m = sampled({20, 38, 36}, {0.5, 0, 0}, {0, 0.8, 0}, {0, 0, 0.8});
  compose::MapOptions o;
  o.level = 1;
  for (const double spacing : {0.5, 0.7}) {
    o.spacing = spacing;
    compose::MapCounts counts;
    const BlockGrid g = compose::from_map(m, o, counts);
    CHECK(counts.wall_points > 0);
    CHECK(compare(g, 1, 1).incomplete == 0);
    const BlockIndex index(g);
    int64_t walls = 0;
    for (int y = 0; y < g.frame.points.y; ++y)
      for (int z = 0; z < g.frame.points.z; ++z)
        walls += value_at(g, index, g.frame.lower + Vec3i{0, y, z}) > 1;
    CHECK(walls == 0);
  }
}

TEST_CASE("a level that the map does not cross is refused") {
  const DenseMap m = sampled({40, 38, 36}, {0.8, 0, 0}, {0, 0.8, 0}, {0, 0, 0.8});
  compose::MapOptions o;
  o.level = 7;
  compose::MapCounts counts;
  const std::string line = test::refusal(Status::usage, [&] { compose::from_map(m, o, counts); });
  CHECK(line.find("does not cross the level 7: its values go from") != std::string::npos);
  CHECK(line.find("[level]") != std::string::npos);
}
