// contour_test.cpp — the device's complex and elements, run by the host: the same, bit by bit, as
// contour::make_dual makes.
#include "contour/assembly.hpp"
#include "contour/contour.hpp"
#include "contour/detail/assembly_passes.hpp"
#include "contour/detail/region_passes.hpp"
#include "cuda/contour/device_mesh.hpp"
#include "cuda/contour/dual.hpp"
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
  int64_t calls = 0, differ = 0, runs = 0, on_host = 0, face_points = 0, edge_points = 0, restored = 0,
          most_used = 0;
};

template <class T>
bool same(const LargeArray<T>& device, const LargeArray<T>& host) {
  return device.size() == host.size() && std::equal(device.begin(), device.end(), host.begin());
}

/// Regions and mesh from these elements: how many of their arrays differ.
int64_t differ_after(cuda::HostBackend& backend, const contour::Dual& d, const Options& o) {
  const contour::ComplexView& c = d.complex.view;
  const contour::RegionOptions options{o.fill_cavities, o.drop_below};
  const contour::Components host = contour::find_components(c, d.elements, options, 1);
  const contour::detail::RegionPasses<cuda::HostBackend> device(backend, c, d.elements.view(), options);
  int64_t differ = device.component.size() != host.component.size();
  for (size_t i = 0; differ == 0 && i < host.component.size(); ++i) {
    const contour::Component &a = device.component[i], &b = host.component[i];
    differ += a.inside != b.inside || a.at_wall != b.at_wall || a.volume != b.volume || a.region != b.region;
  }
  differ += !std::equal(host.region_of_vertex.begin(), host.region_of_vertex.end(), device.region.data());
  cuda::DeviceMesh<cuda::HostBackend> room(backend);
  contour::detail::assemble(backend, d.elements.view(), device.region.data(), device.region.size(),
                            contour::detail::wanted(o.meshed), room);
  const TetMesh a = room.on_host(), b = contour::assemble(d.elements, host, o.meshed, 1);
  return differ + (a.tet != b.tet) + (a.region != b.region) + (a.point != b.point) + (a.tri != b.tri) +
         (a.boundary != b.boundary);
}

/// The whole of contour(), complex and elements made by both.
Seen compare(const BlockGrid& grid, const Options& options, int threads = 1,
             int64_t budget = std::numeric_limits<int64_t>::max()) {
  cuda::HostBackend backend(threads, budget);
  cuda::Selection<cuda::HostBackend> selection(backend);
  cuda::DualMaker<cuda::HostBackend> maker(backend, selection);
  Seen seen;
  contour::Summary summary;
  contour::Stages stages;
  stages.find_surface = [&](const contour::Lattice& l, int) { return selection.find_surface(l); };
  stages.select_leaves = [&](const contour::Lattice& l, const contour::Surface&, const contour::RefineOptions& o,
                             int) { return selection.select_leaves(l, o); };
  stages.make_dual = [&](const contour::DualInput& in, const auto& on_phase) {
    contour::Dual host = contour::make_dual(in, on_phase), device = maker(in, on_phase);
    const contour::Complex &a = device.complex, &b = host.complex;
    seen.differ += !same(a.side, b.side) + !same(a.grid_vertex, b.grid_vertex) + !same(a.first_cell, b.first_cell) +
                   !same(a.split, b.split) + !same(a.split_leaf, b.split_leaf) + !same(a.value, b.value) +
                   !same(a.point, b.point) + !same(a.nearest, b.nearest);
    const contour::Elements &e = device.elements, &f = host.elements;
    seen.differ += !same(e.tet, f.tet) + !same(e.tri, f.tri) + !same(e.tri_sides, f.tri_sides) +
                   !same(e.boundary, f.boundary) + !same(e.position, f.position);
    seen.differ += e.face_points != f.face_points || e.edge_points != f.edge_points;
    seen.differ += device.restored_points != host.restored_points;
    seen.restored += host.restored_points;
    seen.face_points += f.face_points;
    seen.edge_points += f.edge_points;
    ++seen.calls;
    cuda::HostBackend rest(threads);
    seen.differ += differ_after(rest, host, options);
    return device;
  };
  contour::contour(
      grid, options, summary, [](const std::string&) {}, stages);
  seen.runs = maker.runs();
  seen.on_host = maker.on_host();
  seen.most_used = backend.most_used();
  return seen;
}

} // namespace

TEST_CASE(
    "device complex and elements: the host's, one by one, on random densities with ambiguous cells and ties") {
  std::mt19937_64 random(5);
  Seen sum;
  for (int trial = 0; trial < 24; ++trial) {
    const BlockGrid grid = test::random_grid(random, trial);
    for (auto meshed : {Options::interior, Options::exterior, Options::both})
      for (double adapt : {0.0, 0.3}) {
        CAPTURE(trial, int(meshed), adapt);
        Options options;
        if (trial % 2) { // walls through the grid
          const double in = 1.25, end = grid.frame.lower.x + in;
          options.box.kind = contour::BoxRequest::corners;
          options.box.lower = {end, end, end};
          options.box.upper = {-end, -end, -end};
        }
        options.meshed = meshed;
        options.adapt = adapt;
        options.fill_cavities = trial % 3 == 0;
        options.drop_below = trial % 4 == 1 ? 1.5 : 0;
        const Seen s = compare(grid, options, trial % 8 == 7 ? 3 : 1);
        CHECK(s.differ == 0);
        sum.calls += s.calls;
        sum.face_points += s.face_points;
        sum.edge_points += s.edge_points;
        sum.restored += s.restored;
      }
  }
  CHECK(sum.calls == 144);
  CHECK(sum.face_points > 1000);
  CHECK(sum.edge_points > 1000);
  CHECK(sum.restored > 0);
}

TEST_CASE("device complex and elements: the host's on a molecule, in a cut box, at any number of threads and in "
          "many runs") {
  const BlockGrid grid = cube_grid(8, 0.4, [](Vec3d x) { return atom(x) + atom(x - Vec3d{2, 2.5, 1}); });
  Options options;
  options.meshed = Options::both;
  int64_t in_runs = 0, by_host = 0;
  for (double adapt : {0.25, 0.0}) {
    options.adapt = adapt;
    const Seen one = compare(grid, options);
    CHECK(one.differ == 0);
    // Of less and less memory, until the surface alone does not fit.
    for (int percent = 95; percent > 0; percent -= 5) {
      const int64_t budget = one.most_used * percent / 100;
      try {
        const Seen less = compare(grid, options, 3, budget);
        CHECK(less.differ == 0);
        CHECK(less.most_used <= budget);
        in_runs += less.runs > one.runs;
        by_host += less.on_host; // said in the report
      } catch (const cuda::OutOfRoom&) {
        break;
      }
    }
  }
  CHECK(in_runs > 0);
  CHECK(by_host > 0);
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
