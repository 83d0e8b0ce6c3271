// kinds_test.cpp — walls are known as planes wherever the mesh lies and whatever digits its coordinates carry.
#include "geom/predicates.hpp"
#include "lattice_mesh.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/validity.hpp"
#include "optimize/acceptance/surface_fit.hpp"
#include "optimize/operations/operations.hpp"
#include "optimize/operations/region.hpp"
#include "optimize/optimize.hpp"
#include "unit/mesh/meshes.hpp"
#include "unit/refusal.hpp"
#include <bit>
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

namespace {

TetMesh ball_in_a_box() {
  return lattice_mesh(
      [](Vec3d p) {
        return std::exp(-0.3 * (norm2(p - Vec3d{2.6, 2.5, 2.4}) - 1.44));
      },
      {0, 0, 0}, 0.5, 10);
}

std::array<int64_t, 5> kinds(const optimize::DynamicMesh& m) {
  std::array<int64_t, 5> count{};
  for (const optimize::Vertex& v : m.vertex)
    ++count[size_t(v.kind)];
  return count;
}

int64_t planes(const optimize::DynamicMesh& m) {
  return std::count_if(m.labels.begin(), m.labels.end(), [](const optimize::Label& l) { return !l.curved(); });
}

} // namespace

TEST_CASE("walls are planes far from the origin, after a turn, and in single precision") {
  const TetMesh mesh = ball_in_a_box();
  const auto expected = kinds(optimize::build(mesh, 180, 1));
  REQUIRE(expected[size_t(optimize::Kind::sliding)] > 100);
  const auto check = [&](const char* what, auto&& move) {
    INFO(what);
    TetMesh moved = mesh;
    for (size_t v = 0; v < moved.point.size(); ++v)
      moved.point[v] = move(moved.point[v], v);
    const optimize::DynamicMesh m = optimize::build(moved, 180, 1);
    CHECK(kinds(m) == expected);
    CHECK(planes(m) == 6);
  };
  const Vec3d far{1e4, -1e4 + 0.3, 1e4 / 3};
  check("translated", [&](Vec3d p, size_t) { return p + far; });
  const double turn = 2 * std::atan(1.), c = std::cos(turn), s = std::sin(turn); // a quarter: c is 6e-17
  const auto turned = [&](Vec3d p) { return Vec3d{c * p.x - s * p.y, s * p.x + c * p.y, p.z}; };
  const Vec3d corner{0.25, 0.25, 0.25}; // of the box
  check("turned about a corner", [&](Vec3d p, size_t) { return turned(p - corner); });
  check("turned, then translated", [&](Vec3d p, size_t) { return turned(p - corner) + far; });
  check("single precision, a digit off here and there", [&](Vec3d p, size_t v) {
    Vec3d q = p + far;
    for (int a = 0; a < 3; ++a) {
      const auto x = static_cast<float>(q[a]);
      q[a] = double(v % 5 == size_t(a) ? std::nextafter(x, 1e9f) : x);
    }
    return q;
  });
}

TEST_CASE("a wall that is bent is no plane, far from the origin either") {
  for (const double far : {0., 1e4}) {
    TetMesh mesh = ball_in_a_box();
    double low = 1e9;
    for (const Vec3d& p : mesh.point)
      low = std::min(low, p.x);
    for (size_t v = 0; v < mesh.point.size(); ++v) {
      Vec3d& p = mesh.point[v];
      if (p.x == low)
        p.x -= v % 2 == 0 ? 1e-6 : 0;
      p += Vec3d{far + 0.1, far, far};
    }
    CHECK(planes(optimize::build(mesh, 180, 1)) == 5);
  }
}

TEST_CASE("points that no element has say nothing of the walls") {
  TetMesh mesh = ball_in_a_box();
  const auto expected = kinds(optimize::build(mesh, 180, 1));
  for (Vec3d& p : mesh.point)
    p = {double(float(p.x)), double(float(p.y)), double(float(p.z))};
  for (const Vec3d& p : {Vec3d{-20, 3, 1}, Vec3d{0x1p33, 0x1p33, -0x1p33}})
    mesh.point.push_back(p);
  const optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  CHECK(planes(m) == 6);
  CHECK(std::count_if(m.labels.begin(), m.labels.end(), [](const optimize::Label& l) { return l.wall; }) == 6);
  for (size_t kind = 1; kind < expected.size(); ++kind) // those of [0] have no label
    CHECK(kinds(m)[kind] == expected[kind]);
}

TEST_CASE("triangles of one label may be turned either way") {
  const Field field = [](Vec3d p) { return std::exp(-0.3 * (norm2(p - Vec3d{2.6, 2.5, 2.4}) - 1.44)); };
  const BlockGrid grid = lattice_grid(field, {0, 0, 0}, 0.5, 10);
  TetMesh mesh = ball_in_a_box();
  const auto expected = kinds(optimize::build(mesh, 50, 1));
  for (size_t t = 0; t < mesh.tri.size(); t += 3)
    std::swap(mesh.tri[t][1], mesh.tri[t][2]);
  CHECK(kinds(optimize::build(mesh, 50, 1)) == expected); // no edge is sharper for it
  CHECK(optimize::improve(mesh, &grid, {}).fidelity.turned == 0);
}

