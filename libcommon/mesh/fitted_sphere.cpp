// fitted_sphere.cpp — Gauss and Newton's iteration for center and radius.
#include "mesh/fitted_sphere.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace molmesh {
namespace {

/// Rows of four unknowns and the right side, by elimination with pivots. False where there is no single solution.
bool solve(std::array<std::array<double, 5>, 4>& a, std::array<double, 4>& x) {
  const double least = 1e-6 * a[3][3]; // which counts the points
  for (size_t i = 0; i < 4; ++i) {
    size_t pivot = i;
    for (size_t r = i + 1; r < 4; ++r)
      if (std::fabs(a[r][i]) > std::fabs(a[pivot][i]))
        pivot = r;
    std::swap(a[i], a[pivot]);
    if (!(std::fabs(a[i][i]) > least))
      return false;
    for (size_t r = i + 1; r < 4; ++r)
      for (size_t c = 5; c-- > i;)
        a[r][c] -= a[r][i] / a[i][i] * a[i][c];
  }
  for (size_t i = 4; i-- > 0;) {
    x[i] = a[i][4];
    for (size_t c = i + 1; c < 4; ++c)
      x[i] -= a[i][c] * x[c];
    x[i] /= a[i][i];
  }
  return true;
}

} // namespace

std::optional<Sphere> sphere_through(const std::vector<Vec3d>& point, const std::vector<int32_t>& on) {
  if (on.size() < 4)
    return {};
  Sphere s;
  for (const int32_t v : on)
    s.center += point[v] / double(on.size());
  for (const int32_t v : on)
    s.radius += norm(point[v] - s.center) / double(on.size());
  constexpr int most_steps = 20;
  for (int step = 0; step < most_steps; ++step) {
    std::array<std::array<double, 5>, 4> a{};
    for (const int32_t v : on) {
      const Vec3d d = point[v] - s.center;
      const double length = norm(d);
      const std::array<double, 5> row{d.x / length, d.y / length, d.z / length, 1, length - s.radius};
      for (size_t i = 0; i < 4; ++i)
        for (size_t j = 0; j < 5; ++j)
          a[i][j] += row[i] * row[j];
    }
    std::array<double, 4> x;
    if (!solve(a, x))
      return {};
    s.center += Vec3d{x[0], x[1], x[2]};
    s.radius += x[3];
  }
  const bool fits =
      std::all_of(on.begin(), on.end(), [&](int32_t v) { return std::fabs(s.height(point[v])) <= s.rounding(); });
  return fits ? std::optional(s) : std::nullopt;
}

} // namespace molmesh
