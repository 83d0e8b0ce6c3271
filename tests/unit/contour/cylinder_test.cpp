// cylinder_test.cpp — a body without atoms has the surface that its numbers say: volume and area of a rounded
// cylinder.
#include "contour/contour.hpp"
#include "density/density.hpp"
#include "geom/tet_measures.hpp"
#include "optimize/optimize.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;

TEST_CASE("a cylinder's volume and area converge to the analytic ones", "[slow]") {
  constexpr double pi = 3.14159265358979323846, radius = 7, half = 9, skin = 1.7;
  Hierarchy rod;
  rod.atom = {{{0.3, -0.2, 0.1}, skin}};
  rod.body = {
      {Body::Shape::cylinder, {0.3, -0.2, 0.1}, {half / 3, 2 * half / 3, 2 * half / 3}, {}, radius, skin, 0}};
  // Steiner's formulas: all places within `skin` of the core, a cylinder of radius r and height h.
  const double r = radius - skin, h = 2 * (half - skin);
  const double core_area = 2 * pi * r * (r + h), curvature = pi * h + pi * pi * r;
  const double volume =
      pi * r * r * h + core_area * skin + curvature * skin * skin + 4 * pi / 3 * skin * skin * skin;
  const double area = core_area + 2 * curvature * skin + 4 * pi * skin * skin;
  double before[2] = {0, 0};
  for (const double spacing : {1.6, 0.8, 0.4}) {
    density::Options d;
    d.spacing = spacing;
    density::Counts counts;
    const BlockGrid grid = to_block_grid(density::compute(rod, d, counts), 1);
    contour::Summary summary;
    TetMesh m = contour::contour(grid, {}, summary, [](const std::string&) {});
    optimize::improve(m, &grid, {});
    double v = 0, a = 0;
    for (const Tet& t : m.tet)
      v += tet_volume(m.point[t[0]], m.point[t[1]], m.point[t[2]], m.point[t[3]]);
    for (const Tri& t : m.tri)
      a += tri_area(m.point[t[0]], m.point[t[1]], m.point[t[2]]);
    const double off[2] = {std::abs(v / volume - 1), std::abs(a / area - 1)};
    INFO("spacing " << spacing << ": volume off by " << off[0] << ", area by " << off[1]);
    for (size_t i = 0; i < 2; ++i) {
      CHECK((before[i] == 0 || off[i] < 0.5 * before[i]));
      before[i] = off[i];
    }
  }
  CHECK(before[0] < 0.01); // chords of 0.4 Å and larger on a radius of 7 Å
  CHECK(before[1] < 0.01);
}
