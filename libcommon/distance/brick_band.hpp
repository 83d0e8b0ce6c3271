// brick_band.hpp — the band cells of a brick of 4³ blocks, from the distances at its points and one layer around
// it.
#pragma once
#include "density/culling/bricks.hpp"
#include "distance/cube_distances.hpp"
#include "distance/near_bricks.hpp"
#include "grid/band.hpp"
#include "par/arena.hpp"

namespace molmesh::distance {

/// What turns a signed distance to U's boundary into a value, and into a side of the band.
struct Scale {
  double offset;       ///< Å: the surface is where the distance to U's boundary is this
  double lower, upper; ///< Å: limits of the band, as distances to U's boundary
  int dropped_bits;    ///< of a value's 23 after the leading one
  float value(double distance) const;
};

/// For one thread.
class BrickBand {
public:
  BrickBand(const Influence& influence, const GridFrame& frame, Scale scale)
      : frame_(frame), scale_(scale), distances_(influence, frame) {}

  /// Appends the blocks with active points, whose values `memory` holds, and those that lie wholly inside.
  void find(const NearBrick& brick, par::Arena<float>& memory, std::vector<BandBlock>& band,
            std::vector<Vec3i>& inside);

  int64_t points = 0; ///< of the grid, whose distance was computed
  int64_t active_points = 0, cubes = 0, mixed_cubes = 0;
  int64_t visits() const { return distances_.visits; }

private:
  static constexpr int32_t edge = density::brick_edge, wide = edge + 2;
  /// Bit z of row [x][y]: the point (x - 1, y - 1, z - 1) of the brick.
  using Rows = std::array<std::array<uint64_t, wide>, wide>;

  void find_sides(const NearBrick& brick);
  void fill(const PointCube& cube, Vec3i first, Side side);
  bool find_active(Vec3i first);

  const GridFrame& frame_;
  const Scale scale_;
  CubeDistances distances_;
  std::vector<int32_t> near_; ///< that may matter in a part of the brick
  Rows below_{}, above_{}, active_{};
  /// Of the brick's own points, by block: distances to U's boundary.
  std::array<std::array<double, 512>, density::blocks_a_brick> distance_{};
};

} // namespace molmesh::distance
