// vain_test.cpp — what a recovery has tried in vain is known until something changes there.
#include "optimize/search/vain.hpp"
#include "recovery_pass.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

TEST_CASE("what was in vain is so for the same points, order and effort, while nothing changes") {
  optimize::Pass pass = recovery_pass(0.5), other = pass;
  const std::vector<int32_t> points{3, 8};
  optimize::Vain vain;
  vain.begin(pass);
  CHECK(!vain.knows(points, pass, 0));
  vain.note(points, pass, 7);
  CHECK(vain.knows(points, pass, 6));
  CHECK(!vain.knows(points, pass, 7)); // perhaps after it
  CHECK(!vain.knows({3}, pass, 6));
  other.worst_first = !pass.worst_first;
  CHECK(!vain.knows(points, other, 6));
  other = pass;
  other.effort = 2;
  CHECK(!vain.knows(points, other, 6));
  vain.begin(other); // another effort is nothing new
  CHECK(vain.knows(points, pass, 6));
  other.goal *= 2;
  vain.begin(other);
  CHECK(!vain.knows(points, pass, 6));
}

TEST_CASE("effort 3 has tried what effort 2 does, effort 4 goes another way") {
  optimize::Pass two = recovery_pass(0.5), three = two, four = two;
  two.effort = 2, three.effort = 3, four.effort = 4;
  optimize::Vain vain;
  vain.begin(two);
  vain.note({1}, three, 5);
  CHECK(vain.knows({1}, two, 4));
  CHECK(!vain.knows({1}, four, 4));
  vain.note({2}, four, 5);
  CHECK(vain.knows({2}, four, 4));
  CHECK(!vain.knows({2}, three, 4));
  CHECK(!vain.knows({2}, two, 4));
}
