// boundary.hpp — the boundary of a union of balls: free parts of spheres, arcs where two spheres meet, and vertices
// where three do.
#pragma once
#include "distance/union_of_balls.hpp"
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace molmesh::distance {

/// The part of a ball's sphere that lies within another ball: center + radius·u with u·normal > height.
struct Cap {
  Vec3d normal;         ///< of length 1
  double height;        ///< between -1 and 1
  double circle_radius; ///< of the circle that ends it, in radii of the ball
  double slack;         ///< places up to this much higher count as free: they are hardly within the other ball
  int32_t other;        ///< the other ball
  double buries() const { return height + slack; }
};

/// A free part of the circle in which two spheres meet: middle + radius·(cos t·first + sin t·second), t from 0 on
/// to the direction (end_x, end_y).
struct Arc {
  Vec3d middle, axis, first, second; ///< the last three: of length 1, at right angles
  double radius;                     ///< Å
  double end_x, end_y;               ///< direction of the end in (first, second)
  enum class Length : int8_t { short_arc, long_arc, circle } length; ///< up to half a turn, more, all of it
  int32_t ball[2];

  /// Whether the direction (x, y) lies within the arc.
  bool holds(double x, double y) const {
    const bool after = y >= 0, before = x * end_y - y * end_x >= 0;
    return length == Length::short_arc ? after && before : length == Length::long_arc ? after || before : true;
  }
  Vec3d place(double x, double y) const { return middle + radius * (x * first + y * second); }
  /// A ball that holds the arc.
  Ball bounds() const;
};

/// Every place of it is at most `tolerance` deep within U, and no place of U's boundary is farther from it than
/// rounding (docs/theory/surfaces.md).
struct Boundary {
  double tolerance = 0;           ///< Å
  std::vector<int8_t> free;       ///< [balls] a part of the ball's sphere is free
  std::vector<int64_t> cap_begin; ///< [balls + 1]
  std::vector<Cap> cap;           ///< of the balls with free parts; their spheres outside of them are free
  std::vector<Arc> arc;
  std::vector<Vec3d> vertex; ///< ends of arcs

  std::span<const Cap> caps(int32_t ball) const {
    const auto b = static_cast<size_t>(ball);
    return std::span(cap).subspan(static_cast<size_t>(cap_begin[b]),
                                  static_cast<size_t>(cap_begin[b + 1] - cap_begin[b]));
  }
};

/// Where a boundary is wanted.
struct Region {
  Vec3d lo{-1e300, -1e300, -1e300}, hi{1e300, 1e300, 1e300}; ///< Å
  bool meets(const Ball& b) const {
    double gap2 = 0;
    for (int a = 0; a < 3; ++a) {
      const double gap = std::max({lo[a] - b.center[a], b.center[a] - hi[a], 0.0});
      gap2 += gap * gap;
    }
    return gap2 <= b.radius * b.radius;
  }
};

/// Of balls that do not meet the region it has no part, or some, and calls none free. Time: proportional to the
/// number of pairs of balls that meet, there. The same for any number of threads, and within any region.
Boundary boundary_of(const UnionOfBalls& balls, int threads, const Region& region = {});

} // namespace molmesh::distance
