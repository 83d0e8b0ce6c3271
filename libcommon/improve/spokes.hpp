// spokes.hpp — the elements at a vertex that moves: their worst quality, eight at a time.
#pragma once
#include "improve/quality.hpp"
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace molmesh::improve {

/// Single precision relative to where the vertex began: for comparing places. What is taken is judged in double.
class Spokes {
public:
  /// Lengths are measured from `origin` in units of the first element's first edge.
  void clear(Vec3d origin) {
    origin_ = origin;
    scale_ = 0;
    count_ = 0;
    group_.clear();
  }
  /// p: corners of a positive element; p[moving] is the vertex, wherever it is now.
  void add(const std::array<Vec3d, 4>& p, int moving);
  size_t size() const { return count_; }
  /// Smallest quality with the vertex at x, or some value ≤ above as soon as elements are no better than that. The
  /// group that decided moves one place forward: it is the likely one next time.
  float worst(Vec3d x, float above);
  /// Direction (unit) in which the worst element at x improves fastest, by differences over `step`; zero when flat.
  Vec3d ascent(Vec3d x, double step);

private:
  static constexpr int lanes = 8;
  using Lane = std::array<float, lanes>;
  /// As in Spoke.
  struct Group {
    Lane ax, ay, az, bx, by, bz, cx, cy, cz, nx, ny, nz, r, ab, bc, ca;
  };
  static void evaluate(const Group& g, Vec3f x, Lane& q);
  Vec3f local(Vec3d x) const {
    const Vec3d u = (x - origin_) / scale_;
    return {static_cast<float>(u.x), static_cast<float>(u.y), static_cast<float>(u.z)};
  }
  static float least(const Lane& q) {
    float w = q[0];
    for (int l = 1; l < lanes; ++l)
      w = q[size_t(l)] < w ? q[size_t(l)] : w;
    return w;
  }
  Vec3d origin_;
  double scale_ = 0;
  size_t count_ = 0;
  std::vector<Group> group_;
};

} // namespace molmesh::improve
