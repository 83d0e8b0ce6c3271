// contour_test.cpp — the device's stages, run by the host: the same, bit by bit, as contour::HostStages makes.
#include "base/log.hpp"
#include "contour/contour.hpp"
#include "cuda/contour/device_stages.hpp"
#include "cuda/par/host.hpp"
#include "unit/contour/octree_forms.hpp"
#include "unit/refusal.hpp"
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <random>

using namespace molmesh;
using contour::Options;
using test::atom;
using test::cube_grid;

namespace {

struct Seen {
  int64_t differ = 0, runs = 0;
  contour::Summary summary;
  cuda::DeviceReport report;
};

template <class A, class B>
bool same(const A& device, const B& host) {
  return static_cast<int64_t>(device.size()) == static_cast<int64_t>(host.size()) &&
         std::equal(host.begin(), host.end(), device.data());
}

/// Each stage by both; what differs is counted.
class Both final : public contour::Stages {
public:
  Both(cuda::HostBackend& backend, int threads) : host_(threads), device_(backend, threads, 2000, 5000) {}
  void find_surface(const contour::Lattice& lattice) override {
    host_.find_surface(lattice);
    device_.find_surface(lattice);
  }
  void select_leaves(const contour::RefineOptions& options) override {
    host_.select_leaves(options);
    device_.select_leaves(options);
  }
  void make_dual(contour::Side unasked, const std::function<void(const std::string&)>& on_phase) override {
    host_.make_dual(unasked, on_phase);
    device_.make_dual(unasked, on_phase);
    compare_elements();
  }
  void relax() override {
    host_.relax();
    device_.relax();
    compare_elements();
  }
  std::vector<contour::Component> find_regions(const contour::RegionOptions& options) override {
    const auto a = host_.find_regions(options), b = device_.find_regions(options);
    differ_ += a.size() != b.size();
    for (size_t i = 0; i < a.size() && a.size() == b.size(); ++i)
      differ_ += a[i].inside != b[i].inside || a[i].at_wall != b[i].at_wall || a[i].volume != b[i].volume ||
                 a[i].region != b[i].region;
    return b;
  }
  TetMesh assemble(Options::Meshed meshed) override {
    const TetMesh a = host_.assemble(meshed);
    TetMesh b = device_.assemble(meshed);
    differ_ += (a.tet != b.tet) + (a.region != b.region) + (a.point != b.point) + (a.tri != b.tri) +
               (a.boundary != b.boundary);
    return b;
  }
  void count(contour::Summary& summary) const override {
    contour::Summary a;
    host_.count(a);
    device_.count(summary);
    const contour::Summary& b = summary;
    differ_ += a.leaves != b.leaves || a.surface_cells != b.surface_cells || a.split_cells != b.split_cells ||
               a.restored_points != b.restored_points || a.relaxed_points != b.relaxed_points ||
               a.face_points != b.face_points || a.edge_points != b.edge_points;
  }
  int64_t differ() const { return differ_; }
  const cuda::DeviceStages<cuda::HostBackend>& device() const { return device_; }

private:
  void compare_elements() {
    const contour::Elements& f = host_.dual().elements;
    const auto& e = device_.elements();
    differ_ += !same(e.tet, f.tet) + !same(e.tri, f.tri) + !same(e.tri_sides, f.tri_sides) +
               !same(e.boundary, f.boundary) + !same(e.position, f.position);
  }
  contour::HostStages host_;
  cuda::DeviceStages<cuda::HostBackend> device_;
  mutable int64_t differ_ = 0;
};

Seen compare(const BlockGrid& grid, const Options& o, int threads = 1, cuda::Bytes most = {}) {
  cuda::HostBackend backend(threads, most);
  Both both(backend, threads);
  Options options = o;
  options.threads = threads;
  Seen seen;
  contour::contour(
      grid, options, seen.summary, [](const std::string&) {}, both);
  seen.differ = both.differ();
  seen.runs = both.device().runs();
  seen.report = cuda::report_of(backend, "the host");
  return seen;
}

} // namespace

