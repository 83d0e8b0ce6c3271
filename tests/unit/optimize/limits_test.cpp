// limits_test.cpp — more than indices hold, and boxes beyond all measure.
#include "base/error.hpp"
#include "lattice_mesh.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include "optimize/optimize.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

TEST_CASE("meshes that 32-bit indices do not hold are refused") {
  const int64_t whole = int64_t{1} << 32;
  CHECK_NOTHROW(optimize::require_size(whole / 4 - 1, 3, INT32_MAX));
  CHECK_NOTHROW(optimize::require_slots(INT32_MAX, INT32_MAX));
  const auto status = [](auto&& f) {
    try {
      f();
    } catch (const Error& e) {
      CHECK(std::string(e.what()).find('\n') == std::string::npos);
      return e.status;
    }
    return Status::good;
  };
  CHECK(status([&] { optimize::require_size(whole / 4, 0, 4); }) == Status::bad_input);
  CHECK(status([&] { optimize::require_size(whole / 4 - 1, 4, 4); }) == Status::bad_input);
  CHECK(status([&] { optimize::require_size(1, 4, whole / 2); }) == Status::bad_input);
  CHECK(status([&] { optimize::require_slots(whole / 2, 4); }) == Status::failed);
  CHECK(status([&] { optimize::require_slots(4, whole / 2); }) == Status::failed);
}

TEST_CASE("a box beyond all measure is improved as another is") {
  const Field ball = [](Vec3d p) { return std::exp(-0.3 * (norm2(p - Vec3d{2.6, 2.5, 2.4}) - 1.44)); };
  TetMesh mesh = lattice_mesh(ball, {0, 0, 0}, 0.5, 10);
  Vec3d low = mesh.point[0], high = low;
  for (const Vec3d& p : mesh.point)
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a]);
    }
  for (Vec3d& p : mesh.point) // the walls move out: all elements stay positive
    for (int a = 0; a < 3; ++a)
      p[a] = p[a] == low[a] ? -1e29 : p[a] == high[a] ? 1e29 : p[a];
  for (int32_t& l : mesh.boundary)
    l = surface; // of one label, curved
  optimize::Options how;
  how.iterations = 2;
  const optimize::Result result = optimize::improve(mesh, nullptr, how);
  CHECK(result.counts.total() > 0);
  CHECK(result.after.below_25 < result.before.below_25);
}
