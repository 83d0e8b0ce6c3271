// active_set_test.cpp — corners of band cells of a brick among its neighbors, against the same cell by cell.
#include "density/band/active_set_simd.hpp"
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <hwy/targets.h>
#include <memory>
#include <random>

using namespace molmesh;

namespace {

/// The 27 bricks around one, both sets of each.
struct Neighborhood {
  density::BrickWords below[27], above[27];
  density::FacedBits below_rows[27], above_rows[27];
};

/// Whether a set of the 96³ points holds one; brick 13 begins at 32.
bool holds(const density::BrickWords* set, int x, int y, int z) {
  const auto brick = static_cast<size_t>(9 * (x / 32) + 3 * (y / 32) + z / 32);
  x %= 32, y %= 32, z %= 32;
  return set[brick].word[16 * (x / 8) + 4 * (y / 8) + z / 8][x % 8] >> (8 * (y % 8) + z % 8) & 1;
}

/// Mostly of one side, so that most cells are no band cells, then thinner and thinner.
std::unique_ptr<Neighborhood> random_sides(std::mt19937_64& random) {
  auto n = std::make_unique<Neighborhood>();
  for (size_t i = 0; i < 27; ++i) {
    for (int b = 0; b < density::blocks_a_brick; ++b)
      for (int x = 0; x < 8; ++x) {
        const uint64_t kind = random() % 4, holes = random() & random() & random() & random();
        n->below[i].word[b][x] = kind == 0 ? ~uint64_t{0} : kind == 1 ? ~holes : kind == 2 ? random() : 0;
        n->above[i].word[b][x] = ~n->below[i].word[b][x] & ~(random() & random() & random());
      }
    density::faced_from_words(n->below[i], n->below_rows[i]);
    density::faced_from_words(n->above[i], n->above_rows[i]);
  }
  return n;
}

/// active: the corners of band cells among `cells`, by below(x, y, z) and above(x, y, z), from -1 to 32.
template <class Below, class Above>
void check_corners(const density::BrickBits& active, const density::CellRange& cells, Below&& below,
                   Above&& above) {
  const auto is_band_cell = [&](const int* cell) {
    bool all_below = true, all_above = true;
    for (int c = 0; c < 8; ++c) {
      const int x = cell[0] + (c >> 2), y = cell[1] + (c >> 1 & 1), z = cell[2] + (c & 1);
      all_below = all_below && below(x, y, z);
      all_above = all_above && above(x, y, z);
    }
    return !all_below && !all_above;
  };
  int64_t wrong = 0, found = 0;
  for (int x = 0; x < 32; ++x)
    for (int y = 0; y < 32; ++y)
      for (int z = 0; z < 32; ++z) {
        bool corner = false;
        for (int c = 0; c < 8; ++c) {
          const int cell[3] = {x - (c >> 2), y - (c >> 1 & 1), z - (c & 1)};
          bool in = true;
          for (int a = 0; a < 3; ++a)
            in = in && cell[a] >= cells.first[a] && cell[a] < cells.end[a];
          corner = corner || (in && is_band_cell(cell));
        }
        wrong += corner != (active.row[x][y] >> z & 1);
        found += corner;
      }
  CHECK(wrong == 0);
  CHECK(found > 1000);
  CHECK(found < 32 * 32 * 32);
}

} // namespace

TEST_CASE("corners of band cells of a brick, whose neighbors give their faces alone") {
  std::mt19937_64 random(3);
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    INFO(hwy::TargetName(target));
    for (const density::CellRange& cells :
         {density::CellRange{{-1, -1, -1}, {32, 32, 32}}, {{0, -1, 3}, {31, 32, 20}}}) {
      const auto n = random_sides(random);
      const density::FacedBits *below[27], *above[27];
      for (size_t i = 0; i < 27; ++i) {
        below[i] = &n->below_rows[i];
        above[i] = &n->above_rows[i];
      }
      auto active = std::make_unique<density::BrickBits>();
      density::band_points(below, above, cells, *active);
      check_corners(
          *active, cells, [&](int x, int y, int z) { return holds(n->below, 32 + x, 32 + y, 32 + z); },
          [&](int x, int y, int z) { return holds(n->above, 32 + x, 32 + y, 32 + z); });
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST_CASE("corners of band cells as far as a brick knows them alone") {
  std::mt19937_64 random(5);
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    INFO(hwy::TargetName(target));
    const auto n = random_sides(random);
    auto sides = std::make_unique<density::Sides>(), beyond = std::make_unique<density::Sides>();
    sides->below = n->below_rows[0];
    sides->above = n->above_rows[0];
    beyond->below = n->below_rows[1];
    beyond->above = n->above_rows[1];
    const density::CellRange cells{{-1, -1, -1}, {32, 32, 31}};
    auto active = std::make_unique<density::BrickBits>();
    density::likely_band_points(*sides, *beyond, cells, *active);
    const auto holds_at = [](const density::BrickBits& own, const density::BrickBits& far, int x, int y, int z) {
      const auto in = [](int i) { return std::clamp(i, 0, 31); };
      const bool inner = x == in(x) && y == in(y) && z == in(z);
      return ((inner ? own : far).row[in(x)][in(y)] >> in(z)&1) != 0;
    };
    check_corners(
        *active, cells, [&](int x, int y, int z) { return holds_at(sides->below, beyond->below, x, y, z); },
        [&](int x, int y, int z) { return holds_at(sides->above, beyond->above, x, y, z); });
  }
  hwy::SetSupportedTargetsForTest(0);
}
