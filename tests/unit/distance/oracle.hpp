// oracle.hpp — distances to the surfaces of a few atoms by their definitions: every place that may be the nearest
// one is tried, and counts where no ball buries it.
#pragma once
#include "distance/distance.hpp"
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace molmesh::test {

struct OracleBall {
  Vec3d center;
  double radius;
};

/// Signed distance to the boundary of the balls' union, by all balls, pairs and triples of balls.
class UnionOracle {
public:
  explicit UnionOracle(std::vector<OracleBall> balls) : ball_(std::move(balls)) {}

  double distance(Vec3d p) const {
    double depth = -1e300;
    for (const OracleBall& b : ball_)
      depth = std::max(depth, b.radius - norm(p - b.center));
    if (depth < 0)
      return depth;
    double best = 1e300;
    const auto n = ball_.size();
    const auto attempt = [&](Vec3d q) {
      if (free(q))
        best = std::min(best, norm(p - q));
    };
    for (size_t i = 0; i < n; ++i) {
      const Vec3d from = p - ball_[i].center;
      const double length = norm(from);
      attempt(ball_[i].center + ball_[i].radius * (length > 0 ? from / length : Vec3d{0, 0, 1}));
      for (size_t k = i + 1; k < n; ++k) {
        Vec3d middle, axis;
        double radius;
        if (!circle(i, k, middle, axis, radius))
          continue;
        Vec3d in = p - middle;
        in = in - dot(in, axis) * axis;
        if (norm(in) > 0)
          attempt(middle + radius * (in / norm(in)));
        for (size_t l = k + 1; l < n; ++l)
          for_corners(i, k, l, attempt);
      }
    }
    return best;
  }

private:
  static constexpr double rounding = 1e-9;
  bool free(Vec3d q) const {
    return std::all_of(ball_.begin(), ball_.end(),
                       [&](const OracleBall& b) { return norm(q - b.center) >= b.radius - rounding; });
  }
  bool circle(size_t i, size_t k, Vec3d& middle, Vec3d& axis, double& radius) const {
    const Vec3d between = ball_[k].center - ball_[i].center;
    const double d = norm(between), r = ball_[i].radius, s = ball_[k].radius;
    if (!(d > 0))
      return false;
    const double along = (d * d + r * r - s * s) / (2 * d), r2 = r * r - along * along;
    if (r2 <= 0)
      return false;
    axis = between / d;
    middle = ball_[i].center + along * axis;
    radius = std::sqrt(r2);
    return true;
  }
  /// The two places that lie on three spheres, as the radical line's places on one of them.
  template <class Use>
  void for_corners(size_t i, size_t k, size_t l, Use&& use) const {
    const Vec3d a = ball_[k].center - ball_[i].center, b = ball_[l].center - ball_[i].center, n = cross(a, b);
    if (!(norm2(n) > 1e-18))
      return;
    const auto square = [&](size_t m) { return ball_[m].radius * ball_[m].radius; };
    const double u = 0.5 * (norm2(a) + square(i) - square(k)), v = 0.5 * (norm2(b) + square(i) - square(l));
    const Vec3d foot = (u * cross(b, n) + v * cross(n, a)) / norm2(n);
    const double h2 = square(i) - norm2(foot);
    if (h2 < -1e-9)
      return;
    const Vec3d up = std::sqrt(std::max(0.0, h2) / norm2(n)) * n;
    use(ball_[i].center + foot + up);
    use(ball_[i].center + foot - up);
  }

  std::vector<OracleBall> ball_;
};

/// d of distance.hpp, Å.
class SurfaceOracle {
public:
  SurfaceOracle(const Hierarchy& h, const distance::Body& body)
      : balls_(balls(h, body)), offset_(body.surface == distance::Surface::solvent_excluded ? body.probe : 0) {}
  double distance(Vec3d p) const { return balls_.distance(p) - offset_; }

private:
  static std::vector<OracleBall> balls(const Hierarchy& h, const distance::Body& body) {
    std::vector<OracleBall> all;
    for (const Atom& a : h.atom)
      if (a.radius > 0)
        all.push_back({a.center, a.radius + (body.surface == distance::Surface::van_der_waals ? 0 : body.probe)});
    return all;
  }
  UnionOracle balls_;
  double offset_;
};

} // namespace molmesh::test
