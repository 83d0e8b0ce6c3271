// parts_test.cpp — quality, star_quality, targets and single operations against slow and plain answers.
#include "geom/star_quality.hpp"
#include "geom/tet_measures.hpp"
#include "geom/tet_quality_simd.hpp"
#include "isosurface/isosurface.hpp"
#include "isosurface/near_isosurface.hpp"
#include "isosurface/reference_surface.hpp"
#include "lattice_mesh.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include "optimize/operations/region.hpp"
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <random>

using namespace molmesh;
using namespace molmesh::test;

namespace {

std::mt19937 generator(7);
Vec3d random_point(double size = 1) {
  std::uniform_real_distribution<double> u(-size, size);
  return {u(generator), u(generator), u(generator)};
}

// Smallest sine of the dihedral angles by acos, obtuse ones weighted, or Joe and Liu's Q weighted; squared.
double slow_quality(const std::array<Vec3d, 4>& p) {
  const double q = joe_liu_q(six_volume(p[0], p[1], p[2], p[3]), edge_sum2(p[0], p[1], p[2], p[3]));
  double worst = q / 0.30 * std::sin(25 * 3.14159265358979323846 / 180);
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = i + 1; j < 4; ++j) {
      const size_t k = i != 0 ? 0 : j != 1 ? 1 : 2, l = 6 - i - j - k;
      const Vec3d e = (p[j] - p[i]) / norm(p[j] - p[i]), a = p[k] - p[i], b = p[l] - p[i];
      const Vec3d x = a - dot(a, e) * e, y = b - dot(b, e) * e;
      const double angle = std::acos(dot(x, y) / (norm(x) * norm(y)));
      worst = std::min(worst, std::sin(angle) * (angle > 1.5707963267948966 ? obtuse_weight : 1));
    }
  return worst * worst;
}

} // namespace

TEST_CASE("quality is the smallest weighted sine of the dihedral angles, or Joe and Liu's Q") {
  for (int n = 0; n < 1000; ++n) {
    std::array<Vec3d, 4> p{random_point(), random_point(), random_point(), random_point()};
    if (volume6(p[0], p[1], p[2], p[3]) < 0) {
      CHECK(tet_quality(p[0], p[1], p[2], p[3]) == -1);
      std::swap(p[2], p[3]);
    }
    CHECK(tet_quality(p[0], p[1], p[2], p[3]) == Approx(slow_quality(p)).epsilon(1e-4));
  }
  CHECK(angle_quality(25) == Approx(angle_quality(140)).epsilon(0.01));
}

