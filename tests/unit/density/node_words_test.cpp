// node_words_test.cpp — sets of a node's points and the blocks they touch, against the same point by point.
#include "density/band/node_words_simd.hpp"
#include "density/culling/seek.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <hwy/targets.h>
#include <memory>
#include <random>
#include <vector>

using namespace molmesh;
using density::NodeWords;

namespace {

/// Few points, so that many blocks have none; on faces, too.
std::unique_ptr<NodeWords> few_points(std::mt19937_64& random) {
  auto set = std::make_unique<NodeWords>();
  for (auto& block : set->word)
    for (uint64_t& word : block)
      word = random() % 12 ? 0 : uint64_t{1} << random() % 64;
  return set;
}

template <class Counts>
uint64_t blocks_with(const NodeWords& set, Counts&& counts) {
  uint64_t blocks = 0;
  for (int b = 0; b < 64; ++b)
    for (int p = 0; p < 512; ++p) {
      const int x = 8 * (b >> 4) + (p >> 6), y = 8 * (b >> 2 & 3) + (p >> 3 & 7), z = 8 * (b & 3) + (p & 7);
      if (set.word[b][p >> 6] >> (p & 63) & 1 && counts(b, p, x, y, z))
        blocks |= uint64_t{1} << b;
    }
  return blocks;
}

} // namespace

TEST_CASE("blocks that a set of a node's points touches") {
  std::mt19937_64 random(11);
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    INFO(hwy::TargetName(target));
    for (int round = 0; round < 20; ++round) {
      const auto set = few_points(random), other = few_points(random);
      for (auto& block : other->word) // much of the set, now and then all of a block's
        for (uint64_t& word : block)
          word |= random() % 4 ? set->word[&block - other->word][&word - block] : 0;
      CHECK(density::blocks_of(*set) == blocks_with(*set, [](int, int, int, int, int) { return true; }));
      CHECK(density::blocks_of_rest(*set, *other) == blocks_with(*set, [&](int b, int p, int, int, int) {
              return !(other->word[b][p >> 6] >> (p & 63) & 1);
            }));
      CHECK(density::blocks_of_inner(*set) == blocks_with(*set, [](int, int, int x, int y, int z) {
              const auto inner = [](int i) { return i > 0 && i < 31; };
              return inner(x) && inner(y) && inner(z);
            }));
      CHECK(density::blocks_of_rest(*set, *set) == 0);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST_CASE("seek finds what lower_bound finds, whatever the hint") {
  std::mt19937_64 random(13);
  for (int round = 0; round < 2000; ++round) {
    std::vector<int> v(random() % 40);
    for (int& x : v)
      x = static_cast<int>(random() % 50);
    std::sort(v.begin(), v.end());
    const int value = static_cast<int>(random() % 52) - 1;
    size_t hint = random() % 3 ? random() % (v.size() + 1) : random() % 100;
    const auto before = [](int a, int b) { return a < b; };
    const auto found = density::seek(v.begin(), v.end(), hint, value, before);
    REQUIRE(found == std::lower_bound(v.begin(), v.end(), value));
    REQUIRE(hint == static_cast<size_t>(found - v.begin()));
  }
}