TEST_CASE("without a curved label the size of a mesh does not matter") {
  const auto after = [](double unit) {
    TetMesh mesh = ball_in_a_box();
    mesh.region.assign(mesh.tet.size(), Region::molecule);
    rebuild_triangles(mesh);
    label_walls(mesh);
    for (Vec3d& p : mesh.point)
      p = unit * p;
    const optimize::Result result = optimize::improve(mesh, nullptr, {});
    CHECK(result.after.min >= 25);
    CHECK(result.after.max <= 140);
    return result.counts.total();
  };
  const int64_t operations = after(1);
  CHECK(operations > 0);
  CHECK(after(0x1p-10) == operations);
  CHECK(after(0x1p+10) == operations);
}

TEST_CASE("a mesh far from the origin is improved as one at the origin is") {
  optimize::Options how;
  TetMesh here = ball_in_a_box(), there = here;
  for (Vec3d& p : there.point)
    p += Vec3d{1e4, -1e4, 1e4};
  const optimize::Result a = optimize::improve(here, nullptr, how), b = optimize::improve(there, nullptr, how);
  CHECK(a.before.min == Approx(b.before.min).epsilon(1e-6));
  CHECK(b.after.min > 0.95 * a.after.min);
  CHECK(b.after.below_25 <= a.after.below_25 + 1);
}

TEST_CASE("without a density a plate thinner than its triangles stays where it is", "[slow]") {
  TetMesh mesh; // cubes of six tetrahedra, pressed flat
  const int n = 6;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k)
        mesh.point.push_back({double(i), double(j), 0.1 * k});
  const auto at = [&](Vec3i p) { return ((p.x * (n + 1)) + p.y) * (n + 1) + p.z; };
  for (int c = 0; c < n * n * n; ++c) {
    std::array<int, 3> axis{0, 1, 2};
    do {
      Vec3i p{c / (n * n), c / n % n, c % n};
      Tet t{at(p)};
      for (size_t step = 0; step < 3; ++step) {
        ++p[axis[step]];
        t[step + 1] = at(p);
      }
      if (volume6(mesh.point[t[0]], mesh.point[t[1]], mesh.point[t[2]], mesh.point[t[3]]) < 0)
        std::swap(t[2], t[3]);
      mesh.tet.push_back(t);
    } while (std::next_permutation(axis.begin(), axis.end()));
  }
  mesh.region.assign(mesh.tet.size(), Region::molecule);
  rebuild_triangles(mesh);
  const Validity before = check_validity(mesh, 1);
  REQUIRE(before.valid());
  CHECK(optimize::improve(mesh, nullptr, {}).after.min > 20);
  const Validity after = check_validity(mesh, 1);
  CHECK(after.valid());
  CHECK(after.volume == Approx(before.volume).epsilon(0.01));
  const double edge = (2 + std::sqrt(2.)) / 3; // of its large sides; no longer than the surface's mean
  for (const Vec3d& p : mesh.point)
    for (int a = 0; a < 3; ++a) {
      const double end = a < 2 ? n : 0.1 * n;
      REQUIRE((p[a] >= -0.02 * edge && p[a] <= end + 0.02 * edge));
    }
}

TEST_CASE("where a surface touches itself at a point, the point is fixed") {
  TetMesh mesh; // two elements with one point in common
  mesh.point = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  mesh.tet = {{0, 1, 2, 3}, {0, 4, 6, 5}};
  mesh.region = {1, 1};
  for (const Tet& t : mesh.tet)
    for (size_t f = 0; f < 4; ++f)
      mesh.tri.push_back(optimize::outward_triangle(t, f));
  mesh.boundary.assign(8, 1);
  if (orient3d(mesh.point[0], mesh.point[4], mesh.point[6], mesh.point[5]) <= 0)
    FAIL("the second element is turned inside out");
  const optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  CHECK(m.vertex[0].kind == optimize::Kind::fixed);
  for (size_t v = 1; v < 7; ++v)
    CHECK(m.vertex[v].kind == optimize::Kind::surface);
}

TEST_CASE("a mesh without labels of its own stays valid: every triangle keeps its rule's direction") {
  TetMesh mesh = ball_in_a_box();
  const bool walls = GENERATE(false, true);
  const auto number = GENERATE(std::pair{1, 2}, std::pair{5, 7}, std::pair{7, 5}, std::pair{2, 3});
  for (int32_t& r : mesh.region)
    r = r == Region::molecule ? number.first : number.second;
  rebuild_triangles(mesh);
  if (walls)
    label_walls(mesh);
  CHECK(std::count(mesh.boundary.begin(), mesh.boundary.end(), Boundary::box_z1) == (walls ? 2 * 9 * 9 : 0));
  REQUIRE(check_validity(mesh, 1).valid());
  optimize::Options options;
  options.iterations = 2;
  REQUIRE(optimize::improve(mesh, nullptr, options).counts.total() > 0);
  CHECK(check_validity(mesh, 1).valid());
}

