// union_of_balls.hpp — balls of which none lies within another, and the search for those that meet a ball.
#pragma once
#include "geom/vec.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::distance {

struct Ball {
  Vec3d center;      ///< Å
  double radius = 0; ///< Å, > 0
};

/// The union U of balls. Balls within another are left out, of equal ones all but one: U stays as it is.
class UnionOfBalls {
public:
  /// The result depends on the balls and their order alone.
  explicit UnionOfBalls(std::vector<Ball> balls);

  /// Ordered so that balls near each other in space are near each other in the array.
  const std::vector<Ball>& balls() const { return ball_; }
  int32_t size() const { return static_cast<int32_t>(ball_.size()); }
  /// Appends the balls that share inner points with `ball`, by number.
  void find_meeting(const Ball& ball, std::vector<int32_t>& found) const;

private:
  /// A node of a binary tree of boxes: a leaf holds the balls [begin, end); another has its first child behind it.
  struct Node {
    Vec3d lo, hi;
    int32_t begin, end, second; ///< second: the second child; -1: a leaf
  };
  void build();
  int32_t build(int32_t begin, int32_t end);

  std::vector<Ball> ball_;
  std::vector<Node> node_;
};

} // namespace molmesh::distance
