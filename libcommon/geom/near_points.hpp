// near_points.hpp — tells whether a place lies within a distance of one of many points.
#pragma once
#include "geom/vec.hpp"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace molmesh {

/// Tells whether a point lies within a distance (Å) of any of a set of points. Hashes the points into cubic cells
/// whose edge is that distance.
class NearPoints {
public:
  explicit NearPoints(double distance) : distance_(distance) {}

  void add(Vec3d p) {
    cell_[key(index(p.x), index(p.y), index(p.z))].push_back(p);
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis] = std::min(low_[axis], p[axis]);
      high_[axis] = std::max(high_[axis], p[axis]);
    }
  }

  bool has(Vec3d p) const {
    for (int axis = 0; axis < 3; ++axis)
      if (!(p[axis] >= low_[axis] - distance_ && p[axis] <= high_[axis] + distance_))
        return false;
    const int64_t x = index(p.x), y = index(p.y), z = index(p.z);
    for (int64_t i = x - 1; i <= x + 1; ++i)
      for (int64_t j = y - 1; j <= y + 1; ++j)
        for (int64_t k = z - 1; k <= z + 1; ++k) {
          const auto found = cell_.find(key(i, j, k));
          if (found == cell_.end())
            continue;
          for (const Vec3d& q : found->second)
            if (norm2(p - q) <= distance_ * distance_)
              return true;
        }
    return false;
  }

private:
  int64_t index(double v) const { return static_cast<int64_t>(std::clamp(std::floor(v / distance_), -1e6, 1e6)); }
  static int64_t key(int64_t i, int64_t j, int64_t k) {
    return ((i + (1 << 20)) << 42) + ((j + (1 << 20)) << 21) + k + (1 << 20);
  }

  double distance_;
  std::unordered_map<int64_t, std::vector<Vec3d>> cell_;
  Vec3d low_{1e308, 1e308, 1e308}, high_{-1e308, -1e308, -1e308};
};

} // namespace molmesh
