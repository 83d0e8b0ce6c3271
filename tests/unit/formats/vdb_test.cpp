// vdb_test.cpp — what is written is read back, what is broken is refused.
#include "base/error.hpp"
#include "density/density.hpp"
#include "formats/vdb/leaves.hpp"
#include "formats/vdb/vdb.hpp"
#include "unit/density/oracle.hpp"
#include "unit/refusal.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

using namespace molmesh;
namespace fs = std::filesystem;

namespace {

/// Random values and active points in a few blocks, inside blocks singly and as a whole 128³ tile.
BlockGrid example() {
  BlockGrid g;
  g.frame = {{1.5, -2.25, 0.1}, 0.3, {-16, -9, 0}, {300, 60, 140}};
  g.info.inside_value = 2;
  g.info.analyzed_points = 123'456'789'012;
  g.info.atoms = 42;
  g.info.levels = "chain residue";
  g.info.source = "x.pdb sha256:00";
  g.info.creator = "test 1";
  std::mt19937 random(7);
  std::uniform_real_distribution<float> u(0.5f, 1.5f);
  for (int x = -16; x < 280; x += 8) // enough blocks to enclose a tile
    for (int y = -8; y < 40; y += 8)
      for (int z = 0; z < 40; z += 8)
        if (x < 128 || x >= 256)
          g.corner.push_back({x, y, z});
  for (size_t b = 0; b < g.corner.size(); ++b) {
    const bool whole = g.corner[b].x > 0 && g.corner[b].x % 16 == 0;
    for (int i = 0; i < 8; ++i) {
      uint64_t word = 0;
      for (int bit = 0; bit < 64; ++bit) {
        const bool on = whole || random() % 3 == 0;
        word |= uint64_t{on} << bit;
        g.value.push_back(on ? u(random) : random() % 2 ? 0.0f : 2.0f);
      }
      g.active.push_back(word);
    }
  }
  g.inside.push_back({-8, 0, 40});
  for (int x = 128; x < 256; x += 8)
    for (int y = 0; y < 128; y += 8)
      for (int z = 0; z < 128; z += 8)
        g.inside.push_back({x, y, z});
  return g;
}

std::string bytes(const BlockGrid& g) {
  std::ostringstream out;
  formats::write_vdb(out, g);
  return out.str();
}
BlockGrid parse(const std::string& b) {
  std::istringstream in(b);
  return formats::read_vdb(in, "x.vdb");
}
std::string refusal(const std::string& b) {
  return test::refusal(Status::bad_input, [&] { parse(b); });
}

} // namespace

TEST_CASE("a grid written is read back bit for bit") {
  const BlockGrid g = example(), r = parse(bytes(g));
  CHECK(r.frame.origin == g.frame.origin);
  CHECK(r.frame.spacing == g.frame.spacing);
  CHECK(r.frame.lower == g.frame.lower);
  CHECK(r.frame.points == g.frame.points);
  CHECK(r.info.isovalue == g.info.isovalue);
  CHECK(r.info.decay == g.info.decay);
  CHECK(r.info.band_lower == g.info.band_lower);
  CHECK(r.info.band_upper == g.info.band_upper);
  CHECK(r.info.tolerance == g.info.tolerance);
  CHECK(r.info.inside_value == g.info.inside_value);
  CHECK(r.info.analyzed_points == g.info.analyzed_points);
  CHECK(r.info.atoms == g.info.atoms);
  CHECK(r.info.levels == g.info.levels);
  CHECK(r.info.source == g.info.source);
  CHECK(r.info.creator == g.info.creator);
  CHECK(r.corner == g.corner);
  CHECK(r.value == g.value);
  CHECK(r.active == g.active);
  CHECK(r.inside == g.inside);
}

