// near_bricks.cpp — halves the grid down to bricks, all cubes of one size at once.
#include "distance/near_bricks.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <numeric>

namespace molmesh::distance {

std::vector<NearBrick> bricks_near(const std::vector<Ball>& balls, const GridFrame& frame,
                                   const density::BlockRange& range, int threads) {
  using density::brick_blocks;
  if (range.empty())
    return {};
  int32_t blocks = density::blocks_across(frame);
  std::vector<NearBrick> cubes(1);
  cubes[0].corner = density::first_block(frame);
  cubes[0].near.resize(balls.size());
  std::iota(cubes[0].near.begin(), cubes[0].near.end(), 0);
  while (blocks > brick_blocks) {
    blocks /= 2;
    std::vector<NearBrick> next(8 * cubes.size());
    par::for_n(static_cast<int64_t>(next.size()), threads, 1, [&](int64_t i) {
      const NearBrick& from = cubes[static_cast<size_t>(i / 8)];
      NearBrick& to = next[static_cast<size_t>(i)];
      const auto c = static_cast<int32_t>(i % 8);
      to.corner = from.corner + blocks * Vec3i{c >> 2, c >> 1 & 1, c & 1};
      if (!range.meets(to.corner, blocks))
        return;
      density::Box box = density::points_box(frame, to.corner, blocks);
      const Vec3d step = frame.spacing * Vec3d{1, 1, 1};
      box = {box.lo - step, box.hi + step};
      for (const int32_t b : from.near) {
        const Ball& ball = balls[static_cast<size_t>(b)];
        if (density::distance2(box, {ball.center, ball.center}) <= ball.radius * ball.radius)
          to.near.push_back(b);
      }
    });
    std::erase_if(next, [](const NearBrick& n) { return n.near.empty(); });
    cubes = std::move(next);
  }
  std::sort(cubes.begin(), cubes.end(), [](const NearBrick& a, const NearBrick& b) { return a.corner < b.corner; });
  return cubes;
}

} // namespace molmesh::distance
