// cube_distances.hpp — signed distances to the boundary of a union of balls, at the points of a cube of the grid.
#pragma once
#include "distance/influence.hpp"
#include "distance/nearest_simd.hpp"
#include "grid/block_grid.hpp"
#include <array>
#include <cstdint>
#include <vector>

namespace molmesh::distance {

/// Points lo ≤ (x, y, z) < hi, at most `most` along an axis; their values are ordered by x, then y, then z.
struct PointCube {
  static constexpr int32_t most = 9;
  Vec3i lo, hi;
};

enum class Side {
  inside,
  outside,
  mixed
}; ///< all above the highest wanted value, all below the lowest, or neither

/// For one thread.
class CubeDistances {
public:
  CubeDistances(const Influence& influence, const GridFrame& frame) : influence_(influence), frame_(frame) {}

  /// Those of `from` that may matter for a point of the cube, which may be of any size.
  void narrow(const std::vector<int32_t>& from, const PointCube& cube, std::vector<int32_t>& to) const;
  /// Fills value() where the points are mixed. near: all that may matter there, and more.
  Side find(const PointCube& cube, const std::vector<int32_t>& near);
  const double* value() const { return value_.data(); }
  int64_t visits = 0; ///< of balls, arcs and vertices, each for a whole cube

private:
  static constexpr size_t room = (PointCube::most * PointCube::most * PointCube::most + 7) / 8 * 8;
  using Numbers = std::array<double, room>;

  struct Box {
    Vec3d middle, half; ///< half: its edges
    double distance(Vec3d p) const;
    double farthest(Vec3d p) const;
  };
  Box box_of(const PointCube& cube) const;
  void choose(const Box& box, const std::vector<int32_t>& near);
  Side one_side(const Box& box) const;
  void find_deepest_balls(size_t n);
  bool on_free_part(int32_t ball, Vec3d p) const;
  bool on_free_part_of_equals(Vec3d p, double depth) const;
  void find_nearest_edges(size_t n);

  /// A place that may matter for the cube. near: of a ball, how deep it may hold a point, with the sign changed;
  /// else the least distance.
  struct Candidate {
    double near;
    int32_t number;
    bool operator<(const Candidate& o) const { return near != o.near ? near < o.near : number < o.number; }
  };

  const Influence& influence_;
  const GridFrame& frame_;
  std::vector<Candidate> ball_, edge_;
  alignas(64) Numbers x_{}, y_{}, z_{}, value_{}, second_{};
  alignas(64) Numbers deepest_{}; ///< number of the ball in which a point is deepest
  alignas(64) Numbers left_x_{}, left_y_{}, left_z_{}, left_d2_{};
  std::array<int32_t, room> left_{}; ///< points whose deepest ball does not give the distance
};

} // namespace molmesh::distance