TEST_CASE("blocks that are given away as they are found make the file of the whole band") {
  const Hierarchy h = test::random_chains(4, 60, 8, {0.4, 1}, 3);
  density::Options o;
  o.spacing = 0.2; // many slabs
  density::Counts counts;
  const BlockGrid kept = to_block_grid(density::compute(h, o, counts), 1);
  const auto after_uuid = [](const std::string& file) { return file.substr(60); };
  const std::string whole = after_uuid(bytes(kept));
  for (const int threads : {1, 3}) {
    o.threads = threads;
    formats::Leaves leaves(threads);
    int calls = 0;
    o.take = [&](const FieldInfo& info, std::span<const BandBlocks> runs) {
      leaves.add(runs, static_cast<float>(info.inside_value));
      ++calls;
    };
    const Band band = density::compute(h, o, counts);
    CHECK(band.block.empty());
    CHECK(leaves.size() == kept.corner.size());
    CHECK(calls > 4); // memory is used again
    std::ostringstream out;
    formats::write_vdb(out, band.frame, band.info, band.inside, leaves);
    CHECK(after_uuid(out.str()) == whole);
  }
}

TEST_CASE("an empty grid is a valid file") {
  BlockGrid g;
  g.frame = {{0, 0, 0}, 1, {0, 0, 0}, {2, 2, 2}};
  const BlockGrid r = parse(bytes(g));
  CHECK(r.corner.empty());
  CHECK(r.inside.empty());
}

TEST_CASE("a density that falls over far more than its grid is refused") {
  BlockGrid g;
  g.frame = {{0, 0, 0}, 1, {0, 0, 0}, {20, 20, 20}};
  const auto with = [&](Tail tail) {
    formats::VdbExtras extras;
    extras.tail = tail;
    std::ostringstream out;
    formats::write_vdb(out, g, 1, extras);
    return refusal(out.str());
  };
  for (const Tail& tail : {Tail{}, Tail{5, 1, 1.7, 1.4}, Tail{100, 1e-4, 0, 1.4}}) // the last of P = 0.0001
    CHECK(with(tail).empty());
  for (const Tail& tail : {Tail{1e300, 1, 0, 0}, Tail{1e9, 1, 0, 0}, Tail{5, 1e-15, 0, 0}, Tail{5, 1, 0, 1e6}})
    CHECK(with(tail).find("x.vdb: R7: the density falls to 1e-30 over ") == 0);
  CHECK(with({5, 1, 1e300, 0}).find("over no finite number of Å") != std::string::npos);
}

TEST_CASE("whatever is cut off a .vdb file is missed") {
  const std::string whole = bytes(example());
  for (size_t n = 0; n < whole.size(); n += n < 1600 ? 1 : 9973) {
    INFO("the first " << n << " of " << whole.size() << " bytes");
    CHECK(refusal(whole.substr(0, n)) != "");
  }
}

TEST_CASE("damaged bytes are refused or read, never worse", "[slow]") {
  const std::string whole = bytes(example());
  std::mt19937 random(11);
  int refused = 0;
  for (int trial = 0; trial < 500; ++trial) {
    std::string b = whole;
    // Most damage near the head, where lengths and types are.
    const size_t range = trial % 2 ? b.size() : std::min<size_t>(b.size(), 1500);
    for (int flips = 1 + trial % 3; flips > 0; --flips)
      b[random() % range] = static_cast<char>(random());
    refused += !refusal(b).empty();
  }
  CHECK(refused > 100);
}
TEST_CASE("the samples in formats/vdb are accepted and refused by rule") {
  const fs::path samples = fs::path(MOLMESH_SOURCE_DIR) / "formats/vdb/samples";
  int passed = 0, failed = 0;
  for (const fs::directory_entry& f : fs::directory_iterator(samples / "passed")) {
    INFO(f.path());
    std::ifstream in(f.path(), std::ios::binary);
    CHECK_NOTHROW(formats::read_vdb(in, f.path()));
    ++passed;
  }
  for (const fs::directory_entry& f : fs::directory_iterator(samples / "failed")) {
    INFO(f.path());
    std::ifstream in(f.path(), std::ios::binary);
    const std::string rule = f.path().filename().string().substr(0, f.path().filename().string().find('-')) + ":";
    const std::string what = test::refusal(Status::bad_input, [&] { formats::read_vdb(in, "sample.vdb"); });
    CHECK(what.find("sample.vdb: " + rule) == 0);
    ++failed;
  }
  CHECK(passed >= 2);
  CHECK(failed >= 17);
}