TEST_CASE("a surface that runs against the isosurface is refused") {
  const Field field = [](Vec3d p) { return std::exp(-0.3 * (norm2(p - Vec3d{2.6, 2.5, 2.4}) - 1.44)); };
  const BlockGrid grid = lattice_grid(field, {0, 0, 0}, 0.5, 10);
  TetMesh mesh = ball_in_a_box(), turned = mesh;
  for (int32_t& r : turned.region)
    r = 3 - r;
  rebuild_triangles(turned);
  label_walls(turned);
  CHECK(optimize::improve(mesh, &grid, {}).fidelity.turned == 0);
  CHECK(refusal(Status::bad_input, [&] { optimize::improve(turned, &grid, {}); }).find("isosurface") !=
        std::string::npos);
}

TEST_CASE("labels stay in their planes where edges of a box within the mesh contract") {
  constexpr int from = 2, to = 6;
  TetMesh mesh = molmesh::testing::cubes(8, [](Vec3i c) -> int32_t {
    return std::min({c.x, c.y, c.z}) >= from && std::max({c.x, c.y, c.z}) < to ? 2 : 1;
  });
  constexpr int32_t inner = 20; // and up: its sides, in the order of the box's
  for (size_t t = 0; t < mesh.tri.size(); ++t)
    for (int axis = 0; axis < 3 && mesh.boundary[t] == surface; ++axis)
      for (const int at : {from, to})
        if (std::all_of(mesh.tri[t].begin(), mesh.tri[t].end(),
                        [&](int32_t v) { return mesh.point[v][axis] == at; }))
          mesh.boundary[t] = inner + 2 * axis + (at == to);
  for (Vec3d& p : mesh.point) // every other point of an edge goes close to the next
    for (int axis = 0; axis < 3; ++axis) {
      const auto on_side = [&](int a) { return p[(axis + a) % 3] == from || p[(axis + a) % 3] == to; };
      if (on_side(1) && on_side(2) && p[axis] == from + 1)
        p[axis] += 0.9;
    }
  optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  optimize::PartRoom room{0, {}, {}};
  optimize::Parts parts;
  parts.owner.resize(m.point.size());
  std::vector<uint32_t> stamp(m.element.size());
  optimize::Region region(m, nullptr, nullptr, parts, stamp, room);
  const auto on_edge = [&](int32_t v) { return std::popcount(m.vertex[v].frozen) == 2; };
  for (size_t e = 0; e < m.element.size(); ++e)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        if (const optimize::Element& t = m.element[e]; i != j && t.alive() && on_edge(t.v[i]) && on_edge(t.v[j]))
          optimize::contract_edge(region, {}, static_cast<int32_t>(e), i, j);
  CHECK(region.counts.contractions >= 12);
  mesh = optimize::extract(m);
  CHECK(check_validity(mesh, 1).faults.empty());
  double area[6] = {};
  for (size_t t = 0; t < mesh.tri.size(); ++t) {
    const int32_t side = mesh.boundary[t] - inner;
    if (side < 0)
      continue;
    std::array<Vec3d, 3> p;
    for (size_t i = 0; i < 3; ++i) {
      p[i] = mesh.point[mesh.tri[t][i]];
      CHECK(p[i][side / 2] == (side % 2 ? to : from));
    }
    area[side] += norm(tri_normal(p[0], p[1], p[2])) / 2;
  }
  for (const double a : area)
    CHECK(std::abs(a - 16) < 1e-9);
}

TEST_CASE("a surface that meets a plane within the mesh, or comes in alone, has no trace that moves") {
  TetMesh mesh = molmesh::testing::cubes(8, [](Vec3i c) -> int32_t {
    return norm2(to_double(c) - Vec3d{3.5, 3.5, 3.5}) < 9 && c.z >= 4 ? 2 : 1;
  });
  for (size_t t = 0; t < mesh.tri.size(); ++t)
    if (mesh.boundary[t] == surface &&
        std::all_of(mesh.tri[t].begin(), mesh.tri[t].end(), [&](int32_t v) { return mesh.point[v].z == 4; }))
      mesh.boundary[t] = 20;
  CHECK(kinds(optimize::build(mesh, 180, 1))[size_t(optimize::Kind::trace)] == 0);
  TetMesh half = molmesh::testing::cubes(8, [](Vec3i c) -> int32_t {
    return norm2(to_double(c) - Vec3d{3.5, 3.5, 0}) < 9 ? 2 : 1;
  });
  CHECK(kinds(optimize::build(half, 180, 1))[size_t(optimize::Kind::trace)] > 8);
  CHECK(kinds(optimize::build(half, 50, 1))[size_t(optimize::Kind::trace)] == 0);
}