TEST_CASE("star_quality find the worst element wherever their vertex is") {
  for (int n = 0; n < 100; ++n) {
    StarQuality star_quality;
    std::vector<std::array<Vec3d, 4>> tets;
    std::vector<size_t> moving;
    const Vec3d origin{50, -30, 20};
    star_quality.clear(origin);
    const int count = 1 + n % 30;
    for (int t = 0; t < count; ++t) {
      std::array<Vec3d, 4> p{origin, origin + random_point(), origin + random_point(), origin + random_point()};
      if (volume6(p[0], p[1], p[2], p[3]) < 0)
        std::swap(p[2], p[3]);
      const size_t at = size_t(t) % 4; // an even permutation that puts the vertex there
      static constexpr size_t order[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
      tets.push_back({p[order[at][0]], p[order[at][1]], p[order[at][2]], p[order[at][3]]});
      moving.push_back(at);
      star_quality.add(tets.back(), static_cast<int>(at));
    }
    CHECK(star_quality.size() == size_t(count));
    for (int k = 0; k < 10; ++k) {
      const Vec3d x = origin + random_point(0.02);
      float worst = 2;
      for (size_t t = 0; t < tets.size(); ++t) {
        auto p = tets[t];
        p[moving[t]] = x;
        worst = std::min(worst, tet_quality(p[0], p[1], p[2], p[3]));
      }
      CHECK(star_quality.worst(x, -1.f) == Approx(worst).epsilon(2e-3).margin(1e-6));
    }
    // Many places at once: the answer of one by one, to the last bit.
    std::array<Vec3d, StarQuality::most_places> place;
    std::array<float, StarQuality::most_places> worst;
    for (size_t k = 0; k < place.size(); ++k) {
      place[k] = origin + random_point(0.05);
      worst[k] = star_quality.worst(place[k], -2.f);
    }
    const int places = 1 + n % StarQuality::most_places, from = n / 16 % places;
    for (const float above : {-2.f, *std::max_element(worst.begin(), worst.end()), worst[0], worst[7]}) {
      star_quality.ascent(place[0], 1e-3);
      int first = from;
      while (first < places && !(worst[first] > above))
        ++first;
      float q = -3;
      REQUIRE(star_quality.first_above(place.data(), from, places, above, q) == first);
      if (first < places)
        CHECK(q == worst[first]);
    }
  }
}

TEST_CASE("eight elements are judged as one is, to the last bit") {
  for (int n = 0; n < 1000; ++n) {
    EightElements eight;
    std::array<std::array<Vec3d, 4>, 8> p;
    for (size_t l = 0; l < 8; ++l)
      for (size_t i = 0; i < 4; ++i) {
        p[l][i] = n % 10 == 0 && i == 3 ? 0.5 * (p[l][0] + p[l][1]) : random_point(); // some are flat
        eight.set(l, i, p[l][i]);
      }
    float q[8];
    qualities(eight, q);
    for (size_t l = 0; l < 8; ++l)
      CHECK(q[l] == tet_quality(p[l][0], p[l][1], p[l][2], p[l][3]));
  }
}

TEST_CASE("points are projected onto the isosurface of a sphere") {
  // log G is quadratic: its trilinear interpolant is off by at most h²/8 times the second derivatives, 3 · 0.6
  // h²/8.
  const Vec3d centre{4.03, 4.11, 3.97};
  const double radius = 1.7, h = 0.25;
  const BlockGrid grid = lattice_grid(
      [&](Vec3d p) { return std::exp(-0.3 * (norm2(p - centre) - radius * radius)); }, {0, 0, 0}, h, 32);
  const Isosurface surface(grid, 2);
  const double bound = 3 * 0.6 * h * h / 8 / (2 * 0.3 * radius) * 1.2;
  for (int n = 0; n < 200; ++n) {
    const Vec3d direction = random_point(), unit = direction / norm(direction);
    Vec3d p = centre + (radius + 0.05) * unit;
    REQUIRE(surface.project(p, 0.5));
    CHECK(std::abs(norm(p - centre) - radius) < bound);
    double distance = 1;
    Vec3d normal;
    REQUIRE(surface.probe(p, distance, normal));
    const IsosurfaceView view = surface.view();
    const NearIsosurface near(view);
    for (int k = 0; k < 20; ++k) { // the same, to the last bit, and where nothing is known
      const Vec3d y = p + random_point(k < 18 ? 0.3 : 9);
      double d[2] = {1, 1};
      Vec3d m[2];
      REQUIRE(near.probe(y, d[0], m[0]) == surface.probe(y, d[1], m[1]));
      CHECK(d[0] == d[1]);
      CHECK(m[0] == m[1]);
    }
    CHECK(std::abs(distance) <= 1e-3 * h);
    CHECK(dot(normal, unit) > 0.95);
  }
  Vec3d away = centre;
  CHECK_FALSE(surface.project(away, 0.5)); // not in the band
}

TEST_CASE("log G reaches a quarter of a cell beyond the known ones") {
  const double h = 0.25, radius = 1.75;
  const auto log_g = [&](Vec3d p) { return -0.3 * (norm2(p - Vec3d{4, 4, 4}) - radius * radius); };
  BlockGrid grid = lattice_grid([&](Vec3d p) { return std::exp(log_g(p)); }, {0, 0, 0}, h, 32);
  const Vec3i pole{9, 16, 16}, gone{8, 16, 16}; // on the isosurface, and outside
  const int64_t b = BlockIndex(grid).find(gone);
  REQUIRE(b >= 0);
  grid.active[8 * b + (slot(gone) >> 6)] &= ~(uint64_t{1} << (slot(gone) & 63));
  const Isosurface surface(grid, 1);
  const auto at = [&](double cells) { return h * (to_double(pole) + Vec3d{-cells, 0.1, 0.1}); };
  double f = 0;
  Vec3d gradient;
  REQUIRE(surface.evaluate(at(-0.1), f, gradient)); // known
  REQUIRE(surface.evaluate(at(0.2), f, gradient));
  CHECK(std::abs(f - log_g(at(0.2))) < 0.02);
  CHECK(gradient.x == Approx(0.6 * radius).epsilon(0.1));
  CHECK_FALSE(surface.evaluate(at(0.5), f, gradient));
}

TEST_CASE("the reference surface gives the closest point of all its triangles") {
  const Field ball = [](Vec3d p) { return std::exp(-0.3 * (norm2(p - Vec3d{2.6, 2.5, 2.4}) - 1.44)); };
  const TetMesh mesh = lattice_mesh(ball, {0, 0, 0}, 0.5, 10, 1);
  const ReferenceSurface surface(mesh, std::vector<uint8_t>(mesh.tri.size(), 1));
  for (int n = 0; n < 100; ++n) {
    const Vec3d direction = random_point();
    const Vec3d from = Vec3d{2.6, 2.5, 2.4} + 1.25 / norm(direction) * direction;
    double best = 1e300;
    for (const Tri& t : mesh.tri) // barycentric samples of every triangle
      for (int i = 0; i <= 40; ++i)
        for (int j = 0; i + j <= 40; ++j) {
          const Vec3d q = (double(i) * mesh.point[t[0]] + double(j) * mesh.point[t[1]] +
                           double(40 - i - j) * mesh.point[t[2]]) /
                          40.;
          best = std::min(best, norm(q - from));
        }
    Vec3d p = from;
    REQUIRE(surface.project(p, 0.5));
    CHECK(norm(p - from) <= best + 1e-12);
    CHECK(norm(p - from) >= best - 0.02);
  }
}

TEST_CASE("far larger triangles around a fine surface are found, and leave its spacing as it is") {
  const Field ball = [](Vec3d p) { return std::exp(-0.3 * (norm2(p - Vec3d{2.6, 2.5, 2.4}) - 1.44)); };
  TetMesh mesh = lattice_mesh(ball, {0, 0, 0}, 0.5, 10, 1);
  const size_t fine = mesh.tri.size();
  const double far = 400; // an octahedron
  const auto first = static_cast<int32_t>(mesh.point.size());
  for (int a = 0; a < 3; ++a)
    for (const double side : {-far, far}) {
      Vec3d p{};
      p[a] = side;
      mesh.point.push_back(p);
    }
  for (int octant = 0; octant < 8; ++octant)
    mesh.tri.push_back({first + (octant & 1), first + 2 + (octant >> 1 & 1), first + 4 + (octant >> 2)});
  mesh.boundary.resize(mesh.tri.size(), surface);
  const ReferenceSurface surface(mesh, std::vector<uint8_t>(mesh.tri.size(), 1));
  CHECK(surface.spacing() < 0.6); // the ball's
  // The octahedron is |x| + |y| + |z| = far.
  for (int n = 0; n < 50; ++n) {
    const Vec3d direction = random_point(),
                on = far / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z)) * direction;
    const Vec3d out =
        Vec3d{direction.x < 0 ? -1. : 1., direction.y < 0 ? -1. : 1., direction.z < 0 ? -1. : 1.} / std::sqrt(3.);
    Vec3d p = on + 0.1 * out;
    REQUIRE(surface.project(p, 0.5));
    CHECK(std::abs(dot(p - on, out)) < 1e-9);
    const Tri& t = mesh.tri[size_t(n) * fine / 50];
    Vec3d q = mesh.point[t[0]];
    REQUIRE(surface.project(q, 0.5));
    CHECK(norm(q - mesh.point[t[0]]) < 1e-9);
  }
}

