// vdb_openvdb_test.cpp — OpenVDB itself reads what we write, and we read what it writes.
#include "base/error.hpp"
#include "formats/vdb/vdb.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>
#include <fstream>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <random>
#include <sstream>

using namespace molmesh;

namespace {

/// A ball's shell with noise: leaves full, mixed and sparse, a tile of 128³ inside.
BlockGrid shell() {
  BlockGrid g;
  g.frame = {{1.5, -2.25, 0.1}, 0.3, {-104, -104, -104}, {209, 209, 209}};
  g.info = {1, 1.25, 0.9, 1.1, 1e-5, 2, 1234567890123, 77, "chain residue", "x", "test 1"};
  std::mt19937 random(3);
  std::uniform_real_distribution<float> u(0.9f, 1.1f);
  for (int x = -104; x < 104; x += 8)
    for (int y = -104; y < 104; y += 8)
      for (int z = -104; z < 104; z += 8) {
        int on = 0, in = 0;
        float value[512];
        uint64_t active[8] = {};
        for (int s = 0; s < 512; ++s) {
          const Vec3d p{x + (s >> 6) + 0.5, y + (s >> 3 & 7) + 0.5, z + (s & 7) + 0.5};
          const double d = norm(p) - 95;
          value[s] = std::abs(d) < 1.5 ? u(random) : d < 0 ? 2.0f : 0.0f;
          if (std::abs(d) < 1.5)
            active[s >> 6] |= uint64_t{1} << (s & 63), ++on;
          in += d < 0;
        }
        if (on) {
          g.corner.push_back({x, y, z});
          g.value.insert(g.value.end(), value, value + 512);
          g.active.insert(g.active.end(), active, active + 8);
        } else if (in) {
          g.inside.push_back({x, y, z});
        }
      }
  return g;
}

void check_equal(const BlockGrid& a, const BlockGrid& b) {
  CHECK(a.frame.origin == b.frame.origin);
  CHECK(a.frame.spacing == b.frame.spacing);
  CHECK(a.frame.points == b.frame.points);
  CHECK(a.info.analyzed_points == b.info.analyzed_points);
  CHECK(a.info.levels == b.info.levels);
  CHECK(a.corner == b.corner);
  CHECK(a.value == b.value);
  CHECK(a.active == b.active);
  CHECK(a.inside == b.inside);
}

openvdb::FloatGrid::Ptr by_openvdb(const BlockGrid& g) {
  openvdb::initialize();
  std::stringstream bytes;
  formats::write_vdb(bytes, g);
  const openvdb::GridPtrVecPtr grids = openvdb::io::Stream(static_cast<std::istream&>(bytes), false).getGrids();
  REQUIRE(grids->size() == 1);
  return openvdb::gridPtrCast<openvdb::FloatGrid>(grids->front());
}

} // namespace

TEST_CASE("OpenVDB reads our file: every point, its state, the transform, the metadata") {
  const BlockGrid g = shell();
  const openvdb::FloatGrid::Ptr grid = by_openvdb(g);
  REQUIRE(grid);
  CHECK(grid->getName() == "density");
  CHECK(grid->background() == 0);
  CHECK(grid->metaValue<int32_t>("molmesh_profile") == 1);
  CHECK(grid->metaValue<double>("decay") == 1.25);
  CHECK(grid->metaValue<double>("tolerance") == 1e-5);
  CHECK(grid->metaValue<openvdb::Vec3i>("grid_points") == openvdb::Vec3i(209));
  CHECK(grid->metaValue<openvdb::Vec3i>("grid_origin") == openvdb::Vec3i(-104));
  CHECK(grid->metaValue<int64_t>("analyzed_points") == 1234567890123);
  CHECK(grid->metaValue<std::string>("levels") == "chain residue");
  const openvdb::Vec3d p = grid->indexToWorld(openvdb::Coord(1, 2, 3));
  CHECK(p.x() == Approx(1.8));
  CHECK(p.y() == Approx(-1.65));
  CHECK(p.z() == Approx(1.0));
  const BlockIndex index(g);
  int64_t wrong = 0, active = 0;
  openvdb::FloatGrid::ConstAccessor at = grid->getConstAccessor();
  for (int x = -112; x < 112; ++x)
    for (int y = -112; y < 112; ++y)
      for (int z = -112; z < 112; ++z) {
        float v = 0;
        const bool on = at.probeValue(openvdb::Coord(x, y, z), v);
        wrong += v != value_at(g, index, {x, y, z}) || on != is_active(g, index, {x, y, z});
        active += on;
      }
  CHECK(wrong == 0);
  CHECK(active == static_cast<int64_t>(grid->activeVoxelCount()));
}

