// star_quality_test.cpp — a star's elements at once give the same bits as one at a time, on every instruction set.
#include "geom/star_quality.hpp"
#include "unit/instruction_sets.hpp"
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace molmesh;
using molmesh::test::with_every_instruction_set;

namespace {

std::mt19937 generator(11);
Vec3d random_point(double size) {
  std::uniform_real_distribution<double> u(-size, size);
  return {u(generator), u(generator), u(generator)};
}

} // namespace

TEST_CASE("a star's elements are prepared and judged as one is") {
  with_every_instruction_set([&] {
    for (int count = 1; count <= 40; ++count) {
      const Vec3d origin{50, -30, 20};
      StarQuality star;
      star.clear(origin);
      std::vector<std::array<Vec3d, 3>> corners;
      for (int k = 0; k < count; ++k) {
        const std::array<Vec3d, 4> p{origin, origin + random_point(1), origin + random_point(1),
                                     origin + random_point(1)};
        star.add(p, 0);
        corners.push_back({p[1], p[2], p[3]});
        if (k % 7 == 0) // asked in between
          star.worst(origin, -2);
      }
      const double inverse = 1 / norm(corners[0][0] - corners[0][1]);
      const auto local = [&](Vec3d p) {
        const Vec3d u = (p - origin) * inverse;
        return Vec3f{static_cast<float>(u.x), static_cast<float>(u.y), static_cast<float>(u.z)};
      };
      const Vec3d x = origin + random_point(0.1);
      float worst = 2;
      for (const auto& c : corners) {
        const Vec3f y = local(x);
        float q;
        star_element_quality(make_star_element(local(c[0]), local(c[1]), local(c[2])), y.x, y.y, y.z, q,
                             static_cast<float>(shape_weight));
        worst = std::min(worst, q);
      }
      CHECK(star.worst(x, -2) == worst);
    }
  });
}
