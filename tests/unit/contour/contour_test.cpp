// contour_test.cpp — meshes of analytic and random densities are valid, and keep the surface's topology.
#include "contour/contour.hpp"
#include "contour/cube.hpp"
#include "error.hpp"
#include "mesh/validity.hpp"
#include "unit/contour/sample_grid.hpp"
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <random>

using namespace molmesh;
using contour::Options;
using test::atom;
using test::cube_grid;

namespace {

constexpr double pi = 3.14159265358979323846;

TetMesh mesh_of(const BlockGrid& grid, const Options& options, contour::Summary& summary) {
  return contour::contour(grid, options, summary, [](const std::string&) {});
}
TetMesh mesh_of(const BlockGrid& grid, const Options& options) {
  contour::Summary summary;
  return mesh_of(grid, options, summary);
}

Validity checked(const TetMesh& mesh) {
  const Validity v = check_validity(mesh, 1);
  for (const Fault& f : v.faults)
    UNSCOPED_INFO(f.rule << " " << f.count << " " << f.example);
  CHECK(v.faults.empty());
  return v;
}

double region_volume(const Validity& v, int32_t region) {
  for (const RegionSummary& r : v.region)
    if (r.region == region)
      return r.volume;
  return 0;
}

/// Euler number of the trilinear isosurface without a mesh: twice that of its inside, which is the alternating sum
/// over cells, faces, edges and points of the Euler numbers of the inside's parts there.
int64_t trilinear_euler(const BlockGrid& grid) {
  const BlockIndex index(grid);
  int64_t chi = 0;
  Vec3i p;
  const Vec3i end = grid.frame.lower + grid.frame.points - Vec3i{1, 1, 1};
  for (p.x = grid.frame.lower.x; p.x < end.x; ++p.x)
    for (p.y = grid.frame.lower.y; p.y < end.y; ++p.y)
      for (p.z = grid.frame.lower.z; p.z < end.z; ++p.z) {
        double v[8];
        for (int c = 0; c < 8; ++c)
          v[c] = value_at(grid, index, p + Vec3i{c & 1, c >> 1 & 1, c >> 2}) - grid.info.isovalue;
        std::array<int, 8> parent;
        std::iota(parent.begin(), parent.end(), 0);
        const auto find = [&](int i) {
          while (parent[static_cast<size_t>(i)] != i)
            i = parent[static_cast<size_t>(i)];
          return i;
        };
        const auto join = [&](int i, int j) { parent[static_cast<size_t>(find(i))] = find(j); };
        for (int c = 0; c < 8; ++c)
          for (int bit = 1; bit < 8; bit *= 2)
            if ((v[c] > 0) == (v[c ^ bit] > 0))
              join(c, c ^ bit);
        for (int f = 0; f < 6; ++f) {
          const int c[4] = {contour::face_corner_of(f, 0), contour::face_corner_of(f, 1),
                            contour::face_corner_of(f, 2), contour::face_corner_of(f, 3)};
          const contour::Diagonal d = contour::face_diagonal(v[c[0]], v[c[1]], v[c[2]], v[c[3]]);
          if (d != contour::Diagonal::none)
            join(contour::diagonal_corners(f, d)[0], contour::diagonal_corners(f, d)[1]);
          if (f % 2)
            continue; // each face once
          const int in = (v[c[0]] > 0) + (v[c[1]] > 0) + (v[c[2]] > 0) + (v[c[3]] > 0);
          const bool apart = d != contour::Diagonal::none && !(v[contour::diagonal_corners(f, d)[0]] > 0);
          chi -= in == 0 ? 0 : apart ? 2 : 1;
        }
        for (int c : {1, 2, 4})
          chi += v[0] > 0 || v[c] > 0;
        chi -= v[0] > 0;
        // The inside's parts in the cell, less the tunnels that the outside makes through them.
        const std::array<int, 8> label = contour::trilinear_components(v);
        for (int c = 0; c < 8; ++c)
          chi +=
              v[c] > 0 ? label[static_cast<size_t>(c)] == c : (label[static_cast<size_t>(c)] == c) - (find(c) == c);
      }
  return 2 * chi;
}

} // namespace

