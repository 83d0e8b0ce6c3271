// contour_test.cpp — meshes of analytic densities: topology, volume, parts, order.
#include "contour/contour.hpp"
#include "unit/contour/checked.hpp"
#include "unit/contour/sample_grid.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace molmesh;
using namespace molmesh::test;
using contour::Options;

namespace {

constexpr double pi = 3.14159265358979323846;

} // namespace

TEST_CASE("a sphere: volume and area converge, every region is valid", "[slow]") {
  for (double h : {1.0, 0.5, 0.25}) {
    const BlockGrid grid = cube_grid(6, h, atom);
    for (auto meshed : {Options::interior, Options::exterior, Options::both})
      for (double adapt : {0.0, 0.25}) {
        CAPTURE(h, int(meshed), adapt);
        Options options;
        options.meshed = meshed;
        options.adapt = adapt;
        contour::Summary summary;
        const Validity v = checked(mesh_of(grid, options, summary));
        CHECK(v.surface.components == 1);
        CHECK(v.surface.euler == 2);
        CHECK(summary.molecule_volumes.size() == 1);
        CHECK(summary.cavity_volumes.empty());
        if (meshed != Options::interior)
          continue;
        const double volume = 36 * pi, area = 36 * pi;
        CHECK(std::fabs(v.volume / volume - 1) < (adapt > 0 ? 0.26 : 0.16) * h);
        CHECK(std::fabs(v.surface.area / area - 1) < 0.2 * h);
        if (adapt > 0)
          continue;
        CHECK(std::fabs(v.volume / volume - 1) < 0.2 * h * h); // second order
      }
  }
}

TEST_CASE("chords of merged cells cut off little, whatever the tolerance, and large bodies merge", "[slow]") {
  for (int radius : {6, 12, 40}) { // spacings
    CAPTURE(radius);
    const double h = 3. / radius;
    const BlockGrid grid = cube_grid(4, h, atom);
    Options uniform, coarse;
    uniform.adapt = 0;
    coarse.adapt = 0.5;
    const TetMesh fine = mesh_of(grid, uniform), merged = mesh_of(grid, coarse);
    const double lost = 1 - checked(merged).volume / checked(fine).volume;
    CHECK(std::fabs(lost) < 0.007 + 0.0175 * 3 / radius);
    if (radius == 40)
      CHECK(3 * merged.tri.size() < fine.tri.size());
  }
}

TEST_CASE("known shapes have their Euler numbers, components and volumes", "[slow]") {
  const auto torus = [](Vec3d x) {
    const double ring = std::hypot(x.x, x.y) - 4;
    return std::exp(1.5 * 1.5 - ring * ring - x.z * x.z);
  };
  const auto two = [](Vec3d x) {
    return std::exp(4 - norm2(x - Vec3d{3, 0, 0})) + std::exp(4 - norm2(x + Vec3d{3, 0, 0}));
  };
  const auto hollow = [](Vec3d x) {
    const double r = norm(x) - 4;
    return std::exp(1 - r * r);
  };
  struct Known {
    const char* name;
    std::function<double(Vec3d)> f;
    int64_t components, euler;
    double volume, cavity;
  };
  const Known known[] = {{"torus", torus, 1, 0, 2 * pi * pi * 4 * 1.5 * 1.5, 0},
                         {"two spheres", two, 2, 4, 2 * 4. / 3 * pi * 8, 0},
                         {"hollow ball", hollow, 2, 4, 4. / 3 * pi * (125 - 27), 4. / 3 * pi * 27}};
  for (const Known& k : known)
    for (double adapt : {0.0, 0.25}) {
      CAPTURE(k.name, adapt);
      Options options;
      options.meshed = Options::both;
      options.adapt = adapt;
      contour::Summary summary;
      const BlockGrid grid = cube_grid(8, 0.4, k.f);
      const Validity v = checked(mesh_of(grid, options, summary));
      CHECK(v.surface.components == k.components);
      CHECK(v.surface.euler == k.euler);
      CHECK(region_volume(v, molecule) == Approx(k.volume).epsilon(adapt > 0 ? 0.12 : 0.06));
      CHECK(region_volume(v, cavity) == Approx(k.cavity).epsilon(0.06));
      if (k.cavity == 0)
        continue;
      REQUIRE(summary.cavity_volumes.size() == 1);
      CHECK(summary.cavity_volumes[0] == Approx(region_volume(v, cavity)).epsilon(1e-9));
      options.fill_cavities = true;
      const Validity filled = checked(mesh_of(grid, options, summary = {}));
      CHECK(region_volume(filled, cavity) == 0);
      CHECK(summary.cavity_volumes.empty());
      REQUIRE(summary.molecule_volumes.size() == 1); // solid now
      CHECK(summary.molecule_volumes[0] == Approx(region_volume(filled, molecule)).epsilon(1e-9));
      CHECK(filled.surface.components == 1);
      options.fill_cavities = false;
      options.meshed = Options::exterior;
      CHECK(region_volume(checked(mesh_of(grid, options)), cavity) == 0);
    }
}

