// active_values_test.cpp — count and range of a grid's active values, against one point after the other.
#include "grid/active_values.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

using namespace molmesh;

TEST_CASE("active values are counted and their range is found, whatever inactive points hold") {
  std::mt19937 random(3);
  BlockGrid g;
  CHECK(active_values(g, 1).count == 0);
  for (int b = 0; b < 700; ++b) {
    g.corner.push_back({8 * b, 0, 0});
    for (int w = 0; w < 8; ++w)
      g.active.push_back(b % 3 == 0 ? 0 : (uint64_t{random()} << 32 | random()) << (b % 40));
  }
  g.value.resize(512 * g.corner.size());
  ActiveValues expected{0, 1e30F, -1e30F};
  for (size_t i = 0; i < g.value.size(); ++i) {
    const bool active = g.active[i / 64] >> (i % 64) & 1;
    g.value[i] = active ? 0.5F + static_cast<float>(random() % 100000) / 1e5F : i % 2 ? 0.F : 9.F;
    if (!active)
      continue;
    ++expected.count;
    expected.least = std::min(expected.least, g.value[i]);
    expected.most = std::max(expected.most, g.value[i]);
  }
  for (const int threads : {1, 3}) {
    const ActiveValues found = active_values(g, threads);
    CHECK(found.count == expected.count);
    CHECK(found.least == expected.least);
    CHECK(found.most == expected.most);
  }
}
