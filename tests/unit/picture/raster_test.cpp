// raster_test.cpp — what the rasterizer shows, against a ray through every sample.
#include "picture/raster.hpp"
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace molmesh;
using namespace molmesh::picture;

namespace {

Scene random_scene(int facets) {
  Scene s;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-10, 70), depth(-20, 20);
  for (int i = 0; i < facets; ++i) {
    const auto v = static_cast<int32_t>(s.point.size());
    const float x = place(random), y = place(random);
    for (int k = 0; k < 3; ++k)
      s.point.push_back({x + 0.3f * place(random), y + 0.3f * place(random), depth(random)});
    const auto c = static_cast<uint8_t>(1 + i);
    s.facet.push_back({{v, v + 1, v + 2}, {c, c, c}, false});
  }
  return s;
}

/// The facet that a ray along z meets first, -1: none; -2: it meets an edge or two at once, so that rounding
/// decides.
int nearest(const Scene& s, double x, double y) {
  int found = -1;
  double best = -1e30;
  for (size_t i = 0; i < s.facet.size(); ++i) {
    const Vec3f a = s.point[s.facet[i].corner[0]], b = s.point[s.facet[i].corner[1]],
                c = s.point[s.facet[i].corner[2]];
    const auto side = [&](Vec3f p, Vec3f q) {
      return ((double(q.x) - p.x) * (y - p.y) - (double(q.y) - p.y) * (x - p.x)) /
             std::hypot(double(q.x) - p.x, double(q.y) - p.y);
    };
    const double d[3] = {side(b, c), side(c, a), side(a, b)};
    if (std::fabs(d[0]) < 1e-3 || std::fabs(d[1]) < 1e-3 || std::fabs(d[2]) < 1e-3)
      return -2;
    if ((d[0] > 0) != (d[1] > 0) || (d[0] > 0) != (d[2] > 0))
      continue;
    const Vec3d n = cross(Vec3d{double(b.x) - a.x, double(b.y) - a.y, double(b.z) - a.z},
                          Vec3d{double(c.x) - a.x, double(c.y) - a.y, double(c.z) - a.z});
    const double z = a.z - (n.x * (x - a.x) + n.y * (y - a.y)) / n.z;
    if (std::fabs(z - best) < 1e-3)
      return -2;
    if (z > best)
      best = z, found = static_cast<int>(i);
  }
  return found;
}

} // namespace

TEST_CASE("each sample shows the facet nearest to the viewer") {
  const Scene s = random_scene(60);
  RasterOptions o;
  o.width = o.height = 64;
  o.samples = 1;
  o.shade_hollows = false;
  o.background = {255, 0, 0};
  const Image image = draw_scene(s, o, 2);
  int compared = 0, covered = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const int expected = nearest(s, x + 0.5, y + 0.5);
      if (expected == -2)
        continue;
      ++compared;
      const uint8_t* const p = image.at(x, y);
      const bool background = p[0] == 255 && p[1] == 0;
      if (expected < 0) {
        CHECK(background);
        continue;
      }
      ++covered;
      // Grey of the facet's number times its light: the light of this facet alone, drawn by itself.
      Scene alone = s;
      alone.facet = {s.facet[static_cast<size_t>(expected)]};
      static std::vector<Image> of(60);
      Image& own = of[static_cast<size_t>(expected)];
      if (own.width == 0)
        own = draw_scene(alone, o, 1);
      CHECK(p[0] == own.at(x, y)[0]);
      CHECK(p[1] == own.at(x, y)[1]);
    }
  CHECK(compared > 3500);
  CHECK(covered > 1000);
}

TEST_CASE("a picture has the same bytes at any number of threads") {
  Scene s = random_scene(200);
  s.edge_width = 1.2;
  s.edge_opacity = 0.5;
  s.normal.assign(s.point.size(), {0.3f, 0.2f, 0.9f});
  for (size_t i = 0; i < s.facet.size(); i += 2)
    s.facet[i].smooth = true;
  RasterOptions o;
  o.width = 90;
  o.height = 70;
  const Image one = draw_scene(s, o, 1);
  CHECK(draw_scene(s, o, 2).rgb == one.rgb);
  CHECK(draw_scene(s, o, 5).rgb == one.rgb);
}

TEST_CASE("supersampling gives a pixel the share of a facet that covers it") {
  Scene s; // a white rectangle from x = 2.5 to 7.25 on black, facing the viewer
  s.point = {{2.5f, -5, 0}, {7.25f, -5, 0}, {7.25f, 20, 0}, {2.5f, 20, 0}};
  s.facet = {{{0, 1, 2}, {100, 100, 100}, false}, {{0, 2, 3}, {100, 100, 100}, false}};
  RasterOptions o;
  o.width = o.height = 10;
  o.samples = 4;
  o.shade_hollows = false;
  o.background = {0, 0, 0};
  const Image image = draw_scene(s, o, 1);
  const double full = image.at(5, 5)[0];
  CHECK(full > 80);
  CHECK(image.at(1, 5)[0] == 0);
  CHECK(image.at(2, 5)[0] == Approx(full / 2).margin(1));
  CHECK(image.at(7, 5)[0] == Approx(full / 4).margin(1));
  CHECK(image.at(8, 5)[0] == 0);
}

TEST_CASE("a hollow is darker than the plane around it, and a plane is not shaded") {
  Scene s;
  const auto square = [&](float x0, float y0, float x1, float y1, float z) {
    const auto v = static_cast<int32_t>(s.point.size());
    s.point.insert(s.point.end(), {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}});
    s.facet.push_back({{v, v + 1, v + 2}, {150, 150, 150}, false});
    s.facet.push_back({{v, v + 2, v + 3}, {150, 150, 150}, false});
  };
  square(-50, -50, 150, 150, 0);
  RasterOptions o;
  o.width = o.height = 100;
  const int flat = draw_scene(s, o, 1).at(50, 50)[0];
  o.shade_hollows = false;
  CHECK(draw_scene(s, o, 1).at(50, 50)[0] == flat);
  o.shade_hollows = true;
  square(-50, -50, 40, 150, 30); // walls on both sides of a groove
  square(60, -50, 150, 150, 30);
  const Image image = draw_scene(s, o, 1);
  CHECK(image.at(50, 50)[0] < flat - 10);
  CHECK(image.at(10, 50)[0] == flat);
}
