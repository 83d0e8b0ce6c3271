// mesh_picture_test.cpp — what a picture of a mesh shows: regions, the cut, colours, text.
#include "../mesh/meshes.hpp"
#include "geom/tet_measures.hpp"
#include "picture/colours.hpp"
#include "picture/drawing.hpp"
#include "picture/glyphs.hpp"
#include "picture/mesh_picture.hpp"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::picture;

namespace {

TetMesh ball_in_box() {
  return testing::cubes(8, [](Vec3i c) {
    const Vec3d d = to_double(c) - Vec3d{3.5, 3.5, 3.5};
    return norm2(d) < 7 ? 1 : 2;
  });
}

PictureOptions plain_options() {
  PictureOptions o;
  o.raster.width = 160;
  o.raster.height = 120;
  o.raster.samples = 2;
  o.raster.shade_hollows = false;
  o.region = {1};
  o.caption = o.edges = false;
  return o;
}

/// Pixels whose colour is nearer to the first than to the second, by the ratio of its parts.
int64_t pixels(const Image& image, Rgb like) {
  int64_t n = 0;
  for (size_t i = 0; i < image.rgb.size(); i += 3) {
    const double r = image.rgb[i], g = image.rgb[i + 1], b = image.rgb[i + 2], sum = r + g + b + 1e-9,
                 whole = like.r + like.g + like.b;
    if (r + g + b < 700 && // neither the background nor what is half of it
        std::fabs(r / sum - like.r / whole) + std::fabs(g / sum - like.g / whole) +
                std::fabs(b / sum - like.b / whole) <
            0.03)
      ++n;
  }
  return n;
}

} // namespace

TEST_CASE("a cut takes cells away, keeps those that it passes through whole, and colours them by their angles") {
  const TetMesh m = ball_in_box();
  PictureOptions o = plain_options();
  Colouring c{"test", std::vector<Rgb>(m.tri.size(), Rgb{40, 40, 200}), {}};
  const Image whole = draw_mesh(m, c, o, 1);
  const int64_t surface = pixels(whole, {40, 40, 200});
  CHECK(surface > 2000);

  const std::array<double, 2> range = smallest_dihedrals(m, {1}, 2);
  CHECK(range[0] == Approx(45).margin(1e-6)); // Kuhn's tetrahedra are all alike
  CHECK(range[1] == Approx(45).margin(1e-6));
  o.cut.plane = {{{0, -1, 0}, -4.5}};
  const Image cut = draw_mesh(m, c, o, 1);
  const Rgb best = ramp_colour(1);
  CHECK(pixels(whole, best) == 0);
  CHECK(pixels(cut, best) > 500);
  CHECK(pixels(cut, {40, 40, 200}) < surface);

  Colouring by_region = c;
  by_region.region[1] = {200, 40, 40};
  const Image in_colour = draw_mesh(m, by_region, o, 1);
  CHECK(pixels(in_colour, {200, 40, 40}) > 500);
  CHECK(pixels(in_colour, best) == 0);

  o.cut.plane = {{{0, -1, 0}, -100}}; // all is beyond: nothing is left
  const Image none = draw_mesh(m, c, o, 1);
  CHECK(std::all_of(none.rgb.begin(), none.rgb.end(), [](uint8_t v) { return v == 255; }));
  o.cut.plane = {{{0, -1, 0}, 100}}; // nothing is
  CHECK(draw_mesh(m, c, o, 1).rgb == whole.rgb);
}

TEST_CASE("a wedge is taken away where both planes say so") {
  const TetMesh m = ball_in_box();
  PictureOptions o = plain_options();
  const Colouring c{"test", std::vector<Rgb>(m.tri.size(), Rgb{40, 40, 200}), {}};
  o.cut.plane = {{{0, -1, 0}, -4}, {{1, 0, 0}, 100}}; // the second says it of nothing
  const Image whole = draw_mesh(m, c, o, 1);
  o.cut.plane.clear();
  CHECK(whole.rgb == draw_mesh(m, c, o, 1).rgb);
  o.cut.plane = {{{0, -1, 0}, -4}};
  const int64_t half = pixels(draw_mesh(m, c, o, 1), {40, 40, 200});
  o.cut.plane = {{{0, -1, 0}, -4}, {{1, 0, 0}, 4}};
  const int64_t wedge = pixels(draw_mesh(m, c, o, 1), {40, 40, 200});
  CHECK(wedge > half);
  CHECK(wedge < pixels(whole, {40, 40, 200}));
}

TEST_CASE("marked triangles are looked at from where they are seen, and those within from nowhere") {
  const TetMesh ball = testing::cubes(9, [](Vec3i c) { // with a cavity
    const double d2 = norm2(to_double(c) - Vec3d{4, 4, 4});
    return d2 < 2 ? 3 : d2 < 11 ? 1 : 2;
  });
  const auto middle = [&](size_t i) {
    const Tri& t = ball.tri[i];
    return (1 / 3.) * (ball.point[t[0]] + ball.point[t[1]] + ball.point[t[2]]) - Vec3d{4.5, 4.5, 4.5};
  };
  for (const Vec3d side : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1}, Vec3d{0, 0, -1}}) {
    std::vector<uint8_t> mark(ball.tri.size());
    for (size_t i = 0; i < mark.size(); ++i)
      mark[i] = ball.boundary[i] == Boundary::surface && dot(side, middle(i)) > 2.6;
    const BestView best = best_view(ball, mark, 2);
    CHECK(best.pixels > 500); // steps show more from aslant
    const double a = best.view.azimuth * std::acos(-1.) / 180, e = best.view.elevation * std::acos(-1.) / 180;
    CHECK(dot(side, Vec3d{std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)}) > 0.7);
  }
  std::vector<uint8_t> within(ball.tri.size());
  for (size_t i = 0; i < within.size(); ++i)
    within[i] = norm2(middle(i)) < 5;
  REQUIRE(std::count(within.begin(), within.end(), 1) > 20);
  CHECK(best_view(ball, within, 1).pixels == 0);
}

