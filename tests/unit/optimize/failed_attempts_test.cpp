// failed_attempts_test.cpp — what failed is known while nothing of it is another, and forgetting never makes it up.
#include "optimize/acceptance/failed_attempts.hpp"
#include <catch2/catch.hpp>

using namespace molmesh::optimize;

TEST_CASE("an attempt that failed is known until one of its circumstances changes") {
  FailedAttempts failures;
  const FailedAttempts::Attempt attempt{
      .operation = FailedAttempts::Operation::merge, .aims = 1, .a = 3, .b = 5, .at_a = 7, .at_b = 9, .goal = 0.5f};
  CHECK_FALSE(failures.knows({.a = 0}));
  CHECK_FALSE(failures.knows(attempt));
  failures.add(attempt);
  CHECK(failures.knows(attempt));
  const auto other = [&](auto&& change) {
    FailedAttempts::Attempt changed = attempt;
    change(changed);
    CHECK_FALSE(failures.knows(changed));
  };
  other([](auto& x) { x.operation = FailedAttempts::Operation::split; });
  other([](auto& x) { x.aims = 0; });
  other([](auto& x) { std::swap(x.a, x.b); });
  other([](auto& x) { x.element = 0; });
  other([](auto& x) { ++x.at_a; });
  other([](auto& x) { ++x.at_b; });
  other([](auto& x) { x.goal = 0.25f; });
}

TEST_CASE("of many failures most are known, and no others") {
  FailedAttempts failures;
  for (int32_t v = 0; v < 8000; ++v)
    failures.add({.a = v, .at_a = uint32_t(v % 7)});
  int32_t known = 0;
  for (int32_t v = 0; v < 8000; ++v) {
    known += failures.knows({.a = v, .at_a = uint32_t(v % 7)});
    CHECK_FALSE(failures.knows({.a = v, .at_a = uint32_t(v % 7 + 1)}));
  }
  CHECK(known > 5000);
}
