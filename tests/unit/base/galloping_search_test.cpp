// galloping_search_test.cpp — a search from a hint against std::lower_bound.
#include "base/galloping_search.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace molmesh;

TEST_CASE("a galloping search finds what lower_bound finds, whatever the hint") {
  std::mt19937_64 random(13);
  for (int round = 0; round < 2000; ++round) {
    std::vector<int> v(random() % 40);
    for (int& x : v)
      x = static_cast<int>(random() % 50);
    std::sort(v.begin(), v.end());
    const int value = static_cast<int>(random() % 52) - 1;
    size_t hint = random() % 3 ? random() % (v.size() + 1) : random() % 100;
    const auto before = [](int a, int b) { return a < b; };
    const auto found = galloping_lower_bound(v.begin(), v.end(), hint, value, before);
    REQUIRE(found == std::lower_bound(v.begin(), v.end(), value));
    REQUIRE(hint == static_cast<size_t>(found - v.begin()));
  }
}
