// foreign_test.cpp — grids of other programs by the OpenVDB library: fog volumes, level sets, types, transforms.
#include "formats/openvdb/openvdb.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <random>
#include <sstream>

using namespace molmesh;

namespace {

std::string bytes(const openvdb::GridPtrVec& grids) {
  std::ostringstream out;
  openvdb::io::Stream(out).write(grids);
  return out.str();
}

/// A ball of value 1 - r/10 in a grid whose voxels are 0.5 wide, turned about z.
template <class Grid>
typename Grid::Ptr ball(const char* name, bool half) {
  const auto g = Grid::create();
  g->setName(name);
  g->setGridClass(openvdb::GRID_FOG_VOLUME);
  g->setSaveFloatAsHalf(half);
  g->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  g->transform().postRotate(0.5, openvdb::math::Z_AXIS);
  g->transform().postTranslate({3, 4, 5});
  auto a = g->getAccessor();
  for (int x = -10; x <= 10; ++x)
    for (int y = -10; y <= 10; ++y)
      for (int z = -10; z <= 10; ++z)
        if (const double v = 1 - std::sqrt(x * x + y * y + z * z) / 10; v > 0)
          a.setValue({x, y, z}, static_cast<typename Grid::ValueType>(v));
  return g;
}

} // namespace

TEST_CASE("fog volumes of float, double and half floats are read with their transform") {
  openvdb::initialize();
  for (const int kind : {0, 1, 2}) {
    openvdb::GridBase::Ptr g = ball<openvdb::FloatGrid>("fog", kind == 1);
    if (kind == 2)
      g = ball<openvdb::DoubleGrid>("fog", false);
    const formats::ForeignGrid f = formats::read_openvdb(bytes({g}), "", "x.vdb");
    CHECK(f.name == "fog");
    CHECK_FALSE(f.level_set);
    CHECK(f.map.points == Vec3i{21, 21, 21});
    const openvdb::Vec3d o = g->indexToWorld(openvdb::Vec3d(-10, -10, -10));
    CHECK(norm(f.map.origin - Vec3d{o.x(), o.y(), o.z()}) < 1e-12);
    CHECK(norm(f.map.axis[0] - 0.5 * Vec3d{std::cos(0.5), std::sin(0.5), 0}) < 1e-6);
    CHECK(f.map.at({10, 10, 10}) == 1);
    CHECK(f.map.at({10, 10, 13}) == Approx(0.7).epsilon(1e-3));
    CHECK(f.map.at({0, 0, 0}) == 0);
  }
}

TEST_CASE("a level set is positive inside") {
  openvdb::initialize();
  const auto g = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(5, {1, 2, 3}, 0.4);
  const formats::ForeignGrid f = formats::read_openvdb(bytes({g}), "", "x.vdb");
  CHECK(f.level_set);
  int64_t inside = 0;
  for (const float v : f.map.value)
    inside += v > 0;
  CHECK(double(inside) * std::pow(0.4, 3) == Approx(4. / 3 * 3.14159265 * 125).epsilon(0.02));
}

TEST_CASE("the grid is named where there are several, and what is no grid of numbers is refused") {
  openvdb::initialize();
  const auto a = ball<openvdb::FloatGrid>("a", false), b = ball<openvdb::FloatGrid>("b", false);
  const auto mask = openvdb::BoolGrid::create();
  mask->setName("mask");
  mask->tree().setValueOn({0, 0, 0});
  const std::string two = bytes({a, b, mask});
  const auto refusal = [](const std::string& file, const char* name) {
    return test::refusal(Status::bad_input, [&] { formats::read_openvdb(file, name, "x.vdb"); });
  };
  CHECK(formats::read_openvdb(two, "b", "x.vdb").name == "b");
  CHECK(refusal(two, "").find("V2: grids a (float), b (float), mask (bool)") != std::string::npos);
  CHECK(refusal(two, "c").find("expected one named c") != std::string::npos);
  CHECK(refusal(two, "mask").find("type bool") != std::string::npos);
  CHECK(refusal(bytes({openvdb::FloatGrid::create()}), "").find("V4") != std::string::npos);
}

TEST_CASE("damaged files end with one line, whatever the library does") {
  openvdb::initialize();
  const std::string whole = bytes({ball<openvdb::FloatGrid>("fog", false)});
  std::mt19937 random(3);
  int refused = 0;
  for (int n = 0; n < 40; ++n) {
    std::string b = whole;
    if (n % 3 == 0)
      b.resize(random() % b.size());
    else
      for (int k = 0; k < 4; ++k)
        b[60 + random() % (n % 2 ? 400 : b.size() - 60)] = static_cast<char>(random());
    try {
      formats::read_openvdb(b, "", "x.vdb");
    } catch (const Error& e) {
      ++refused;
      CHECK(std::string(e.what()).rfind("x.vdb: V", 0) == 0);
    }
  }
  CHECK(refused >= 13);
}
