// passes_test.cpp — lists of raised flags.
#include "par/launcher.hpp"
#include "par/passes.hpp"
#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace molmesh;

TEST_CASE("flagged lists the places of raised flags, ascending") {
  std::mt19937 random(3);
  for (int n : {0, 1, 7, 8, 63, 64, 65, 131, 1000, 300000})
    for (unsigned one_in : {1u, 2u, 50u, 5000u}) {
      CAPTURE(n, one_in);
      std::vector<uint8_t> flag(static_cast<size_t>(n));
      std::vector<int32_t> expected;
      for (int i = 0; i < n; ++i) {
        flag[i] = random() % one_in == 0;
        if (flag[i])
          expected.push_back(i);
      }
      par::HostLauncher launcher(2);
      const auto list = par::flagged(launcher, "flags", n, flag.data());
      CHECK(std::vector<int32_t>(list.array.begin(), list.array.end()) == expected);
    }
}
