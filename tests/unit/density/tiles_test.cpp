// tiles_test.cpp — the blocks of all tiles against those of the whole grid, bit for bit.
#include "density/density.hpp"
#include "density/plan.hpp"
#include "molecule/digest.hpp"
#include "unit/density/oracle.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;

namespace {

BlockGrid compute(const Hierarchy& h, const density::Options& o) {
  density::Counts counts;
  return to_block_grid(density::compute(h, o, counts), 1);
}

/// What the tiles hold, put together and in order. Blocks of a tile lie in it.
BlockGrid from_tiles(const Hierarchy& h, density::Options o, int32_t count) {
  struct Block {
    Vec3i corner;
    const BlockGrid* grid;
    size_t at;
  };
  std::vector<BlockGrid> tile;
  for (int32_t number = 1; number <= count; ++number) {
    o.tile = {number, count};
    tile.push_back(compute(h, o));
    const Slab slab = slab_of(tile[0].frame, o.tile);
    for (const std::vector<Vec3i>* const corners : {&tile.back().corner, &tile.back().inside})
      for (const Vec3i& c : *corners)
        REQUIRE(slab.contains(c));
  }
  BlockGrid all;
  all.frame = tile[0].frame;
  all.info = tile[0].info;
  all.info.analyzed_points = 0;
  std::vector<Block> block;
  for (const BlockGrid& g : tile) {
    all.info.analyzed_points += g.info.analyzed_points;
    all.inside.insert(all.inside.end(), g.inside.begin(), g.inside.end());
    for (size_t b = 0; b < g.corner.size(); ++b)
      block.push_back({g.corner[b], &g, b});
  }
  std::sort(all.inside.begin(), all.inside.end());
  std::sort(block.begin(), block.end(), [](const Block& a, const Block& b) { return a.corner < b.corner; });
  for (const Block& b : block) {
    all.corner.push_back(b.corner);
    all.value.insert(all.value.end(), &b.grid->value[512 * b.at], &b.grid->value[512 * b.at] + 512);
    all.active.insert(all.active.end(), &b.grid->active[8 * b.at], &b.grid->active[8 * b.at] + 8);
  }
  return all;
}

void check_tiles(const Hierarchy& h, const density::Options& o, int32_t count) {
  INFO(count << " tiles, spacing " << o.spacing << ", threads " << o.threads << ", full " << o.full_search);
  const BlockGrid whole = compute(h, o), tiles = from_tiles(h, o, count);
  REQUIRE(!whole.corner.empty());
  CHECK(tiles.frame.origin == whole.frame.origin);
  CHECK(tiles.frame.points == whole.frame.points);
  CHECK(tiles.info.analyzed_points == whole.info.analyzed_points);
  CHECK(tiles.info.atoms == whole.info.atoms);
  CHECK(tiles.info.levels == whole.info.levels);
  CHECK(tiles.corner == whole.corner);
  CHECK(tiles.inside == whole.inside);
  CHECK(tiles.active == whole.active);
  CHECK(tiles.value == whole.value);
}

} // namespace

TEST_CASE("tiles hold what the whole grid holds, for steep and gentle exponents and any search") {
  density::Options o;
  o.spacing = 0.45;
  for (const std::vector<double>& exponents :
       {std::vector<double>{0.3, 1, 1}, {1, 0.5, 0.2}, {4, 1, 1}, {0.05, 0.7, 1}}) {
    const Hierarchy h = test::random_chains(2, 12, 8, exponents, 5);
    for (const int32_t count : {2, 7}) {
      o.threads = count == 7 ? 1 : 2;
      check_tiles(h, o, count);
    }
  }
  const Hierarchy h = test::random_chains(2, 12, 8, {0.3, 1, 1}, 6);
  o.band_lower = 0.01;
  o.band_upper = 30;
  check_tiles(h, o, 5);
  o = {};
  o.spacing = 0.7;
  o.atoms = density::AtomSearch::kdtree;
  check_tiles(h, o, 3);
  o.atoms = density::AtomSearch::all;
  check_tiles(h, o, 3);
  o.atoms = density::AtomSearch::bvh;
  o.full_search = true;
  check_tiles(h, o, 3);
}

TEST_CASE("tiles hold what the whole grid holds, with bodies without atoms and with weights") {
  density::Options o;
  o.spacing = 0.9;
  o.threads = 2;
  check_tiles(test::with_bodies({}), o, 3);
  check_tiles(test::with_weights(test::random_chains(2, 12, 8, {0.4, 1, 1}, 7), 3), o, 4);
}

TEST_CASE("tiles without a surface are empty, and those of a plan add up to its grid") {
  Hierarchy h;
  h.atom.emplace_back();
  h.atom.back().radius = 2;
  density::Options o;
  o.spacing = 0.05;
  check_tiles(h, o, 30);
  const density::Plan plan = density::plan(h, o);
  int64_t active = 0;
  for (int32_t number = 1; number <= 3; ++number)
    active += density::part_of(plan, {number, 3}).active_points;
  CHECK(std::abs(active - plan.size.active_points) <= 3);
}

TEST_CASE("a digest tells what a field is made of, and nothing else") {
  const Hierarchy h = test::random_chains(2, 5, 8, {0.4, 1, 1}, 7);
  Hierarchy same = h, moved = h, larger = h, steeper = h, heavier = h;
  same.source = "another";
  same.level[0].group[0].name = "another";
  same.atom[0].charge = 1;
  moved.atom[3].center.y += 1e-12;
  larger.atom[3].radius += 1e-12;
  steeper.level[2].group[2].exponent = 0.41;
  heavier.level[2].group[2].weight = 1.01;
  CHECK(digest(same) == digest(h));
  for (const Hierarchy& other : {moved, larger, steeper, heavier, test::with_bodies(h)})
    CHECK(digest(other) != digest(h));
}