TEST_CASE("we read what OpenVDB writes, with every compression, to a stream and to a file") {
  const BlockGrid g = shell();
  const openvdb::FloatGrid::Ptr grid = by_openvdb(g);
  using namespace openvdb::io;
  for (const uint32_t compression : {0u, 1u, 2u, 3u, 4u, 6u}) {
    INFO("compression " << compression);
    std::stringstream bytes;
    Stream stream(static_cast<std::ostream&>(bytes));
    stream.setCompression(compression);
    stream.write(openvdb::GridCPtrVec{grid});
    check_equal(formats::read_vdb(bytes, "stream"), g);
  }
  const std::string path = "vdb_openvdb_test.vdb";
  openvdb::Int32Grid::Ptr other = openvdb::Int32Grid::create();
  other->setName("labels");
  other->tree().setValue(openvdb::Coord(1, 2, 3), 4);
  File file(path);
  file.write(openvdb::GridCPtrVec{other, grid});
  file.close();
  std::ifstream in(path, std::ios::binary);
  check_equal(formats::read_vdb(in, path), g);
  std::remove(path.c_str());
}

TEST_CASE("grids of OpenVDB that are not ours are refused by their rule") {
  openvdb::initialize();
  const auto refusal = [](const openvdb::GridBase::Ptr& grid, const char* name) {
    grid->setName(name);
    std::stringstream bytes;
    openvdb::io::Stream(static_cast<std::ostream&>(bytes)).write(openvdb::GridCPtrVec{grid});
    return test::refusal(Status::bad_input, [&] { formats::read_vdb(bytes, "x"); }).substr(0, 6);
  };
  CHECK(refusal(openvdb::DoubleGrid::create(), "density") == "x: R4:");
  CHECK(refusal(openvdb::FloatGrid::create(), "temperature") == "x: R4:");
  CHECK(refusal(openvdb::FloatGrid::create(), "density") == "x: R5:");
  const auto with_profile = [] {
    const openvdb::FloatGrid::Ptr grid = by_openvdb(shell());
    return grid;
  };
  openvdb::FloatGrid::Ptr grid = with_profile();
  grid->setTransform(openvdb::math::Transform::createLinearTransform(
      openvdb::Mat4d(0.3, 0., 0., 0., 0., 0.3, 0., 0., 0., 0., 0.4, 0., 1., 2., 3., 1.)));
  CHECK(refusal(grid, "density") == "x: R9:");
  grid = with_profile();
  grid->transform().postRotate(0.1);
  CHECK(refusal(grid, "density") == "x: R9:");
  grid = with_profile();
  grid->setSaveFloatAsHalf(true);
  CHECK(refusal(grid, "density") == "x: R4:");
  grid = with_profile();
  grid->removeMeta("atoms");
  grid->insertMeta("atoms", openvdb::Int32Metadata(3));
  CHECK(refusal(grid, "density") == "x: R6:");
  grid = with_profile();
  grid->tree().addTile(1, openvdb::Coord(96, 96, 96), 1.0f, true);
  CHECK(refusal(grid, "density") == "x: R10");
}