TEST_CASE("device stages: the host's, one by one, on random densities with ambiguous cells and ties", "[slow]") {
  std::mt19937_64 random(5);
  contour::Summary sum;
  int64_t meshes = 0, dropped = 0, filled = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const BlockGrid grid = test::random_grid(random, trial);
    const auto meshed = std::array{Options::interior, Options::exterior, Options::both}[trial / 2 % 3];
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
      CHECK(s.report.note.empty());
      ++meshes;
      sum.face_points += s.summary.face_points;
      sum.edge_points += s.summary.edge_points;
      sum.restored_points += s.summary.restored_points;
      sum.relaxed_points += s.summary.relaxed_points;
      dropped += s.summary.dropped_parts;
      filled += s.summary.filled_cavities;
    }
  }
  CHECK(meshes == 48);
  CHECK(sum.face_points > 1000);
  CHECK(sum.edge_points > 1000);
  CHECK(sum.restored_points > 0);
  CHECK(sum.relaxed_points > 1000);
  CHECK(dropped > 0);
  CHECK(filled > 0);
}

TEST_CASE("device stages: the host's on a molecule, in a cut box, at any number of threads and with little memory",
          "[slow]") {
  const BlockGrid grid = cube_grid(8, 0.8, [](Vec3d x) { return atom(x) + atom(x - Vec3d{2, 2.5, 1}); });
  Options options;
  options.meshed = Options::both;
  int64_t in_runs = 0;
  for (double adapt : {0.25, 0.0}) {
    options.adapt = adapt;
    const Seen one = compare(grid, options, 2);
    CHECK(one.differ == 0);
    CHECK(one.report.note.empty());
    CHECK(one.report.most_used.paged == 0);
    const int64_t all = one.report.most_used.own;
    // Of less and less memory, down to none.
    for (const int percent : {90, 60, 30, 10, 0}) {
      const int64_t own = all * percent / 100;
      CAPTURE(adapt, percent);
      const Seen less = compare(grid, options, 3, {own, 2 * all});
      CHECK(less.differ == 0);
      CHECK(less.report.most_used.own <= own);
      CHECK(less.report.most_used.paged > 0);
      CHECK(less.report.note.find("paged from the host's memory") != std::string::npos);
      in_runs += less.runs > one.runs;
    }
    const std::string line = test::refusal(Status::failed, [&] { compare(grid, options, 1, {all / 2, all / 8}); });
    CHECK(line.find("not enough memory on the device") != std::string::npos);
  }
  CHECK(in_runs > 0);
  options.box.kind = contour::BoxRequest::corners;
  options.box.lower = {-1.1, -9, -9};
  options.box.upper = {9, 1.77, 9};
  CHECK(compare(grid, options).differ == 0);
}

TEST_CASE("device stages: the host's with sizes, layers, owners, an outer sphere and a halved spacing", "[slow]") {
  const BlockGrid ball = test::ball_grid();
  const Seen plain = compare(ball, test::plain_form(), 2);
  CHECK(plain.differ == 0);
  for (const auto& [name, options] : test::octree_forms()) {
    CAPTURE(name);
    const Seen s = compare(ball, options, 2);
    CHECK(s.differ == 0);
    CHECK(s.summary.leaves > plain.summary.leaves);
  }
  const Seen thin = compare(test::thin_body_grid(), test::plain_form(), 2);
  CHECK(thin.differ == 0);
  CHECK(thin.summary.halvings > 0);
}

TEST_CASE("device stages: the host's where surface triangles far from the isosurface come nearer", "[slow]") {
  Options options;
  options.adapt = 0.41;
  for (const unsigned seed : {3u, 4u, 6u}) {
    const Seen seen = compare(test::creased_grid(seed), options, 2);
    CHECK(seen.differ == 0);
    const auto& kernels = seen.report.kernels;
    CHECK(std::any_of(kernels.begin(), kernels.end(), [](const auto& k) { return k.name == "move nearer"; }));
  }
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
