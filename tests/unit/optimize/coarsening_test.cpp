// coarsening_test.cpp — coarsening makes smaller meshes, and keeps what a mesh is.
#include "isosurface/isosurface.hpp"
#include "lattice_mesh.hpp"
#include "mesh/validity.hpp"
#include "optimize/mesh/target_size.hpp"
#include "optimize/operations/check.hpp"
#include "optimize/operations/vertex_removal.hpp"
#include "optimize/optimize.hpp"
#include "surface_shape.hpp"
#include <catch2/catch.hpp>
#include <map>
#include <queue>
#include <tuple>

using namespace molmesh;
using namespace molmesh::test;

namespace {

constexpr double h = 0.5;
constexpr int n = 20;

std::map<int32_t, double> volumes(const TetMesh& mesh) {
  std::map<int32_t, double> volume;
  for (size_t t = 0; t < mesh.tet.size(); ++t) {
    const Tet& v = mesh.tet[t];
    const double six = volume6(mesh.point[v[0]], mesh.point[v[1]], mesh.point[v[2]], mesh.point[v[3]]);
    REQUIRE(six > 0);
    volume[mesh.region[t]] += six / 6;
  }
  return volume;
}

std::map<int32_t, double> areas(const TetMesh& mesh) {
  std::map<int32_t, double> area;
  for (size_t t = 0; t < mesh.tri.size(); ++t) {
    const Vec3d a = mesh.point[mesh.tri[t][0]];
    area[mesh.boundary[t]] += norm(cross(mesh.point[mesh.tri[t][1]] - a, mesh.point[mesh.tri[t][2]] - a)) / 2;
  }
  return area;
}

bool same(const TetMesh& a, const TetMesh& b) {
  return a.point == b.point && a.tet == b.tet && a.region == b.region && a.tri == b.tri && a.boundary == b.boundary;
}

// Dijkstra's over the edges of the elements, from sizes on curved labels.
std::vector<double> slow_sizes(const optimize::DynamicMesh& m) {
  std::vector<std::map<int32_t, double>> near(m.point.size());
  std::vector<std::pair<double, int>> mean(m.point.size());
  for (const optimize::Element& e : m.element)
    for (size_t i = 0; i < 4; ++i)
      for (size_t j = 0; j < 4; ++j)
        if (i != j)
          near[e.v[i]][e.v[j]] = norm(m.point[e.v[i]] - m.point[e.v[j]]);
  for (const optimize::Element& e : m.element)
    for (size_t f = 0; f < 4; ++f)
      if (m.counts_here(e, f) && m.labels[e.label[f]].curved())
        for (const int32_t a : optimize::outward_triangle(e.v, f))
          for (const int32_t b : optimize::outward_triangle(e.v, f))
            if (a != b)
              mean[a].first += near[a][b], ++mean[a].second;
  std::vector<double> size(m.point.size(), 1e30);
  std::priority_queue<std::pair<double, int32_t>> next;
  for (size_t v = 0; v < size.size(); ++v)
    if (mean[v].second > 0)
      next.emplace(-(size[v] = mean[v].first / mean[v].second), int32_t(v));
  while (!next.empty()) {
    const auto [s, v] = next.top();
    next.pop();
    for (const auto& [w, length] : near[v])
      if (-s <= size[v] && size[v] + optimize::size_growth * length < size[w])
        next.emplace(-(size[w] = size[v] + optimize::size_growth * length), w);
  }
  return size;
}

} // namespace

TEST_CASE("coarsening halves a mesh and keeps regions, walls, surface, topology and angles", "[slow]") {
  const BlockGrid grid = lattice_grid(three_atoms, {0, 0, 0}, h, n);
  const int keep = GENERATE(0, 1, 2);
  const bool with_density = GENERATE(true, false);
  CAPTURE(keep, with_density);
  const TetMesh input = lattice_mesh(three_atoms, {0, 0, 0}, h, n, keep);
  optimize::Options options;
  TetMesh fine = input, mesh = input;
  optimize::improve(fine, with_density ? &grid : nullptr, options);
  options.coarsen = true;
  const optimize::Result r = optimize::improve(mesh, with_density ? &grid : nullptr, options);
  CHECK_NOTHROW(optimize::build(mesh, 180, 1)); // still a valid mesh
  CHECK(2 * mesh.tet.size() < fine.tet.size());
  CHECK(r.removed > 0);
  CHECK(r.after.min >= 25);
  CHECK(r.after.max <= 140);
  CHECK(surface_shape(mesh).euler() == 2);
  const auto before = areas(fine), after = areas(mesh);
  REQUIRE(before.size() == after.size());
  for (const auto& [label, area] : before)
    CHECK(after.at(label) == Approx(area).epsilon(label == surface ? 0.02 : 1e-12));
  const auto volume = volumes(fine), now = volumes(mesh);
  REQUIRE(volume.size() == now.size());
  for (const auto& [region, v] : volume)
    CHECK(now.at(region) == Approx(v).epsilon(0.015));
  if (with_density) {
    CHECK(r.fidelity.points_off == 0);
    CHECK(std::abs(r.fidelity.missing) < 0.005 * r.fidelity.volume);
    CHECK(r.fidelity.turned == 0);
    CHECK(r.fidelity.centroids_off == 0);
  } else {
    CHECK(surface_shape(mesh).points.size() >= 0.9 * double(surface_shape(fine).points.size()));
  }
  if (keep == 0) {
    TetMesh threaded = input;
    options.threads = 3;
    optimize::improve(threaded, with_density ? &grid : nullptr, options);
    CHECK(same(mesh, threaded));
  }
}

