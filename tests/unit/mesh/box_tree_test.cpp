// box_tree_test.cpp — boxes that are met, against all of them.
#include "mesh/box_tree.hpp"
#include <catch2/catch.hpp>
#include <random>

using namespace molmesh;

TEST_CASE("a box holds its triangle, rounded outwards") {
  const Vec3d a{0.1, 1e9 + 1e-3, -3}, b{0.2, 0, -0.1}, c{0.3, 1e-30, 7};
  const Boxf box = box_around(a, b, c);
  for (const Vec3d p : {a, b, c})
    for (int k = 0; k < 3; ++k) {
      CHECK(double(box.low[k]) < p[k]);
      CHECK(double(box.high[k]) > p[k]);
    }
}

TEST_CASE("a tree of boxes finds those that a box meets, each once and in order") {
  std::mt19937 generator(8);
  std::uniform_real_distribution<double> u(0, 10), size(-1, 1);
  for (const size_t n : {size_t{0}, size_t{1}, size_t{8}, size_t{9}, size_t{64}, size_t{65}, size_t{700}}) {
    CAPTURE(n);
    const auto box = [&] {
      const Vec3d p{u(generator), u(generator), u(generator)};
      const auto corner = [&] { return p + Vec3d{size(generator), size(generator), size(generator)}; };
      const Vec3d a = corner(), b = corner();
      return box_around(a, b, corner());
    };
    std::vector<Boxf> all;
    for (size_t i = 0; i < n; ++i)
      all.push_back(box());
    const BoxTree tree(
        n, [&](size_t i) { return all[i]; }, 3);
    size_t met = 0;
    for (int k = 0; k < 60; ++k) {
      Boxf one = box();
      if (k < 2) // meets everything
        one.low = {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF}, one.high = {HUGE_VALF, HUGE_VALF, HUGE_VALF};
      const size_t first = k % 2 == 0 ? 0 : std::uniform_int_distribution<size_t>(0, n)(generator);
      std::vector<size_t> expected, found;
      for (size_t i = first; i < n; ++i)
        if (one.meets(all[i]))
          expected.push_back(i);
      CHECK_FALSE(tree.any(
          one,
          [&](size_t i) {
            found.push_back(i);
            return false;
          },
          first));
      CHECK(found == expected);
      met += found.size();
    }
    CHECK(met >= n);
  }
}
