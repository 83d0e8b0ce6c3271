// isosurface.cpp — computes log G of the active points.
#include "isosurface/isosurface.hpp"
#include "isosurface/logs_simd.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <vector>

namespace molmesh {

Isosurface::Isosurface(const BlockGrid& grid, int threads)
    : frame_(grid.frame), index_(grid), log_(grid.value.size()) {
  par::for_n(static_cast<int64_t>(grid.active.size()), threads, 64, [&](int64_t w) {
    log_ratios(grid.value.data() + 64 * w, grid.active[w], grid.info.isovalue, log_.data() + 64 * w);
  });
}

bool Isosurface::project_in_plane(Vec3d& p, int axis, double reach) const {
  constexpr double flattest = 0.2; // share of the normal in the plane: below it steps lead far away
  const Vec3d from = p;
  double distance;
  Vec3d normal;
  for (int step = 0; step < 8; ++step) {
    if (!probe(p, distance, normal))
      return false;
    if (std::abs(distance) < 1e-3 * spacing())
      return norm2(p - from) <= reach * reach;
    normal[axis] = 0;
    const double share = norm(normal);
    if (share < flattest || std::abs(distance) > reach * share)
      return false;
    p -= distance / (share * share) * normal;
  }
  return false;
}

bool Isosurface::pocket(Vec3d p, bool hole, Vec3d& inside) const {
  constexpr size_t most = 4;
  Vec3d u;
  Vec3i c;
  if (!view().locate(p, u, c))
    return false;
  const auto is_inside = [&](Vec3i g) { // the piece
    const int64_t b = index_.find(g);
    return b >= 0 && std::isfinite(log_[512 * b + slot(g)]) && (log_[512 * b + slot(g)] > 0) != hole;
  };
  double nearest = 1.7; // spacings
  bool found = false;
  for (int k = 0; k < 64; ++k) {
    const Vec3i g = c + Vec3i{k / 16 - 1, k / 4 % 4 - 1, k % 4 - 1};
    const double distance = norm(to_double(g) - u);
    if (distance >= nearest || !is_inside(g))
      continue;
    std::vector<Vec3i> piece{g};
    for (size_t i = 0; i < piece.size() && piece.size() <= most; ++i)
      for (int a = 0; a < 6; ++a) {
        Vec3i beside = piece[i];
        beside[a / 2] += a % 2 ? 1 : -1;
        if (is_inside(beside) && std::find(piece.begin(), piece.end(), beside) == piece.end())
          piece.push_back(beside);
      }
    if (piece.size() <= most)
      nearest = distance, inside = frame_.position(g), found = true;
  }
  return found;
}

} // namespace molmesh
