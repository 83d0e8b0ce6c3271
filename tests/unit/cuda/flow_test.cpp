// flow_test.cpp — the device's geometric flow, run by the host: never worse (I9), on the surface, deterministic.
#include "contour/contour.hpp"
#include "cuda/optimize/geometric_flow.hpp"
#include "cuda/par/host.hpp"
#include "geom/predicates.hpp"
#include "unit/optimize/lattice_mesh.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

namespace {

constexpr double h = 0.5;
constexpr int n = 20;

float worst(const optimize::DynamicMesh& m) {
  float w = 2;
  for (const optimize::Element& e : m.element)
    if (e.alive())
      w = std::min(w, m.quality(e.v));
  return w;
}

double total_deficit(const optimize::DynamicMesh& m, const optimize::Pass& pass) {
  double sum = 0;
  for (const optimize::Element& e : m.element)
    if (e.alive())
      sum += optimize::deficit(m.quality(e.v), pass.goal, pass.worst_first, pass.guard);
  return sum;
}

optimize::Pass pass_with(double degrees, bool worst_first) {
  optimize::Pass p;
  p.goal = static_cast<float>(angle_quality(degrees));
  p.worst_first = worst_first;
  return p;
}

} // namespace

TEST_CASE("flow: the worst element rises, none is inverted, what is bound stays bound", "[slow]") {
  const BlockGrid grid = lattice_grid(three_atoms, {0, 0, 0}, h, n);
  const Isosurface surface(grid, 1);
  const int keep = GENERATE(0, 1, 2);
  const bool with_surface = GENERATE(true, false), worst_first = GENERATE(true, false);
  CAPTURE(keep, with_surface, worst_first);
  optimize::DynamicMesh m = optimize::build(lattice_mesh(three_atoms, {0, 0, 0}, h, n, keep), 180, 1);
  const optimize::Pass pass = pass_with(26, worst_first);
  const optimize::DynamicMesh before = m;
  cuda::HostBackend backend(1);
  cuda::Flow<cuda::HostBackend> flow(backend, with_surface ? &surface : nullptr, 1);
  const int64_t moves = flow.run(m, pass, 8);
  CHECK(moves > 100);
  CHECK(flow.visited() >= moves);
  CHECK(worst(m) >= worst(before));
  CHECK(total_deficit(m, pass) < 0.9 * total_deficit(before, pass));
  int64_t moved = 0, wrong = 0, off = 0, stale = 0;
  for (const optimize::Element& e : m.element) {
    if (!e.alive())
      continue;
    const auto p = [&](size_t i) { return m.point[e.v[i]]; };
    wrong += orient3d(p(0), p(1), p(2), p(3)) <= 0;
    stale += e.q != m.quality(e.v);
  }
  for (size_t v = 0; v < m.point.size(); ++v) {
    if (m.point[v] == before.point[v])
      continue;
    ++moved;
    const optimize::Vertex& k = m.vertex[v];
    wrong += k.kind == optimize::Kind::fixed || k.kind == optimize::Kind::trace;
    for (int a = 0; a < 3; ++a)
      wrong += (k.frozen >> a & 1) && m.point[v][a] != before.point[v][a];
    if (k.kind != optimize::Kind::surface)
      continue;
    double distance = 1;
    Vec3d normal;
    off += !with_surface || !surface.probe(m.point[v], distance, normal) || std::abs(distance) > 0.001 * h;
  }
  CHECK(moved > 50);
  CHECK(wrong == 0);
  CHECK(off == 0);
  CHECK(stale == 0);
}

TEST_CASE("flow: the same points at any number of threads, and a goal that is met moves nothing") {
  const BlockGrid grid = lattice_grid(three_atoms, {0, 0, 0}, h, n);
  const Isosurface surface(grid, 1);
  optimize::DynamicMesh one = optimize::build(lattice_mesh(three_atoms, {0, 0, 0}, h, n), 180, 1), more = one;
  const optimize::Pass pass = pass_with(26, true);
  for (auto [m, threads] : {std::pair{&one, 1}, {&more, 3}}) {
    cuda::HostBackend backend(threads);
    cuda::Flow<cuda::HostBackend>(backend, &surface, threads).run(*m, pass, 5);
  }
  CHECK(one.point == more.point);
  const std::vector<Vec3d> before = one.point;
  cuda::HostBackend backend;
  optimize::Pass met;
  met.goal = std::min(1e-7f, 0.5f * worst(one));
  CHECK(cuda::Flow<cuda::HostBackend>(backend, &surface, 1).run(one, met, 5) == 0);
  CHECK(one.point == before);
}

TEST_CASE("flow: points are grouped by valence and stars are complete") {
  const optimize::DynamicMesh m = optimize::build(lattice_mesh(three_atoms, {0, 0, 0}, h, n), 180, 1);
  std::vector<cuda::Corners> corners;
  for (const optimize::Element& e : m.element)
    corners.push_back({{e.v[0], e.v[1], e.v[2], e.v[3]}});
  cuda::HostBackend backend;
  const cuda::Stars<cuda::HostBackend> stars(backend, corners.data(), int64_t(corners.size()),
                                             static_cast<int64_t>(m.point.size()));
  const auto order = stars.by_valence();
  std::vector<int> seen(m.point.size(), 0);
  int64_t last = int64_t{1} << 40, wrong = 0;
  for (int64_t i = 0; i < order.size(); ++i) {
    const uint32_t v = order.data()[i];
    ++seen[v];
    const int64_t begin = stars.begin.data()[v], end = stars.begin.data()[v + 1];
    wrong += end - begin > last;
    last = end - begin;
    for (int64_t k = begin; k < end; ++k) {
      const cuda::Corners& c = corners[stars.item.data()[k]];
      wrong += std::count(c.v, c.v + 4, int32_t(v)) != 1;
    }
  }
  CHECK(wrong == 0);
  CHECK(std::count(seen.begin(), seen.end(), 1) == std::ptrdiff_t(seen.size()));
  CHECK(stars.begin.data()[m.point.size()] == 4 * std::ptrdiff_t(corners.size()));
}

