// hilbert_test.cpp — the curve goes through every point once, and only from neighbour to neighbour.
#include "geom/hilbert.hpp"
#include <catch2/catch.hpp>
#include <vector>

using namespace molmesh;

TEST_CASE("the Hilbert curve visits every point of the cube, one step at a time") {
  const int bits = GENERATE(1, 2, 3, 5);
  const int32_t n = 1 << bits;
  const Vec3i nowhere{-1, -1, -1};
  std::vector<Vec3i> at(size_t(n) * size_t(n) * size_t(n), nowhere);
  for (int32_t x = 0; x < n; ++x)
    for (int32_t y = 0; y < n; ++y)
      for (int32_t z = 0; z < n; ++z) {
        const uint64_t place = hilbert({x, y, z}, bits);
        REQUIRE(place < at.size());
        REQUIRE(at[place] == nowhere);
        at[place] = {x, y, z};
      }
  for (size_t i = 1; i < at.size(); ++i) {
    const Vec3i step = at[i] - at[i - 1];
    REQUIRE(step.x * step.x + step.y * step.y + step.z * step.z == 1);
  }
}
