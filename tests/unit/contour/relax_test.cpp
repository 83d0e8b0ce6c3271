// relax_test.cpp — bad elements get better, vertices stay on the surface and on walls.
#include "contour/contour.hpp"
#include "contour/relax.hpp"
#include "geom/tet_measures.hpp"
#include "unit/contour/sample_grid.hpp"
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <map>
#include <set>

using namespace molmesh;
using contour::Options;

namespace {

double least_angle(const contour::Elements& e) {
  double least = 180;
  for (const Tet& t : e.tet) {
    const auto x = [&](size_t i) { return e.position[static_cast<size_t>(t[i])]; };
    const Dihedrals d = dihedrals(x(0), x(1), x(2), x(3));
    least = std::min(least, *std::min_element(d.degree, d.degree + 6));
  }
  return least;
}

/// The cube -1 … 1 as a fan round a vertex at `middle`, each face two triangles; vertices 0..7 are its corners.
contour::Elements fan(Vec3d middle, int32_t label) {
  contour::Elements e;
  for (int c = 0; c < 8; ++c)
    e.position.push_back({c & 1 ? 1. : -1., c & 2 ? 1. : -1., c & 4 ? 1. : -1.});
  e.position.push_back(middle);
  for (int f = 0; f < 6; ++f) {
    const int c[4] = {contour::face_corner_of(f, 0), contour::face_corner_of(f, 1), contour::face_corner_of(f, 2),
                      contour::face_corner_of(f, 3)};
    for (const std::array<int, 3> t : {std::array<int, 3>{c[0], c[1], c[2]}, {c[2], c[3], c[0]}}) {
      e.tet.push_back({t[0], t[2], t[1], 8});
      e.tri.push_back({t[0], t[1], t[2]});
      e.boundary.push_back(label);
    }
  }
  return e;
}

} // namespace

TEST_CASE("a vertex near one side of its star moves to the middle; those on the surface stay") {
  contour::Elements e = fan({0.95, -0.3, 0.2}, surface);
  REQUIRE(least_angle(e) < 3);
  const auto before = e.position;
  CHECK(contour::relax(e, {}, nullptr, 1) > 0);
  CHECK(least_angle(e) > 13);
  CHECK(std::equal(before.begin(), before.begin() + 8, e.position.begin()));
  CHECK(contour::relax(e, {}, nullptr, 1) == 0);
}

TEST_CASE("a vertex on a wall stays in its plane") {
  // Half of the star: the vertex lies on the wall z = -1, near an edge.
  contour::Elements e = fan({0.97, 0.1, -1}, surface);
  LargeArray<Tet> tets;
  for (const Tet& t : e.tet)
    if (six_volume(e.position[static_cast<size_t>(t[0])], e.position[static_cast<size_t>(t[1])],
                   e.position[static_cast<size_t>(t[2])], e.position[8]) > 0)
      tets.push_back(t);
  e.tet = tets;
  for (size_t i = 0; i < e.tri.size(); ++i) {
    const auto on = [&](int32_t v) { return e.position[static_cast<size_t>(v)].z == -1; };
    if (std::all_of(e.tri[i].begin(), e.tri[i].end(), on)) {
      e.tri[i] = {e.tri[i][0], e.tri[i][1], 8};
      e.boundary[i] = box_x0 + 4;
    }
  }
  const double before = least_angle(e);
  REQUIRE(before < 5);
  CHECK(contour::relax(e, {}, nullptr, 1) > 0);
  CHECK(least_angle(e) > before);
  CHECK(e.position[8].z == -1);
  CHECK(e.position[8].x < 0.97);
}

TEST_CASE("a vertex on the surface moves along it") {
  struct Plane final : improve::Target { // z = x
    bool project(Vec3d&, double) const override { return false; }
    bool probe(Vec3d p, double& distance, Vec3d& normal) const override {
      normal = std::sqrt(0.5) * Vec3d{-1, 0, 1};
      distance = dot(p, normal);
      return true;
    }
    double spacing() const override { return 1; }
  } plane;
  contour::Elements e = fan({0.9, -0.3, 0.9}, 0);
  for (size_t i = 0; i < e.boundary.size(); ++i)
    e.boundary[i] = box_x0 + static_cast<int32_t>(i / 2);
  for (const Tri t : {Tri{0, 5, 8}, {5, 7, 8}, {7, 2, 8}, {2, 0, 8}}) {
    e.tri.push_back(t);
    e.boundary.push_back(surface);
  }
  const auto before = e.position;
  REQUIRE(least_angle(e) < 8);
  CHECK(contour::relax(e, {}, &plane, 1) > 0);
  CHECK(least_angle(e) > 13);
  CHECK(std::equal(before.begin(), before.begin() + 8, e.position.begin()));
  CHECK(std::fabs(e.position[8].z - e.position[8].x) * std::sqrt(0.5) < 0.03 + 1e-12);
  contour::Elements stays = fan({0.9, -0.3, 0.9}, 0);
  stays.tri = e.tri;
  stays.boundary = e.boundary;
  CHECK(contour::relax(stays, {}, nullptr, 1) == 0);
}

TEST_CASE("interior and exterior alone are parts of the mesh of both, point for point") {
  const auto two = [](Vec3d x) {
    return std::exp(-0.5 * (norm2(x - Vec3d{1.3, 0.2, 0}) - 4)) +
           std::exp(-0.5 * (norm2(x + Vec3d{1.4, 0, 0.3}) - 5));
  };
  Options options;
  options.box.kind = contour::BoxRequest::tight; // the same box for all three
  const auto elements = [&](const BlockGrid& grid, Options::Meshed meshed, int32_t region) {
    options.meshed = meshed;
    contour::Summary summary;
    const TetMesh mesh = contour::contour(grid, options, summary, [](const std::string&) {});
    std::set<std::array<Vec3d, 4>> found;
    for (size_t t = 0; t < mesh.tet.size(); ++t) {
      if (mesh.region[t] != region)
        continue;
      std::array<Vec3d, 4> x;
      for (size_t i = 0; i < 4; ++i)
        x[i] = mesh.point[static_cast<size_t>(mesh.tet[t][i])];
      std::sort(x.begin(), x.end());
      found.insert(x);
    }
    return found;
  };
  for (const BlockGrid& grid :
       {test::sample_grid({-14, -12, -12}, {29, 25, 25}, 0.5, 2, two), test::creased_grid(6)}) {
    CHECK(elements(grid, Options::interior, molecule) == elements(grid, Options::both, molecule));
    CHECK(elements(grid, Options::exterior, outside) == elements(grid, Options::both, outside));
  }
}