TEST_CASE("regions that are not asked for are not shown") {
  const TetMesh m = ball_in_box();
  PictureOptions o = plain_options();
  const Image ball = draw_mesh(m, {}, o, 1);
  o.region = {2};
  const Image box = draw_mesh(m, {}, o, 1);
  CHECK(pixels(ball, plain) > 1000);
  CHECK(pixels(box, plain) > 1000);
  CHECK(ball.rgb != box.rgb);
  o.region = {3}; // there is none
  const Image none = draw_mesh(m, {}, o, 1);
  CHECK(std::all_of(none.rgb.begin(), none.rgb.end(), [](uint8_t v) { return v == 255; }));
}

TEST_CASE("a captioned picture has the same bytes at any number of threads") {
  const TetMesh m = ball_in_box();
  PictureOptions o = plain_options();
  o.caption = o.edges = o.raster.shade_hollows = true;
  o.title = "a name that is far too long for so small a picture.vtu";
  o.cut.plane = {{{0, -1, 0}, -4}, {{1, 0, 0}, 4}};
  const Colouring c{"label", std::vector<Rgb>(m.tri.size(), label_colour(3)), {{"one", label_colour(3)}}};
  const Image one = draw_mesh(m, c, o, 1);
  CHECK(draw_mesh(m, c, o, 4).rgb == one.rgb);
}

TEST_CASE("the smallest dihedral angle is the least of the six") {
  const TetMesh m = testing::cubes(2, [](Vec3i) { return 1; });
  for (int64_t t = 0; t < static_cast<int64_t>(m.tet.size()); ++t) {
    const Tet& c = m.tet[t];
    const Dihedrals d = dihedrals(m.point[c[0]], m.point[c[1]], m.point[c[2]], m.point[c[3]]);
    CHECK(smallest_dihedral(m, t) == Approx(*std::min_element(d.degree, d.degree + 6)).margin(1e-9));
  }
}

TEST_CASE("text leaves ink where its glyphs are, and as much as their outlines enclose") {
  // The areas of the outlines, by the formula of trapezoids; 'o' has a hole that turns the other way.
  for (const char* const text : {"I", "o", "8", "Å", "°", "molmesh"}) {
    Image image(400, 80, white);
    draw_text(image, 10, 60, text, 48, {0, 0, 0});
    double ink_seen = 0, expected = 0;
    for (size_t i = 0; i < image.rgb.size(); i += 3)
      ink_seen += 1 - image.rgb[i] / 255.;
    const std::string s = text;
    const std::vector<uint32_t> codes = s == "Å"   ? std::vector<uint32_t>{0xC5}
                                        : s == "°" ? std::vector<uint32_t>{0xB0}
                                                   : std::vector<uint32_t>(s.begin(), s.end());
    for (const uint32_t code : codes)
      for (std::string_view rest = glyph_of(code).outline; !rest.empty();) {
        const std::string_view ring = rest.substr(0, rest.find(' '));
        rest.remove_prefix(std::min(rest.size(), ring.size() + 1));
        for (size_t i = 0, n = ring.size() / 2; i < n; ++i) {
          const size_t j = (i + 1) % n;
          expected += (ring[2 * i] - glyph_x0) * double(ring[2 * j + 1] - glyph_y0) -
                      (ring[2 * j] - glyph_x0) * double(ring[2 * i + 1] - glyph_y0);
        }
      }
    expected = std::fabs(expected) / 2 * (48 / units_per_em) * (48 / units_per_em);
    CHECK(ink_seen == Approx(expected).epsilon(0.03));
    CHECK(ink_seen > 20);
  }
  CHECK(text_width("mm", 10) == Approx(2 * text_width("m", 10)));
  CHECK(text_width("\xC3\x85", 10) == Approx(glyph_of(0xC5).advance * 10 / units_per_em));
  CHECK(&glyph_of(0x4E2D) == &glyph_of('?'));
  CHECK(shortened("molmesh", 10, 1000) == "molmesh");
  const std::string cut = shortened("tetrahedra of a molecule", 10, 60);
  CHECK(text_width(cut, 10) <= 60);
  CHECK(cut.substr(cut.size() - 3) == "…");
}

TEST_CASE("a picture too small for its caption shows the mesh without it") {
  const TetMesh m = ball_in_box();
  PictureOptions o = plain_options();
  o.caption = true;
  o.title = "ball";
  for (const auto& [width, height] : std::vector<std::array<int, 2>>{
           {64, 64}, {160, 80}, {160, 85}, {64, 100}, {600, 64}, {64, 2000}, {150, 2000}}) {
    INFO(width << " x " << height);
    o.raster.width = width;
    o.raster.height = height;
    o.caption = true;
    const Image with = draw_mesh(m, {"test", {}, {}}, o, 1);
    o.caption = false;
    CHECK((with.rgb == draw_mesh(m, {"test", {}, {}}, o, 1).rgb) ==
          (height < 85 || (width == 64 && height == 2000)));
  }
}
