// sample_grid.hpp — density grids of any function, made the slow and obvious way.
#pragma once
#include "grid/block_grid.hpp"
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <vector>

namespace molmesh::test {

/// Samples f on the box of points lower … lower + points - 1; active are the corners of every band cell.
inline BlockGrid sample_grid(Vec3i lower, Vec3i points, double spacing, double inside_value,
                             const std::function<double(Vec3d)>& f) {
  BlockGrid grid;
  grid.frame = {{0, 0, 0}, spacing, lower, points};
  grid.info.inside_value = inside_value;
  const auto index = [&](Vec3i p) {
    const Vec3i q = p - lower;
    return (static_cast<size_t>(q.x) * static_cast<size_t>(points.y) + static_cast<size_t>(q.y)) *
               static_cast<size_t>(points.z) +
           static_cast<size_t>(q.z);
  };
  const size_t n = static_cast<size_t>(points.x) * static_cast<size_t>(points.y) * static_cast<size_t>(points.z);
  std::vector<float> value(n);
  std::vector<bool> active(n, false);
  Vec3i p;
  for (p.x = lower.x; p.x < lower.x + points.x; ++p.x)
    for (p.y = lower.y; p.y < lower.y + points.y; ++p.y)
      for (p.z = lower.z; p.z < lower.z + points.z; ++p.z)
        value[index(p)] = static_cast<float>(f(grid.frame.position(p)));
  for (p.x = lower.x; p.x + 1 < lower.x + points.x; ++p.x)
    for (p.y = lower.y; p.y + 1 < lower.y + points.y; ++p.y)
      for (p.z = lower.z; p.z + 1 < lower.z + points.z; ++p.z) {
        float least = 1e30f, most = -1e30f;
        for (int c = 0; c < 8; ++c) {
          const float v = value[index(p + Vec3i{c & 1, c >> 1 & 1, c >> 2})];
          least = std::min(least, v);
          most = std::max(most, v);
        }
        if (most < grid.info.band_lower || least > grid.info.band_upper)
          continue;
        for (int c = 0; c < 8; ++c)
          active[index(p + Vec3i{c & 1, c >> 1 & 1, c >> 2})] = true;
      }
  struct Block {
    std::vector<float> value;
    uint64_t active[8] = {};
    bool any = false, all_inside = true;
  };
  std::map<Vec3i, Block> blocks;
  for (p.x = lower.x & ~7; p.x < lower.x + points.x; ++p.x)
    for (p.y = lower.y & ~7; p.y < lower.y + points.y; ++p.y)
      for (p.z = lower.z & ~7; p.z < lower.z + points.z; ++p.z) {
        Block& b = blocks[block_corner(p)];
        if (b.value.empty())
          b.value.assign(512, 0.0f);
        const Vec3i q = p - lower;
        if (q.x < 0 || q.y < 0 || q.z < 0) {
          b.all_inside = false;
          continue;
        }
        const bool in = value[index(p)] > 1;
        b.value[slot(p)] = active[index(p)] ? value[index(p)] : in ? static_cast<float>(inside_value) : 0.0f;
        b.all_inside = b.all_inside && in;
        if (!active[index(p)])
          continue;
        b.any = true;
        b.active[slot(p) >> 6] |= uint64_t{1} << (slot(p) & 63);
      }
  for (auto& [corner, b] : blocks) {
    if (b.any) {
      grid.corner.push_back(corner);
      grid.value.insert(grid.value.end(), b.value.begin(), b.value.end());
      grid.active.insert(grid.active.end(), b.active, b.active + 8);
    } else if (b.all_inside) {
      grid.inside.push_back(corner);
    }
  }
  return grid;
}

/// G of one atom of radius 3 Å, κ = 0.3.
inline double atom(Vec3d x) {
  return std::exp(-0.3 * (norm2(x) - 9));
}

/// The cube of points from about -half to half on each axis.
inline BlockGrid cube_grid(double half, double h, const std::function<double(Vec3d)>& f) {
  const int n = static_cast<int>(std::ceil(half / h));
  return sample_grid({-n, -n, -n}, {2 * n + 1, 2 * n + 1, 2 * n + 1}, h, 2, f);
}

/// A small grid of rough or smooth noise, rough with values exactly at the isovalue among them or without, by turns
/// of `trial`; the border is outside.
inline BlockGrid random_grid(std::mt19937_64& random, int trial) {
  std::uniform_real_distribution<double> u(0, 2);
  const int n = 4 + trial % 4;
  const bool ties = trial % 4 == 0, smooth = trial % 3 == 1;
  std::vector<Vec3d> centre;
  for (int i = 0; i < 8; ++i)
    centre.push_back({u(random) * 3 - 3, u(random) * 3 - 3, u(random) * 3 - 3});
  return sample_grid({-n, -n, -n}, {2 * n + 1, 2 * n + 1, 2 * n + 1}, 1, 3, [&](Vec3d x) {
    if (std::max({std::fabs(x.x), std::fabs(x.y), std::fabs(x.z)}) > n - 1.5)
      return 0.1;
    if (!smooth)
      return ties ? std::floor(2 * u(random)) / 2 + 0.5 : u(random);
    double sum = 0;
    for (const Vec3d& c : centre)
      sum += std::exp(0.3 - 0.5 * norm2(x - c));
    return sum;
  });
}

/// Balls of radius 1.7 at random places, with sharp creases between them: merged cells lie across these.
inline BlockGrid creased_grid(unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(-4, 4);
  std::vector<Vec3d> centre;
  for (int i = 0; i < 32; ++i)
    centre.push_back({u(random), u(random), u(random)});
  return cube_grid(7.5, 0.24, [&](Vec3d x) {
    double sum = 0;
    for (const Vec3d& c : centre)
      sum += std::exp(-2 * (norm2(x - c) - 1.7 * 1.7));
    return sum;
  });
}

} // namespace molmesh::test
