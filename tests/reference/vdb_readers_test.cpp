// vdb_readers_test.cpp — pyopenvdb, vdb_print and Blender read from our .vdb what was written.
#include "density/density.hpp"
#include "formats/vdb/vdb.hpp"
#include "unit/density/oracle.hpp"
#include <bit>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

using namespace molmesh;
namespace fs = std::filesystem;

namespace {

nlohmann::json triple(auto v) {
  return {v.x, v.y, v.z};
}

/// A sample of points of every kind: active, inactive on either side, in tiles.
nlohmann::json expected(const BlockGrid& g) {
  const FieldInfo& i = g.info;
  nlohmann::json j;
  j["metadata"] = {{"molmesh_profile", 1},
                   {"isovalue", i.isovalue},
                   {"decay", i.decay},
                   {"band_lower", i.band_lower},
                   {"band_upper", i.band_upper},
                   {"tolerance", i.tolerance},
                   {"inside_value", i.inside_value},
                   {"grid_points", triple(g.frame.points)},
                   {"grid_origin", triple(g.frame.lower)},
                   {"analyzed_points", i.analyzed_points},
                   {"atoms", i.atoms},
                   {"levels", i.levels},
                   {"source", i.source},
                   {"creator", i.creator}};
  int64_t active = 0;
  for (const uint64_t w : g.active)
    active += std::popcount(w);
  j["active"] = active;
  const BlockIndex index(g);
  std::mt19937 random(3);
  const auto add = [&](Vec3i p) {
    j["points"].push_back({triple(p), value_at(g, index, p), is_active(g, index, p)});
  };
  const Vec3i n = g.frame.points;
  for (int k = 0; k < 3000; ++k) {
    const auto below = [&random](int32_t end) { return static_cast<int32_t>(random() % uint32_t(end)); };
    add(g.frame.lower + Vec3i{below(n.x), below(n.y), below(n.z)});
    add(g.corner[random() % g.corner.size()] + Vec3i{below(8), below(8), below(8)});
    if (!g.inside.empty())
      add(g.inside[random() % g.inside.size()] + Vec3i{below(8), below(8), below(8)});
  }
  for (const Vec3i p : {Vec3i{0, 0, 0}, Vec3i{1, 2, 3}, Vec3i{-7, 50, 11}})
    j["positions"].push_back({triple(p), triple(g.frame.position(p))});
  return j;
}

void read_by(const char* program, const char* needs) {
  const fs::path folder = fs::temp_directory_path() / ("molmesh_vdb." + std::to_string(getpid()));
  fs::create_directories(folder);
  for (const double spacing : {2.0, 0.25}) {
    Hierarchy h = test::random_chains(3, 40, 8, {0.4, 1}, 3);
    h.source = "three chains.pdb sha256:0";
    density::Options o;
    o.spacing = spacing;
    density::Counts counts;
    BlockGrid grid = to_block_grid(density::compute(h, o, counts), 1);
    grid.info.creator = "hier2density 0.1.0";
    const std::string stem = (folder / std::to_string(int(4 * spacing))).string();
    std::ofstream out(stem + ".vdb", std::ios::binary);
    formats::write_vdb(out, grid);
    std::ofstream(stem + ".json") << expected(grid);
  }
  const std::string log = (folder / "log").string();
  const std::string command = std::string("/usr/bin/python3 " MOLMESH_SOURCE_DIR "/tests/reference/read_vdb.py ") +
                              program + " " + folder.string() + " > " + log + " 2>&1";
  const int status = std::system(command.c_str());
  std::ifstream in(log);
  INFO(std::string(std::istreambuf_iterator<char>(in), {}));
  if (WEXITSTATUS(status) == 77 || WEXITSTATUS(status) == 127)
    WARN("skipped: needs " << needs);
  else
    CHECK(status == 0);
  fs::remove_all(folder);
}

} // namespace

TEST_CASE("pyopenvdb reads names, transform and values from our files") {
  read_by("pyopenvdb", "/usr/bin/python3 with python3-openvdb");
}

TEST_CASE("vdb_print reads our files") {
  read_by("vdb_print", "vdb_print of libopenvdb-tools");
}

TEST_CASE("Blender reads the name and transform from our files") {
  read_by("blender", "blender");
}
