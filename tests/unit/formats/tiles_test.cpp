// tiles_test.cpp — tiles joined against the file of the whole grid, and sets that are none.
#include "density/density.hpp"
#include "formats/vdb/tiles.hpp"
#include "unit/density/oracle.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>
#include <random>
#include <sstream>

using namespace molmesh;

namespace {

std::string file_of(const Hierarchy& h, density::Options o, Tile tile, int64_t digest = 1) {
  o.tile = tile;
  density::Counts counts;
  formats::VdbExtras extras;
  extras.tile = tile;
  extras.tile_digest = digest;
  std::ostringstream out;
  formats::write_vdb(out, to_block_grid(density::compute(h, o, counts), 1), 1, extras);
  return out.str();
}

void add(formats::TileJoin& all, const std::string& bytes, const std::string& name) {
  std::istringstream in(bytes);
  all.add(in, name);
}

std::string after_uuid(const std::string& file) {
  return file.substr(60);
}

struct Example {
  Hierarchy h = test::random_chains(2, 30, 8, {0.4, 1}, 3);
  density::Options o;
  Example() { o.spacing = 0.4; }
  std::string tile(int32_t number, int32_t count) const { return file_of(h, o, {number, count}); }
};

} // namespace

TEST_CASE("tiles in any order make the file of the whole grid") {
  const Example e;
  const std::string whole = file_of(e.h, e.o, {});
  for (const int32_t count : {1, 2, 3, 7, 50})
    for (const int threads : {1, 2}) {
      formats::TileJoin all(threads);
      for (int32_t number = count; number >= 1; --number)
        add(all, e.tile(number, count), "t");
      all.check_complete();
      std::ostringstream out;
      all.write(out);
      CHECK(after_uuid(out.str()) == after_uuid(whole));
    }
}

TEST_CASE("a tile alone is no density, and a set of tiles is of one run and complete") {
  const Example e;
  const auto refused = [](const std::vector<std::string>& files) {
    return test::refusal(Status::bad_input, [&] {
      formats::TileJoin all(1);
      for (size_t i = 0; i < files.size(); ++i)
        add(all, files[i], std::string(1, static_cast<char>('a' + i)));
      all.check_complete();
    });
  };
  const std::string one = e.tile(1, 2), two = e.tile(2, 2);
  std::istringstream in(one);
  CHECK(test::refusal(Status::bad_input, [&] { formats::read_vdb(in, "a"); }) ==
        "a: R12: tile 1 of 2, expected the whole density: densityjoin joins tiles");
  CHECK(refused({two, one}).empty());
  CHECK(refused({one}) == "a: a tile of 2, of which number 2 is missing, expected all");
  CHECK(refused({e.tile(2, 20)}) ==
        "a: a tile of 20, of which 19 are missing (1, 3, 4, 5, 6, 7, 8, 9 …), expected all");
  CHECK(refused({one, one}) == "b: tile 1 of 2 as in a, expected each once");
  CHECK(refused({one, e.tile(2, 3)}) == "b: number of tiles 3, expected 2 as in a");
  CHECK(refused({one, file_of(e.h, e.o, {})}) == "b: number of tiles 1, expected 2 as in a");
  CHECK(refused({one, file_of(e.h, e.o, {2, 2}, 2)}) ==
        "b: tile of a run with other atoms, exponents or search options, expected those of a");
  Example other;
  other.o.spacing = 0.5;
  CHECK(refused({one, other.tile(2, 2)}) == "b: spacing 0.5, expected 0.4 as in a");
  other = {};
  other.o.isovalue = 1.01;
  CHECK(refused({one, other.tile(2, 2)}) == "b: isovalue 1.01, expected 1 as in a");
  other = {};
  other.h.source = "x.pdb";
  CHECK(refused({one, other.tile(2, 2)}) == "b: source 'x.pdb', expected '' as in a");
  other = {};
  other.o.band_upper = 1.2;
  CHECK(refused({one, other.tile(2, 2)}) == "b: band_upper 1.2, expected 1.1 as in a");
  CHECK(refused({}) == "no tile, expected one file at least");
}

TEST_CASE("a tile that holds blocks of another, or has no number, is damaged") {
  const Example e;
  density::Counts counts;
  BlockGrid grid = to_block_grid(density::compute(e.h, e.o, counts), 1);
  const auto refused = [&](Tile tile) {
    formats::VdbExtras extras;
    extras.tile = tile;
    std::ostringstream out;
    formats::write_vdb(out, grid, 1, extras);
    std::istringstream in(out.str());
    return test::refusal(Status::bad_input, [&] { formats::read_tile(in, "a", 1, extras); });
  };
  CHECK(refused({1, 2}).find("a: R12: a block at index ") == 0);
  CHECK(refused({2, 2}).find("a: R12: a block at index ") == 0);
  CHECK(refused({3, 2}) == "a: R12: tile 3 of 2, expected 1 to their number");
  CHECK(refused({0, 2}) == "a: R12: tile 0 of 2, expected 1 to their number");
}

TEST_CASE("bytes of a tile that are damaged are refused or read, never worse") {
  const Example e;
  const std::string one = e.tile(1, 2);
  std::mt19937 random(11);
  int refused = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::string bytes = one;
    bytes[60 + random() % std::min<size_t>(bytes.size() - 60, 1500)] = static_cast<char>(random());
    refused += !test::refusal(Status::bad_input, [&] {
                  formats::TileJoin all(1);
                  add(all, bytes, "a");
                }).empty();
  }
  CHECK(refused > 5);
}
