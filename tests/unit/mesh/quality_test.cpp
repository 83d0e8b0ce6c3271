// quality_test.cpp — distributions against plain sums over all tetrahedra.
#include "mesh/quality.hpp"
#include "meshes.hpp"
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

using namespace molmesh;
using namespace molmesh::testing;

namespace {

TetMesh displaced(int n) {
  TetMesh m = cubes(n, [](Vec3i c) -> int32_t { return c.x < 2 ? 1 : 2; });
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> u(-0.2, 0.2);
  for (Vec3d& p : m.point)
    p += Vec3d{u(random), u(random), u(random)};
  return m;
}

} // namespace

TEST_CASE("Kuhn's tetrahedra have angles of 45, 60 and 90 degrees") {
  const MeshQuality q = measure_quality(cubes(2, all_molecule), 1);
  CHECK(q.all.tets == 48);
  CHECK(q.all.dihedral.min == Approx(45));
  CHECK(q.all.dihedral.max == Approx(90));
  CHECK(q.all.dihedral.mean == Approx((45 * 2 + 60 + 90 * 3) / 6.0));
  CHECK(q.all.edge_ratio.min == Approx(std::sqrt(3)));
  // V = 1/6, Σ e² = 3 + 2·2 + 3 = 10
  CHECK(q.all.joe_liu_q.mean == Approx(8 * std::pow(3, 2.5) / 6 / std::pow(10, 1.5)));
  CHECK(q.all.eta.mean == Approx(12 * std::pow(0.5, 2.0 / 3) / 10));
  CHECK(q.all.edge_ratio.bin[1] == 48);
}

TEST_CASE("quality of regions and of the whole is what a plain loop finds") {
  const TetMesh m = displaced(16);
  const MeshQuality quality = measure_quality(m, 2, {40, 100});
  REQUIRE(quality.region == std::vector<int32_t>{1, 2});
  for (size_t k = 0; k < 3; ++k) {
    const Quality& q = k < 2 ? quality.of[k] : quality.all;
    double low = 1e9, high = -1e9, sum = 0, q_low = 1e9, ratio_high = 0;
    int64_t tets = 0, low_tet = -1, outside = 0;
    std::vector<int64_t> bin(36);
    for (size_t i = 0; i < m.tet.size(); ++i) {
      if (k < 2 && m.region[i] != quality.region[k])
        continue;
      const auto p = [&](size_t j) { return m.point[m.tet[i][j]]; };
      ++tets;
      bool beyond = false;
      for (double degree : dihedrals(p(0), p(1), p(2), p(3)).degree) {
        beyond |= degree < 40 || degree > 100;
        if (degree < low)
          low = degree, low_tet = int64_t(i);
        high = std::max(high, degree);
        sum += degree;
        ++bin[std::clamp(std::floor(degree / 5), 0.0, 35.0)];
      }
      outside += beyond;
      q_low = std::min(q_low, joe_liu_q(six_volume(p(0), p(1), p(2), p(3)), edge_sum2(p(0), p(1), p(2), p(3))));
      ratio_high = std::max(ratio_high, edge_ratio(p(0), p(1), p(2), p(3)));
    }
    CHECK(q.tets == tets);
    CHECK(q.outside == outside);
    CHECK(outside > 0);
    CHECK(q.dihedral.min == low);
    CHECK(q.dihedral.min_tet == low_tet);
    CHECK(q.dihedral.max == high);
    CHECK(q.dihedral.mean == Approx(sum / (6.0 * double(tets))));
    CHECK(q.dihedral.bin == bin);
    CHECK(q.joe_liu_q.min == q_low);
    CHECK(q.edge_ratio.max == ratio_high);
    CHECK(std::accumulate(q.eta.bin.begin(), q.eta.bin.end(), int64_t{0}) == tets);
  }
}

TEST_CASE("quality has the same bits at any number of threads") {
  const TetMesh m = displaced(20);
  const MeshQuality one = measure_quality(m, 1);
  for (int threads : {2, 5}) {
    const MeshQuality q = measure_quality(m, threads);
    CHECK(q.all.dihedral.mean == one.all.dihedral.mean);
    CHECK(q.of[1].eta.mean == one.of[1].eta.mean);
    CHECK(q.all.joe_liu_q.min_tet == one.all.joe_liu_q.min_tet);
    CHECK(q.all.edge_ratio.bin == one.all.edge_ratio.bin);
  }
}

TEST_CASE("tetrahedra without measures are the worst there can be") {
  TetMesh m;
  m.point = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}};
  m.tet = {{0, 1, 2, 3}, {0, 0, 1, 3}, {1, 1, 1, 1}};
  m.region = {1, 1, 1};
  const Quality q = measure_quality(m, 1).all;
  CHECK(q.dihedral.min == 0);
  CHECK(q.dihedral.max == 180);
  CHECK(q.joe_liu_q.max == 0);
  CHECK(q.edge_ratio.max == HUGE_VAL);
}
