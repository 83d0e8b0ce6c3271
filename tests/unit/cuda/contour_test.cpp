// contour_test.cpp — the device's elements, run by the host: the same, one by one, as contour::make_elements makes.
#include "contour/contour.hpp"
#include "cuda/contour/elements.hpp"
#include "cuda/par/host.hpp"
#include "geom/log.hpp"
#include "unit/contour/sample_grid.hpp"
#include <catch2/catch.hpp>
#include <random>

using namespace molmesh;
using contour::Options;
using test::atom;
using test::cube_grid;

namespace {

struct Seen {
  int64_t calls = 0, differ = 0, runs = 0, face_points = 0, edge_points = 0, spoiled = 0, most_used = 0;

  contour::Elements add(const contour::Complex& c, cuda::ElementMaker<cuda::HostBackend>& maker, bool inside,
                        bool outside) {
    contour::Elements host = contour::make_elements(c, inside, outside, 1);
    const contour::Elements device = maker(c, inside, outside);
    differ += device.tet != host.tet;
    differ += device.tri != host.tri;
    differ += device.tri_sides != host.tri_sides;
    differ += device.boundary != host.boundary;
    differ += device.position != host.position;
    differ += device.spoiled != host.spoiled;
    differ += device.face_points != host.face_points;
    differ += device.edge_points != host.edge_points;
    face_points += host.face_points;
    edge_points += host.edge_points;
    spoiled += static_cast<int64_t>(host.spoiled.size());
    return host;
  }
};

/// The whole of contour(), each of its calls for elements answered by both.
Seen compare(const BlockGrid& grid, const Options& options, int threads = 1,
             int64_t budget = std::numeric_limits<int64_t>::max()) {
  cuda::HostBackend backend(threads, budget);
  cuda::ElementMaker<cuda::HostBackend> maker(backend);
  Seen seen;
  contour::Summary summary;
  contour::Stages stages;
  stages.make_elements = [&](const contour::Complex& c, bool inside, bool outside, int) {
    // As it is asked for, and before grid points went back.
    const contour::Complex unrestored(c.lattice, c.tree, c.cells, c.samples, 1);
    cuda::ElementMaker<cuda::HostBackend> other(backend);
    seen.add(unrestored, other, inside, outside);
    ++seen.calls;
    return seen.add(c, maker, inside, outside);
  };
  contour::contour(
      grid, options, summary, [](const std::string&) {}, stages);
  seen.runs = maker.runs();
  seen.most_used = backend.most_used();
  return seen;
}

} // namespace

TEST_CASE("device elements: the host's, one by one, on random densities with ambiguous cells and ties") {
  std::mt19937_64 random(5);
  Seen sum;
  for (int trial = 0; trial < 24; ++trial) {
    const BlockGrid grid = test::random_grid(random, trial);
    for (auto meshed : {Options::interior, Options::exterior, Options::both})
      for (double adapt : {0.0, 0.3}) {
        CAPTURE(trial, int(meshed), adapt);
        Options options;
        options.meshed = meshed;
        options.adapt = adapt;
        const Seen s = compare(grid, options);
        CHECK(s.differ == 0);
        sum.calls += s.calls;
        sum.face_points += s.face_points;
        sum.edge_points += s.edge_points;
        sum.spoiled += s.spoiled;
      }
  }
  CHECK(sum.calls == 144);
  CHECK(sum.face_points > 1000);
  CHECK(sum.edge_points > 1000);
  CHECK(sum.spoiled > 0);
}

TEST_CASE("device elements: the host's on a molecule, in a cut box, at any number of threads and in many runs") {
  const BlockGrid grid = cube_grid(8, 0.4, [](Vec3d x) { return atom(x) + atom(x - Vec3d{2, 2.5, 1}); });
  Options options;
  options.meshed = Options::both;
  for (double adapt : {0.25, 0.0}) {
    options.adapt = adapt;
    const Seen one = compare(grid, options);
    CHECK(one.differ == 0);
    CHECK(one.runs == 2 * one.calls); // faces, rings
    const Seen many = compare(grid, options, 3, one.most_used / 4 * 3);
    CHECK(many.differ == 0);
    CHECK(many.runs > one.runs);
    CHECK(many.most_used <= one.most_used / 4 * 3);
  }
  options.box.kind = contour::BoxRequest::corners;
  options.box.lower = {-1.1, -9, -9};
  options.box.upper = {9, 1.77, 9};
  CHECK(compare(grid, options).differ == 0);
}

TEST_CASE("the portable logarithm is within two units of the last place of the library's") {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> u(-30, 30);
  for (int i = 0; i < 200000; ++i) {
    const double x = i % 2 ? std::exp(u(random)) : 1 + 1e-3 * u(random), exact = std::log(x);
    if (!(std::fabs(portable_log(x) - exact) <= 4.5e-16 * std::fabs(exact) + 1e-16))
      FAIL("log of " << x);
  }
  CHECK(portable_log(1) == 0);
}
