// union_of_balls.cpp — a binary tree over the balls, halved at the median of the longest axis.
#include "distance/union_of_balls.hpp"
#include <algorithm>

namespace molmesh::distance {

UnionOfBalls::UnionOfBalls(std::vector<Ball> balls) : ball_(std::move(balls)) {
  build();
  std::vector<Ball> kept;
  std::vector<int32_t> near;
  for (int32_t i = 0; i < size(); ++i) {
    const Ball& b = ball_[static_cast<size_t>(i)];
    near.clear();
    find_meeting(b, near);
    const bool within = std::any_of(near.begin(), near.end(), [&](int32_t k) {
      const Ball& other = ball_[static_cast<size_t>(k)];
      const double room = other.radius - b.radius;
      return k != i && room >= 0 && norm2(other.center - b.center) <= room * room &&
             (room > 0 || k < i); // of equal balls the first stays
    });
    if (!within)
      kept.push_back(b);
  }
  if (kept.size() == ball_.size())
    return;
  ball_ = std::move(kept);
  build();
}

void UnionOfBalls::build() {
  node_.clear();
  if (!ball_.empty())
    build(0, size());
}

int32_t UnionOfBalls::build(int32_t begin, int32_t end) {
  constexpr int32_t leaf_size = 8;
  const auto number = static_cast<int32_t>(node_.size());
  Node n{ball_[static_cast<size_t>(begin)].center, ball_[static_cast<size_t>(begin)].center, begin, end, -1};
  Vec3d lo = n.lo, hi = n.hi; // of the centres
  for (int32_t i = begin; i < end; ++i) {
    const Ball& b = ball_[static_cast<size_t>(i)];
    for (int a = 0; a < 3; ++a) {
      n.lo[a] = std::min(n.lo[a], b.center[a] - b.radius);
      n.hi[a] = std::max(n.hi[a], b.center[a] + b.radius);
      lo[a] = std::min(lo[a], b.center[a]);
      hi[a] = std::max(hi[a], b.center[a]);
    }
  }
  node_.push_back(n);
  if (end - begin <= leaf_size)
    return number;
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (hi[a] - lo[a] > hi[axis] - lo[axis])
      axis = a;
  const int32_t middle = begin + (end - begin) / 2;
  std::nth_element(ball_.begin() + begin, ball_.begin() + middle, ball_.begin() + end,
                   [axis](const Ball& a, const Ball& b) {
                     return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis]
                            : !(a.center == b.center)        ? a.center < b.center
                                                             : a.radius > b.radius;
                   });
  build(begin, middle);
  const int32_t second = build(middle, end);
  node_[static_cast<size_t>(number)].second = second;
  return number;
}

void UnionOfBalls::find_meeting(const Ball& ball, std::vector<int32_t>& found) const {
  int32_t open[64], n = 0; // halving 2^31 balls takes half as many
  if (!node_.empty())
    open[n++] = 0;
  while (n > 0) {
    const int32_t at = open[--n];
    const Node& node = node_[static_cast<size_t>(at)];
    double gap2 = 0;
    for (int a = 0; a < 3; ++a) {
      const double gap = std::max({node.lo[a] - ball.center[a], ball.center[a] - node.hi[a], 0.0});
      gap2 += gap * gap;
    }
    if (gap2 >= ball.radius * ball.radius)
      continue;
    if (node.second >= 0) {
      open[n++] = node.second;
      open[n++] = at + 1;
      continue;
    }
    for (int32_t i = node.begin; i < node.end; ++i) {
      const Ball& b = ball_[static_cast<size_t>(i)];
      const double reach = b.radius + ball.radius;
      if (norm2(b.center - ball.center) < reach * reach)
        found.push_back(i);
    }
  }
}

} // namespace molmesh::distance