TEST_CASE("a mesh that is built and extracted is the same mesh") {
  const Field ball = [](Vec3d p) { return std::exp(-0.3 * (norm2(p - Vec3d{2.6, 2.5, 2.4}) - 1.44)); };
  const int keep = GENERATE(0, 1, 2);
  const TetMesh mesh = lattice_mesh(ball, {0, 0, 0}, 0.5, 10, keep);
  const optimize::DynamicMesh m = optimize::build(mesh, 180, 2);
  const TetMesh back = optimize::extract(m);
  CHECK(back.point == mesh.point);
  CHECK(back.tet == mesh.tet);
  CHECK(back.region == mesh.region);
  const auto sorted = [](const TetMesh& x) { // triangles with their labels, each from its lowest point on
    std::set<std::pair<Tri, int32_t>> all;
    for (size_t t = 0; t < x.tri.size(); ++t) {
      Tri f = x.tri[t];
      std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
      all.insert({f, x.boundary[t]});
    }
    return all;
  };
  CHECK(sorted(back) == sorted(mesh)); // orientation included
  const auto count = [&](optimize::Kind kind) {
    return std::count_if(m.vertex.begin(), m.vertex.end(),
                         [&](const optimize::Vertex& v) { return v.kind == kind; });
  };
  CHECK(count(optimize::Kind::surface) > 0);
  CHECK(count(optimize::Kind::fixed) == (keep == 1 ? 0 : 8)); // the corners of the box
}