TEST_CASE("dust is dropped on request only") {
  const auto f = [](Vec3d x) { return atom(x) + std::exp(3 * (0.8 * 0.8 - norm2(x - Vec3d{5, 5, 5}))); };
  const BlockGrid grid = cube_grid(8, 0.4, f);
  for (auto meshed : {Options::interior, Options::exterior, Options::both}) {
    Options options;
    options.meshed = meshed;
    contour::Summary summary;
    CHECK(checked(mesh_of(grid, options, summary)).surface.components == 2);
    CHECK(summary.molecule_volumes.size() == 2);
    options.drop_below = 10;
    CHECK(checked(mesh_of(grid, options, summary = {})).surface.components == 1);
    CHECK(summary.dropped_parts == 1);
  }
}

TEST_CASE("dust in a cavity goes with the cavity, a hollow part goes with its own") {
  const auto shell = [](double r) { return std::exp(0.5 - (r - 4) * (r - 4) * 2); };
  const BlockGrid dust =
      cube_grid(8, 0.4, [&](Vec3d x) { return shell(norm(x)) + std::exp(3 * (0.8 * 0.8 - norm2(x))); });
  const BlockGrid hollow = cube_grid(8, 0.4, [&](Vec3d x) {
    return atom(x - Vec3d{-4.2, -4.2, -4.2}) + shell(norm(x) * 1.6);
  });
  Options options;
  options.meshed = Options::both;
  options.drop_below = 10;
  for (bool fill : {false, true}) {
    options.fill_cavities = fill;
    contour::Summary summary;
    const Validity v = checked(mesh_of(dust, options, summary));
    CHECK(v.surface.components == (fill ? 1 : 2));
    CHECK((region_volume(v, cavity) > 0) == !fill);
    REQUIRE(summary.molecule_volumes.size() == 1); // the dust is part of the cavity, or of what fills it
    CHECK(summary.molecule_volumes[0] == Approx(region_volume(v, molecule)).epsilon(1e-9));
    REQUIRE(summary.cavity_volumes.size() == (fill ? 0 : 1));
    if (!fill)
      CHECK(summary.cavity_volumes[0] == Approx(region_volume(v, cavity)).epsilon(1e-9));
  }
  options.drop_below = 80; // the hollow part (49), not the atom (113)
  for (bool fill : {false, true}) {
    options.fill_cavities = fill;
    const Validity v = checked(mesh_of(hollow, options));
    CHECK(v.surface.components == 1);
    CHECK(region_volume(v, cavity) == 0);
  }
}

TEST_CASE("the same bytes at any number of threads", "[slow]") {
  const BlockGrid grid = cube_grid(6, 0.3, atom);
  for (double adapt : {0.0, 0.25}) {
    Options options;
    options.meshed = Options::both;
    options.adapt = adapt;
    const TetMesh one = mesh_of(grid, options);
    for (int threads : {2, 5}) {
      options.threads = threads;
      const TetMesh many = mesh_of(grid, options);
      CHECK(many.point == one.point);
      CHECK(many.tet == one.tet);
      CHECK(many.tri == one.tri);
      CHECK(many.boundary == one.boundary);
      CHECK(many.region == one.region);
    }
  }
}
