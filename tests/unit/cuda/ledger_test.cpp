// ledger_test.cpp — which memory an array gets: the device's, pages, or none.
#include "cuda/par/host.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using cuda::Bytes;
using cuda::HostBackend;

TEST_CASE("ledger: the device's memory first, then pages where they are allowed, then a refusal") {
  HostBackend strict(1, {1000}), pages(1, {1000, 500});
  {
    const auto a = strict.array<char>(1000);
    CHECK(strict.room() == 0);
    CHECK(test::refusal(Status::failed, [&] { strict.array<char>(1); }).find("not enough memory") !=
          std::string::npos);
  }
  CHECK(strict.room() == 1000);
  const auto a = pages.array<char>(700);
  {
    const auto b = pages.array<char>(400); // does not fit
    const auto c = pages.array<char>(300); // does
    CHECK(pages.room() == 0);
    CHECK(pages.most_used().own == 1000);
    CHECK(pages.most_used().paged == 400);
    test::refusal(Status::failed, [&] { pages.array<char>(101); });
    pages.array<char>(100);
  }
  CHECK(pages.room() == 300);
  CHECK(pages.most_used().paged == 500);
}

TEST_CASE("ledger: where more is planned than there is, large arrays are paged and small ones are not") {
  HostBackend b(1, {1000, 5000});
  b.plan(1000);
  const auto fits = b.array<char>(600);
  CHECK(b.most_used().paged == 0);
  b.plan(401); // of 400
  CHECK(b.room() == 150);
  const auto large = b.array<char>(40);
  CHECK(b.most_used().paged == 40);
  const auto small = b.array<char>(30);
  CHECK(b.most_used().own == 630);
  CHECK(b.room() == 120);
  HostBackend strict(1, {1000}); // nothing to plan for
  strict.plan(2000);
  CHECK(strict.room() == 1000);
}