TEST_CASE("the trilinear sweep agrees with a fine resampling of the cell") {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> u(-1, 1);
  constexpr int n = 31;
  int different = 0, compared = 0;
  for (int trial = 0; trial < 600; ++trial) {
    double v[8];
    for (int c = 0; c < 8; ++c)
      v[c] = trial % 3 ? u(random) : std::fabs(u(random)) * (((c ^ c >> 1 ^ c >> 2) & 1) ? 1 : -1);
    if (contour::cell_topology(v).loops < 2)
      continue;
    std::vector<int> parent(n * n * n);
    std::iota(parent.begin(), parent.end(), 0);
    const auto id = [](int x, int y, int z) { return (z * n + y) * n + x; };
    const auto find = [&](int i) {
      while (parent[static_cast<size_t>(i)] != i)
        i = parent[static_cast<size_t>(i)];
      return i;
    };
    const auto in = [&](int x, int y, int z) {
      const double t[3] = {x / (n - 1.), y / (n - 1.), z / (n - 1.)};
      double sum = 0;
      for (int c = 0; c < 8; ++c)
        sum += v[c] * (c & 1 ? t[0] : 1 - t[0]) * (c & 2 ? t[1] : 1 - t[1]) * (c & 4 ? t[2] : 1 - t[2]);
      return sum > 0;
    };
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
          for (int a = 0; a < 3; ++a) {
            const int p[3] = {x - (a == 0), y - (a == 1), z - (a == 2)};
            if (std::min({p[0], p[1], p[2]}) < 0 || in(x, y, z) != in(p[0], p[1], p[2]))
              continue;
            const int i = find(id(x, y, z)), j = find(id(p[0], p[1], p[2]));
            parent[static_cast<size_t>(std::max(i, j))] = std::min(i, j);
          }
    const std::array<int, 8> label = contour::trilinear_components(v);
    const auto corner = [&](int c) {
      return find(id((c & 1) * (n - 1), (c >> 1 & 1) * (n - 1), (c >> 2) * (n - 1)));
    };
    bool same = true;
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < a; ++b)
        if ((v[a] > 0) == (v[b] > 0))
          same =
              same && (corner(a) == corner(b)) == (label[static_cast<size_t>(a)] == label[static_cast<size_t>(b)]);
    ++compared;
    different += !same;
  }
  REQUIRE(compared > 100);
  CHECK(different <= compared / 100); // necks thinner than a resampling step
}

TEST_CASE("a sphere: volume and area converge, every region is valid") {
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

TEST_CASE("chords of merged cells cut off little, whatever the tolerance; large bodies merge") {
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

TEST_CASE("known shapes have their Euler numbers, components and volumes") {
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
      const Validity filled = checked(mesh_of(grid, options));
      CHECK(region_volume(filled, cavity) == 0);
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
    const Validity v = checked(mesh_of(dust, options));
    CHECK(v.surface.components == (fill ? 1 : 2));
    CHECK((region_volume(v, cavity) > 0) == !fill);
  }
  options.drop_below = 80; // the hollow part (49), not the atom (113)
  for (bool fill : {false, true}) {
    options.fill_cavities = fill;
    const Validity v = checked(mesh_of(hollow, options));
    CHECK(v.surface.components == 1);
    CHECK(region_volume(v, cavity) == 0);
  }
}

TEST_CASE("random densities: always valid, ties with the isovalue among them") {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 36; ++trial) {
    const BlockGrid grid = test::random_grid(random, trial);
    const auto meshed = std::array{Options::both, Options::interior, Options::exterior}[size_t(trial / 3 % 3)];
    for (double adapt : {0.0, 0.3}) {
      CAPTURE(trial, int(meshed), adapt);
      Options options;
      options.meshed = meshed;
      options.adapt = adapt;
      checked(mesh_of(grid, options));
    }
  }
}

