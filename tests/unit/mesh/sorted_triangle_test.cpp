// sorted_triangle_test.cpp — corners in every order, the largest numbers among them.
#include "mesh/sorted_triangle.hpp"
#include <catch2/catch.hpp>
#include <limits>

using namespace molmesh;

TEST_CASE("sorted triangle: the same key in every order, odd where the turn is the other one") {
  constexpr int32_t most = std::numeric_limits<int32_t>::max();
  for (const Tri t : {Tri{0, 1, 2}, Tri{3, 70, most}, Tri{0, most - 1, most}}) {
    const auto [a, b, c] = t;
    for (const Tri even : {Tri{a, b, c}, Tri{b, c, a}, Tri{c, a, b}}) {
      CHECK(sorted_triangle(even).v == t);
      CHECK_FALSE(sorted_triangle(even).odd);
      CHECK(triangle_key(even) == triangle_key(t));
    }
    for (const Tri odd : {Tri{b, a, c}, Tri{a, c, b}, Tri{c, b, a}}) {
      CHECK(sorted_triangle(odd).v == t);
      CHECK(sorted_triangle(odd).odd);
      CHECK(triangle_key(odd) == triangle_key(t));
    }
  }
  CHECK_FALSE(triangle_key({0, 1, 2}) == triangle_key({0, 1, 3}));
  CHECK_FALSE(triangle_key({0, 1, 3}) == triangle_key({0, 2, 3}));
}
