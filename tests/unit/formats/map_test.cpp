// map_test.cpp — every point of a dense map is the sparse grid's, where the format says it lies.
#include "density/density.hpp"
#include "formats/map/map.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>
#include <cstring>
#include <sstream>

using namespace molmesh;

namespace {

BlockGrid two_atoms() {
  Hierarchy h;
  h.atom.push_back({{1, 2, 3}, 2.0});
  h.atom.push_back({{4.5, 2.5, 3}, 1.6});
  density::Options o;
  o.spacing = 0.7;
  density::Counts counts;
  return to_block_grid(density::compute(h, o, counts), 1);
}

} // namespace

TEST_CASE("a CCP4 map holds every grid point, x fastest") {
  const BlockGrid g = two_atoms();
  std::ostringstream out;
  formats::write_ccp4(out, g, "x");
  const std::string bytes = out.str();
  const Vec3i n = g.frame.points;
  REQUIRE(bytes.size() == 1024 + 4 * size_t(n.x) * size_t(n.y) * size_t(n.z));
  const auto word = [&](int w, auto kind) {
    std::memcpy(&kind, &bytes[4 * static_cast<size_t>(w - 1)], 4);
    return kind;
  };
  CHECK(word(1, int32_t{}) == n.x);
  CHECK(word(4, int32_t{}) == 2);
  CHECK(word(11, float{}) / static_cast<float>(n.x) == Approx(0.7));
  CHECK(word(50, float{}) == Approx(g.frame.origin.x));
  CHECK(bytes.substr(208, 4) == "MAP ");
  const BlockIndex index(g);
  size_t at = 1024;
  int64_t wrong = 0;
  float most = 0;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x, at += 4) {
        float v;
        std::memcpy(&v, &bytes[at], 4);
        wrong += v != value_at(g, index, {x, y, z});
        most = std::max(most, v);
      }
  CHECK(wrong == 0);
  CHECK(word(21, float{}) == most);
}

TEST_CASE("an OpenDX map holds every grid point, z fastest") {
  const BlockGrid g = two_atoms();
  std::stringstream text;
  formats::write_dx(text, g, "x");
  std::string line;
  while (std::getline(text, line) && line.find("data follows") == std::string::npos) {
  }
  const BlockIndex index(g);
  int64_t wrong = 0;
  for (int x = 0; x < g.frame.points.x; ++x)
    for (int y = 0; y < g.frame.points.y; ++y)
      for (int z = 0; z < g.frame.points.z; ++z) {
        float v = -1;
        text >> v;
        wrong += v != value_at(g, index, {x, y, z});
      }
  CHECK(wrong == 0);
  text >> line;
  CHECK(line == "attribute");
}

TEST_CASE("a map of more points than 64 bits count is refused") {
  BlockGrid g = two_atoms();
  g.frame.points = {1 << 29, 1 << 29, 1 << 29};
  std::ostringstream out;
  CHECK(test::refusal(Status::bad_input, [&] { formats::write_dx(out, g, "x"); }) ==
        "x: a dense map would have 536870912 x 536870912 x 536870912 points, expected at most 8000000000");
  CHECK(out.str().empty());
}