/// By hand, before a release: test_contour '[thousand]'
TEST_CASE("a thousand random densities: always valid, ties with the isovalue among them", "[.][thousand]") {
  std::mt19937_64 random(6);
  for (int trial = 0; trial < 1000; ++trial) {
    const BlockGrid grid = test::random_grid(random, trial);
    for (double adapt : {0.0, contour::default_adapt(grid.frame.spacing)}) {
      CAPTURE(trial, adapt);
      Options options;
      options.meshed = Options::both;
      options.adapt = adapt;
      checked(mesh_of(grid, options));
    }
  }
}

TEST_CASE("uniform meshes have the Euler number of the trilinear isosurface") {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> u(0, 2);
  for (int trial = 0; trial < 40; ++trial) {
    const BlockGrid grid = test::sample_grid({0, 0, 0}, {8, 8, 8}, 1, 3, [&](Vec3d x) {
      const bool rim = std::min({x.x, x.y, x.z}) < 0.5 || std::max({x.x, x.y, x.z}) > 6.5;
      return rim ? 0.2 : u(random);
    });
    Options options;
    options.adapt = 0;
    const Validity v = checked(mesh_of(grid, options));
    CAPTURE(trial);
    CHECK(v.surface.euler == trilinear_euler(grid));
  }
}

TEST_CASE("the same bytes at any number of threads") {
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

TEST_CASE("boxes: exact walls, a cut through the molecule, few elements far away") {
  const BlockGrid grid = cube_grid(6, 0.5, atom);
  Options options;
  options.meshed = Options::both;
  options.box.kind = contour::BoxRequest::corners;
  options.box.lower = {-7.3, -11.1, -6.2};
  options.box.upper = {8.125, 9.77, 14.01};
  Validity v = checked(mesh_of(grid, options));
  CHECK(v.low == options.box.lower);
  CHECK(v.high == options.box.upper);

  SECTION("a cut") {
    options.box.lower = {-1.1, -9, -9};
    options.box.upper = {9, 0.77, 9};
    for (auto meshed : {Options::interior, Options::exterior, Options::both}) {
      options.meshed = meshed;
      v = checked(mesh_of(grid, options));
    }
    CHECK(v.low == options.box.lower);
    CHECK(v.high == options.box.upper);
    CHECK(region_volume(v, molecule) > 20);
  }
  SECTION("a box that misses the grid") {
    options.box.lower = {100, -9, -9};
    options.box.upper = {120, 9, 9};
    CHECK_THROWS_WITH(mesh_of(grid, options), Catch::Contains("expected a box that meets the grid"));
    options.box.lower = {-9, -9, -120};
    options.box.upper = {9, 9, -100};
    CHECK_THROWS_AS(mesh_of(grid, options), Error);
    options.box.lower = {-1, -1, -1}; // within the molecule
    options.box.upper = {1.5, 1, 1.2};
    CHECK(region_volume(checked(mesh_of(grid, options)), molecule) == Approx(2.5 * 2 * 2.2));
    options.meshed = Options::exterior;
    CHECK_THROWS_WITH(mesh_of(grid, options), Catch::Contains("nothing to mesh"));
  }
  SECTION("a far box") {
    options.box.kind = contour::BoxRequest::factor;
    options.box.scale = 3;
    const size_t near = mesh_of(grid, options).tet.size();
    options.box.scale = 40;
    const TetMesh far = mesh_of(grid, options);
    v = checked(far);
    CHECK(v.high.x - v.low.x == Approx(40 * 6));
    // A shell for each doubling of the box, whatever the molecule's size.
    CHECK(double(far.tet.size()) - double(near) < 6000 * std::log2(40. / 3));
    options.box.scale = 20; // 130 spacings: no multiple of a large cell's edge
    CHECK(mesh_of(grid, options).tet.size() < far.tet.size());
  }
}

TEST_CASE("a surface that meets the wall is refused unless the box was asked to cut it") {
  const BlockGrid grid = cube_grid(2.5, 0.5, atom); // all inside but for nothing: no surface
  Options options;
  CHECK_THROWS_AS(mesh_of(grid, options), Error);
  const BlockGrid cut = test::sample_grid({-12, -12, 0}, {25, 25, 13}, 0.5, 2, atom);
  CHECK_THROWS_AS(mesh_of(cut, options), Error);
}
