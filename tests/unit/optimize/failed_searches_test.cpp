// failed_searches_test.cpp — a search that has failed is known until something changes there.
#include "optimize/search/failed_searches.hpp"
#include "recovery_pass.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;
using optimize::Moves;

TEST_CASE("what has failed is known for the same points and strategy, while nothing changes") {
  const optimize::Strategy s = recovery(0.5);
  optimize::Strategy other = s;
  const std::vector<int32_t> points{3, 8};
  optimize::FailedSearches failed;
  failed.begin(s);
  CHECK(!failed.knows(points, s, 0));
  failed.note(points, s, 7);
  CHECK(failed.knows(points, s, 6));
  CHECK(!failed.knows(points, s, 7)); // perhaps after it
  CHECK(!failed.knows({3}, s, 6));
  other.worst_first = !s.worst_first;
  CHECK(!failed.knows(points, other, 6));
  other = recovery(0.5, Moves::necks);
  CHECK(!failed.knows(points, other, 6));
  failed.begin(other); // other moves are nothing new
  CHECK(failed.knows(points, s, 6));
  other.goal *= 2;
  failed.begin(other);
  CHECK(!failed.knows(points, s, 6));
}

TEST_CASE("what other moves have failed for may come right by these") {
  const optimize::Strategy bold = recovery(0.5, Moves::bold), necks = recovery(0.5, Moves::necks),
                           bending = recovery(0.5, Moves::bending);
  optimize::FailedSearches failed;
  failed.begin(bold);
  failed.note({1}, necks, 5);
  CHECK(failed.knows({1}, necks, 4));
  CHECK(!failed.knows({1}, bold, 4));
  CHECK(!failed.knows({1}, bending, 4));
  failed.note({2}, bending, 5);
  CHECK(failed.knows({2}, bending, 4));
  CHECK(!failed.knows({2}, necks, 4));
  CHECK(!failed.knows({2}, bold, 4));
}
