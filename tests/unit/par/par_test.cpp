// par_test.cpp — same results at any number of threads.
#include "par/par.hpp"
#include <catch2/catch.hpp>
#include <random>
#include <stdexcept>

using namespace molmesh;

TEST_CASE("reduce gives the same bits at any number of threads") {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> u(-1e9, 1);
  std::vector<double> v(100'003);
  for (double& x : v)
    x = u(random);
  const auto sum = [&](int threads) {
    return par::reduce(
        static_cast<int64_t>(v.size()), threads, 0.0, [&](int64_t i) { return v[static_cast<size_t>(i)]; },
        [](double a, double b) { return a + b; });
  };
  const double one = sum(1);
  for (int threads : {2, 3, 5, 8})
    CHECK(sum(threads) == one);
}

TEST_CASE("sort agrees with std::sort") {
  std::mt19937_64 random(7);
  for (size_t n : {0u, 1u, 1000u, 200'001u}) {
    std::vector<uint64_t> v(n);
    for (uint64_t& x : v)
      x = random() % 1000;
    std::vector<uint64_t> expected = v;
    std::sort(expected.begin(), expected.end());
    for (int threads : {1, 2, 5}) {
      std::vector<uint64_t> sorted = v;
      par::sort(sorted, threads);
      CHECK(sorted == expected);
    }
  }
}

TEST_CASE("an exception in a loop reaches the caller") {
  for (int threads : {1, 4})
    CHECK_THROWS_AS(par::for_n(10'000, threads, 10,
                               [](int64_t i) {
                                 if (i == 7777)
                                   throw std::runtime_error("x");
                               }),
                    std::runtime_error);
}

TEST_CASE("exclusive_scan turns counts into offsets") {
  std::vector<int64_t> count{3, 0, 2, 5};
  CHECK(par::exclusive_scan(count) == 10);
  CHECK(count == std::vector<int64_t>{0, 3, 3, 5});
}
