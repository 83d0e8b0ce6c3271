// pack_test.cpp — packing the values of a block and a part of what is packed, against the same value by value.
#include "grid/band.hpp"
#include "grid/pack_simd.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <hwy/targets.h>
#include <random>
#include <vector>

using namespace molmesh;

TEST_CASE("of packed values those of a subset are taken, in order") {
  std::mt19937_64 random(5);
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    INFO(hwy::TargetName(target));
    for (int i = 0; i < 200; ++i) {
      // From words that are kept whole or not at all to sparse ones.
      const auto any = [&](uint64_t of) {
        const uint64_t r = random(), thin = i % 3 == 0 ? random() : ~uint64_t{0};
        return r % 5 == 0 ? of : r % 5 == 1 ? 0 : of & random() & thin;
      };
      uint64_t stored[8], active[8];
      float value[512];
      std::vector<float> all, kept;
      for (int s = 0; s < 512; ++s)
        value[s] = static_cast<float>(random() >> 40) + 1;
      for (int w = 0; w < 8; ++w) {
        stored[w] = any(~uint64_t{0});
        active[w] = any(stored[w]);
        for (int b = 0; b < 64; ++b) {
          if (stored[w] >> b & 1)
            all.push_back(value[64 * w + b]);
          if (active[w] >> b & 1)
            kept.push_back(value[64 * w + b]);
        }
      }
      std::vector<float> packed(512 + 16);
      REQUIRE(pack_active(value, stored, packed.data()) == static_cast<int32_t>(all.size()));
      packed.resize(all.size());
      REQUIRE(packed == all);
      packed.insert(packed.end(), 16, -1.0f); // the next block's
      BlockValues part;
      REQUIRE(pack_part(packed.data(), stored, active, part.data()) == static_cast<int32_t>(kept.size()));
      CHECK(std::equal(kept.begin(), kept.end(), part.begin()));

      BandBlock block{{}, {}, {}, {}, packed.data()};
      std::copy_n(active, 8, block.active.begin());
      std::copy_n(stored, 8, block.stored.begin());
      BlockValues room;
      const float* const values = active_values(block, room);
      CHECK(std::equal(kept.begin(), kept.end(), values));
      CHECK((values == block.value) == (block.active == block.stored)); // copied only where it must be
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}
