// relax_test.cpp — bad elements get better, vertices stay on the surface and on walls.
#include "contour/relaxation/relax.hpp"
#include "contour/stages.hpp"
#include "geom/predicates.hpp"
#include "geom/tet_measures.hpp"
#include "unit/contour/sample_grid.hpp"
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <set>

using namespace molmesh;
using contour::Side;

namespace {

double least_angle(const contour::Elements& e) {
  double least = 180;
  for (const Tet& t : e.tet) {
    const auto x = [&](size_t i) { return e.position[t[i]]; };
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

TEST_CASE("a vertex near one side of its star moves to the middle, and those on the surface stay") {
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
    if (six_volume(e.position[t[0]], e.position[t[1]], e.position[t[2]], e.position[8]) > 0)
      tets.push_back(t);
  e.tet = tets;
  for (size_t i = 0; i < e.tri.size(); ++i) {
    const auto on = [&](int32_t v) { return e.position[v].z == -1; };
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
  struct Plane final : Target { // z = x
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

TEST_CASE("of a side that nobody asks for there is what the surface moves in, not quite flat") {
  const auto two = [](Vec3d x) {
    return std::exp(-0.5 * (norm2(x - Vec3d{1.3, 0.2, 0}) - 4)) +
           std::exp(-0.5 * (norm2(x + Vec3d{1.4, 0, 0.3}) - 5));
  };
  for (const BlockGrid& grid :
       {test::sample_grid({-14, -12, -12}, {29, 25, 25}, 0.5, 2, two), test::creased_grid(6)}) {
    std::array<size_t, 2> of_both{}; // elements on each Side
    for (const Side unmeshed : {Side::crossed, Side::outside, Side::inside}) {
      contour::BoxRequest box;
      box.kind = contour::BoxRequest::tight;
      const contour::Lattice lattice(grid, box, true, 1);
      contour::HostStages stages(1);
      stages.find_surface(lattice);
      stages.select_leaves({contour::default_adapt(grid.frame.spacing), true, true});
      stages.make_dual(unmeshed, [](const std::string&) {});
      stages.relax();
      const contour::Elements& e = stages.dual().elements;
      const contour::ComplexView& c = stages.dual().complex.view;
      std::set<int32_t> near; // on the surface or a wall
      for (const Tri& t : e.tri)
        near.insert(t.begin(), t.end());
      const auto is_near = [&](int32_t v) { // or a surface cell's, or a face's point
        const int32_t leaf = v < c.vertices() ? c.leaf_of(v) : -1;
        return v >= c.vertices() || near.count(v) > 0 || (leaf >= 0 && c.side[leaf] == Side::crossed);
      };
      std::array<size_t, 2> elements{};
      size_t turned = 0, far = 0;
      double least = 180, greatest = 0, least_unasked = 180;
      for (const Tet& t : e.tet) {
        const auto x = [&](size_t i) { return e.position[t[i]]; };
        turned += orient3d(x(0), x(1), x(2), x(3)) <= 0;
        const Side side = c.inside(t[0]) ? Side::inside : Side::outside;
        ++elements[size_t(side)];
        const Dihedrals d = dihedrals(x(0), x(1), x(2), x(3));
        const double angle = *std::min_element(d.degree, d.degree + 6);
        if (side == unmeshed) {
          far += std::none_of(t.begin(), t.end(), is_near);
          least_unasked = std::min(least_unasked, angle);
          continue;
        }
        least = std::min(least, angle);
        greatest = std::max(greatest, *std::max_element(d.degree, d.degree + 6));
      }
      CHECK(turned == 0);
      CHECK(far == 0);
      CHECK(least > 13);
      CHECK(least_unasked > 3);
      CHECK(greatest < 160);
      if (unmeshed == Side::crossed)
        of_both = elements;
      for (const Side side : {Side::outside, Side::inside}) {
        const auto s = static_cast<size_t>(side);
        CHECK((side == unmeshed ? elements[s] < of_both[s] : elements[s] == of_both[s]));
      }
    }
  }
}
