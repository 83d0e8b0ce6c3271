// nearest_points_test.cpp — the point nearest to a place, against one point after the other.
#include "mesh/nearest_points.hpp"
#include "unit/mesh/meshes.hpp"
#include <catch2/catch.hpp>
#include <random>

using namespace molmesh;

TEST_CASE("the nearest point of a mesh is found, the lowest of equals") {
  const TetMesh m = testing::cubes(4, [](Vec3i) { return 1; });
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-2, 6);
  std::vector<Vec3d> place{{0.5, 0.5, 0.5}, {1, 2, 3}, {2.5, 2, 2}, {100, 2, 2}}; // equals among them
  for (int i = 0; i < 200; ++i)
    place.push_back({u(random), u(random), u(random)});
  const std::vector<NearestPoint> found = nearest_points(m, place);
  for (size_t i = 0; i < place.size(); ++i) {
    int64_t nearest = 0;
    for (size_t p = 1; p < m.point.size(); ++p)
      if (norm2(m.point[p] - place[i]) < norm2(m.point[nearest] - place[i]))
        nearest = static_cast<int64_t>(p);
    CHECK(found[i].point == nearest);
    CHECK(found[i].distance == Approx(norm(m.point[nearest] - place[i])).margin(1e-15));
  }
  CHECK(nearest_points(TetMesh(), place)[0].point == -1);
}
