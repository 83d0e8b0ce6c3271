// overview_test.cpp — the line's figures are those of the full measures.
#include "geom/tet_measures.hpp"
#include "mesh/overview.hpp"
#include "mesh/quality.hpp"
#include <catch2/catch.hpp>
#include <random>

using namespace molmesh;

TEST_CASE("overview has the extreme angles of all elements, the volume of region 1 and the area of boundary 1") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-3, 3);
  TetMesh m;
  double volume = 0, area = 0;
  for (int i = 0; i < 40000; ++i) {
    Vec3d p[4];
    for (Vec3d& x : p)
      x = {place(random), place(random), place(random)};
    if (six_volume(p[0], p[1], p[2], p[3]) < 0)
      std::swap(p[0], p[1]);
    const auto first = static_cast<int32_t>(m.point.size());
    m.point.insert(m.point.end(), p, p + 4);
    m.tet.push_back({first, first + 1, first + 2, first + 3});
    m.region.push_back(1 + i % 2);
    m.tri.push_back({first, first + 1, first + 2});
    m.boundary.push_back(1 + i % 3);
    volume += i % 2 == 0 ? tet_volume(p[0], p[1], p[2], p[3]) : 0;
    area += i % 3 == 0 ? tri_area(p[0], p[1], p[2]) : 0;
  }
  const Distribution angle = measure_quality(m, 1).all.dihedral;
  const Overview one = overview(m, 1), two = overview(m, 2);
  CHECK(one.least_angle == Approx(angle.min).margin(1e-5));
  CHECK(one.largest_angle == Approx(angle.max).margin(1e-5));
  CHECK(one.volume == Approx(volume));
  CHECK(one.area == Approx(area));
  CHECK(one.volume == two.volume);
  CHECK(one.area == two.area);
  CHECK(one.least_angle == two.least_angle);
}

TEST_CASE("overview of nothing is nothing") {
  const Overview none = overview(TetMesh{}, 1);
  CHECK(none.volume == 0);
  CHECK(none.area == 0);
}