TEST_CASE("coarsening keeps a named boundary and the points of its border") {
  const BlockGrid grid = lattice_grid(three_atoms, {0, 0, 0}, h, n);
  TetMesh mesh = lattice_mesh(three_atoms, {0, 0, 0}, h, n);
  constexpr int32_t site = 8;
  for (size_t t = 0; t < mesh.tri.size(); ++t)
    if (mesh.boundary[t] == surface && mesh.point[mesh.tri[t][0]].x > 5)
      mesh.boundary[t] = site;
  const auto border = [](const TetMesh& m) {
    std::map<int32_t, int> labels;
    for (size_t t = 0; t < m.tri.size(); ++t)
      for (const int32_t v : m.tri[t])
        labels[v] |= m.boundary[t] == surface ? 1 : m.boundary[t] == site ? 2 : 0;
    std::set<std::tuple<double, double, double>> points;
    for (const auto& [v, met] : labels)
      if (met == 3)
        points.emplace(m.point[v].x, m.point[v].y, m.point[v].z);
    return points;
  };
  const auto points = border(mesh);
  const auto before = areas(mesh);
  const size_t elements = mesh.tet.size();
  REQUIRE(points.size() > 10);
  optimize::Options options;
  options.coarsen = true;
  optimize::improve(mesh, &grid, options);
  CHECK(2 * mesh.tet.size() < elements);
  CHECK(border(mesh) == points);
  const auto after = areas(mesh);
  REQUIRE(after.size() == before.size());
  for (const auto& [label, area] : before)
    CHECK(after.at(label) == Approx(area).epsilon(label == surface || label == site ? 0.03 : 1e-12));
}

TEST_CASE("sizes grow by shortest paths from the surface, and are at most 1.5 apart along edges that they allow") {
  const optimize::DynamicMesh m = optimize::build(lattice_mesh(three_atoms, {0, 0, 0}, h, n), 180, 1);
  const std::vector<float> size = optimize::target_sizes(m, nullptr, 0, 1);
  const std::vector<double> slow = slow_sizes(m);
  CHECK(size == optimize::target_sizes(m, nullptr, 0, 3));
  for (size_t v = 0; v < size.size(); ++v)
    REQUIRE(size[v] == Approx(slow[v]).epsilon(1e-5));
  for (const optimize::Element& e : m.element)
    for (const auto& [i, j] : optimize::edges)
      if (norm(m.point[e.v[i]] - m.point[e.v[j]]) <= std::min(size[e.v[i]], size[e.v[j]]))
        REQUIRE(std::max(size[e.v[i]], size[e.v[j]]) <= 1.5001 * std::min(size[e.v[i]], size[e.v[j]]));
}

TEST_CASE("sizes on a sphere are those of triangles that are off it by the tolerance") {
  const double radius = 3;
  const Field ball = [&](Vec3d p) { return std::exp(-0.3 * (norm2(p - Vec3d{5.1, 5.2, 5.3}) - radius * radius)); };
  const Isosurface surface(lattice_grid(ball, {0, 0, 0}, h, n), 1);
  const optimize::DynamicMesh m = optimize::build(lattice_mesh(ball, {0, 0, 0}, h, n), 180, 1);
  const double tolerance = 0.2 * h, expected = std::sqrt(6 * tolerance * radius);
  const std::vector<float> size = optimize::target_sizes(m, &surface, tolerance, 1);
  double sum = 0;
  int points = 0;
  for (size_t v = 0; v < size.size(); ++v)
    if (m.vertex[v].kind == optimize::Kind::surface)
      sum += size[v], ++points;
  REQUIRE(points > 100);
  // The largest curvature of a point's edges is meant, and points of this mesh are off the sphere: sizes are
  // smaller.
  CHECK(sum / points < 1.02 * expected);
  CHECK(sum / points > 0.8 * expected);
}

TEST_CASE(
    "a removed vertex leaves a region without a fault, no element under the goal and no edge beyond the sizes") {
  const BlockGrid grid = lattice_grid(three_atoms, {0, 0, 0}, h, n);
  const Isosurface surface(grid, 1);
  TetMesh mesh = lattice_mesh(three_atoms, {0, 0, 0}, h, n);
  optimize::improve(mesh, &grid, {});
  optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  const std::vector<float> size = optimize::target_sizes(m, &surface, 0.1 * h, 1);
  optimize::Parts parts;
  parts.owner.assign(m.point.size(), 0);
  optimize::PartRoom room;
  std::vector<uint32_t> stamp(m.element.size());
  optimize::Region region(m, &surface, nullptr, parts, stamp, room);
  optimize::Acceptance accept(Guard{32, 0.1, 0.5, 0});
  accept.aim = optimize::Aim::size;
  accept.goal = static_cast<float>(angle_quality(15));
  optimize::VertexRemoval remove(region, accept, size);
  int removed = 0;
  for (int32_t v = 0; v < static_cast<int32_t>(m.point.size()) && removed < 40; v += 7) {
    const optimize::Vertex vertex = m.vertex[v];
    if (m.incident[v] < 0 || !remove(v))
      continue;
    ++removed;
    REQUIRE(vertex.kind != optimize::Kind::fixed);
    REQUIRE(m.incident[v] < 0);
    REQUIRE(optimize::find_fault(region).empty());
  }
  CHECK(removed == 40);
  for (const optimize::Element& e : m.element)
    if (e.alive())
      CHECK(e.q >= 0.999f * accept.goal);
}