TEST_CASE("improvement with the device's flow keeps what improvement keeps, at any number of threads", "[slow]") {
  const BlockGrid grid = lattice_grid(three_atoms, {0, 0, 0}, h, n);
  const bool with_density = GENERATE(true, false);
  std::vector<TetMesh> result;
  for (const int threads : {1, 3}) {
    TetMesh mesh = lattice_mesh(three_atoms, {0, 0, 0}, h, n);
    cuda::HostBackend backend(threads);
    std::unique_ptr<cuda::Flow<cuda::HostBackend>> flow;
    optimize::Options options;
    options.threads = threads;
    const optimize::Result r =
        optimize::improve(mesh, with_density ? &grid : nullptr, options, {},
                          [&](optimize::DynamicMesh& m, const Isosurface* surface, const optimize::Pass& pass) {
                            if (!flow)
                              flow = std::make_unique<cuda::Flow<cuda::HostBackend>>(backend, surface, threads);
                            return flow->run(m, pass, 4);
                          });
    CHECK(r.after.min >= 25);
    CHECK(r.after.max <= 140);
    CHECK(r.after.min >= r.before.min);
    CHECK(r.fidelity.points_off == 0);
    CHECK_NOTHROW(optimize::build(mesh, 180, 1));
    result.push_back(std::move(mesh));
  }
  CHECK(result[0].point == result[1].point);
  CHECK(result[0].tet == result[1].tet);
}

TEST_CASE("flow: points of the outer sphere stay, others move, and improvement keeps the sphere", "[slow]") {
  const BlockGrid grid = lattice_grid(three_atoms, {0, 0, 0}, h, n);
  const Isosurface surface(grid, 1);
  contour::Options options;
  options.meshed = contour::Options::both;
  options.box.kind = contour::BoxRequest::sphere_factor;
  options.box.scale = 1.6;
  contour::Summary summary;
  TetMesh mesh = contour::contour(grid, options, summary, [](const std::string&) {});
  optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  const std::vector<Vec3d> before = m.point;
  cuda::HostBackend backend;
  cuda::Flow<cuda::HostBackend> flow(backend, &surface, 1);
  CHECK(flow.run(m, pass_with(26, true), 4) > 100);
  int64_t round = 0, moved = 0;
  for (size_t v = 0; v < before.size(); ++v)
    if (m.vertex[v].kind == optimize::Kind::round) {
      ++round;
      moved += m.point[v] != before[v];
    }
  CHECK(round > 50);
  CHECK(moved == 0);
  const optimize::Result r = optimize::improve(
      mesh, &grid, {}, {}, [&](optimize::DynamicMesh& now, const Isosurface* target, const optimize::Pass& pass) {
        return cuda::Flow<cuda::HostBackend>(backend, target, 1).run(now, pass, 2);
      });
  CHECK(r.after.min >= 25);
  CHECK(r.after.max <= 140);
  REQUIRE(mesh.sphere);
  double off = 0;
  for (size_t t = 0; t < mesh.tri.size(); ++t)
    if (mesh.boundary[t] == Boundary::outer_sphere)
      for (const int32_t v : mesh.tri[t])
        off = std::max(off, std::abs(mesh.sphere->height(mesh.point[v])));
  CHECK(off < 1e-12 * mesh.sphere->radius);
}

TEST_CASE("flow: what stays on the device between rounds is what a mesh sent anew would be, for fewer bytes",
          "[slow]") {
  const BlockGrid grid = lattice_grid(three_atoms, {0, 0, 0}, h, n);
  const auto copied = [](cuda::HostBackend& b) {
    double bytes = 0;
    for (const cuda::KernelTime& t : b.times())
      bytes += t.name.rfind("copies", 0) == 0 ? t.work.bytes : 0;
    return bytes;
  };
  std::vector<TetMesh> result;
  std::vector<double> bytes;
  for (const bool stays : {true, false}) {
    TetMesh mesh = lattice_mesh(three_atoms, {0, 0, 0}, h, n);
    cuda::HostBackend backend;
    std::unique_ptr<cuda::Flow<cuda::HostBackend>> flow;
    double surfaces = 0, moves = 0;
    optimize::improve(mesh, &grid, {}, {},
                      [&](optimize::DynamicMesh& m, const Isosurface* surface, const optimize::Pass& pass) {
                        if (!flow || !stays) {
                          flow.reset();
                          const double before = copied(backend);
                          flow = std::make_unique<cuda::Flow<cuda::HostBackend>>(backend, surface, 1);
                          surfaces += copied(backend) - before;
                        }
                        const int64_t moved = flow->run(m, pass, 4);
                        moves += double(moved);
                        return moved;
                      });
    CHECK(moves > 100);
    result.push_back(std::move(mesh));
    bytes.push_back(copied(backend) - surfaces);
  }
  CHECK(result[0].point == result[1].point);
  CHECK(result[0].tet == result[1].tet);
  CHECK(result[0].tri == result[1].tri);
  CHECK(bytes[0] < 0.6 * bytes[1]);
}
