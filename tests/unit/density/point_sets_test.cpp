// point_sets_test.cpp — sets of a brick's points and the blocks they touch, against the same point by point.
#include "density/band/point_sets_simd.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <hwy/targets.h>
#include <memory>
#include <random>

using namespace molmesh;
using density::BrickWords;

namespace {

/// Few points, so that many blocks have none; on faces, too.
std::unique_ptr<BrickWords> few_points(std::mt19937_64& random) {
  auto set = std::make_unique<BrickWords>();
  for (auto& block : set->word)
    for (uint64_t& word : block)
      word = random() % 12 ? 0 : uint64_t{1} << random() % 64;
  return set;
}

template <class Counts>
uint64_t blocks_with(const BrickWords& set, Counts&& counts) {
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

TEST_CASE("blocks that a set of a brick's points touches") {
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
