// sampled.hpp — the solvent-excluded body by its definition: where no probe reaches whose center is one of very
// many places outside of all larger balls. Nothing is solved: places are taken all over spheres and circles.
#pragma once
#include "molecule/hierarchy.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace molmesh::test {

/// Points in cubic cells.
class PointCells {
public:
  explicit PointCells(double size) : size_(size) {}
  void add(Vec3d p) { cell_[key(p)].push_back(p); }
  /// Calls use(points) for each cell that the ball may meet.
  template <class Use>
  void for_near(Vec3d p, double radius, Use&& use) const {
    const std::array<int64_t, 3> lo = key(p - radius * Vec3d{1, 1, 1}), hi = key(p + radius * Vec3d{1, 1, 1});
    for (int64_t i = lo[0]; i <= hi[0]; ++i)
      for (int64_t j = lo[1]; j <= hi[1]; ++j)
        for (auto c = cell_.lower_bound({i, j, lo[2]}); c != cell_.end() && c->first <= std::array{i, j, hi[2]};
             ++c)
          use(c->second);
  }

private:
  std::array<int64_t, 3> key(Vec3d p) const {
    const auto cell = [this](double v) { return static_cast<int64_t>(std::floor(v / size_)); };
    return {cell(p.x), cell(p.y), cell(p.z)};
  }
  double size_;
  std::map<std::array<int64_t, 3>, std::vector<Vec3d>> cell_;
};

/// step: Å between the places on spheres; those on circles are ten times as close.
class SampledSurface {
public:
  SampledSurface(const Hierarchy& h, double probe, double step) : probe_(probe), places_(0.5) {
    for (const Atom& a : h.atom)
      if (a.radius > 0)
        ball_.push_back({a.center, a.radius + probe});
    near_.resize(ball_.size());
    for (size_t i = 0; i < ball_.size(); ++i)
      for (size_t k = 0; k < ball_.size(); ++k)
        if (k != i && norm(ball_[i].center - ball_[k].center) < ball_[i].radius + ball_[k].radius)
          near_[i].push_back(k);
    for (size_t i = 0; i < ball_.size(); ++i) {
      sample_sphere(i, step);
      for (const size_t k : near_[i])
        if (k > i)
          sample_circle(i, k, step / 10);
    }
  }

  /// How deep p is in the deepest ball, at most `most`: less than the distance to the outside.
  double depth(Vec3d p, double most) const {
    double deepest = -1e300;
    for (const Ball& b : ball_) {
      deepest = std::max(deepest, b.radius - norm(p - b.center));
      if (deepest >= most)
        return most;
    }
    return deepest;
  }
  /// Signed distance to the surface, Å, at most `most`; a little too large: the nearest place is not taken itself.
  double distance(Vec3d p, double most) const {
    const double inner = depth(p, probe_ + most);
    if (inner < 0 || inner >= probe_ + most)
      return inner - probe_;
    double best = (probe_ + most) * (probe_ + most);
    places_.for_near(p, probe_ + most, [&](const std::vector<Vec3d>& points) {
      for (const Vec3d& q : points)
        best = std::min(best, norm2(p - q));
    });
    return std::sqrt(best) - probe_;
  }

private:
  struct Ball {
    Vec3d center;
    double radius;
  };
  void take(Vec3d q, size_t i) {
    if (std::none_of(near_[i].begin(), near_[i].end(),
                     [&](size_t k) { return norm(q - ball_[k].center) < ball_[k].radius - 1e-9; }))
      places_.add(q);
  }
  void sample_sphere(size_t i, double step) {
    const Ball& b = ball_[i];
    const int n = static_cast<int>(std::ceil(12.6 * b.radius * b.radius / (step * step)));
    for (int s = 0; s < n; ++s) { // Fibonacci's spiral
      const double z = 1 - (2 * s + 1.0) / n, r = std::sqrt(1 - z * z), t = 2.399963229728653 * s;
      take(b.center + b.radius * Vec3d{r * std::cos(t), r * std::sin(t), z}, i);
    }
  }
  void sample_circle(size_t i, size_t k, double step) {
    const Vec3d between = ball_[k].center - ball_[i].center;
    const double d = norm(between), r = ball_[i].radius, s = ball_[k].radius,
                 along = (d * d + r * r - s * s) / (2 * d);
    if (!(d > 0 && r * r > along * along))
      return;
    const Vec3d axis = between / d, least = std::abs(axis.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    Vec3d u = cross(axis, least);
    u = u / norm(u);
    const Vec3d v = cross(axis, u);
    const double radius = std::sqrt(r * r - along * along);
    const int n = static_cast<int>(std::ceil(6.3 * radius / step)) + 3;
    for (int m = 0; m < n; ++m) {
      const double t = 6.283185307179586 * m / n;
      take(ball_[i].center + along * axis + radius * (std::cos(t) * u + std::sin(t) * v), i);
    }
  }

  double probe_;
  std::vector<Ball> ball_;
  std::vector<std::vector<size_t>> near_;
  PointCells places_;
};

} // namespace molmesh::test
