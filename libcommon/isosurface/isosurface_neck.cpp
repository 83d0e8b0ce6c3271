// isosurface_neck.cpp — finds where inside or outside is narrowest near a place: the saddle of log G between two
// lobes.
#include "isosurface/isosurface.hpp"
#include <algorithm>
#include <array>
#include <numeric>

namespace molmesh {
namespace {

constexpr int half = 8, wide = 2 * half + 1, count = wide * wide * wide; // samples of a cube

// Samples come in from the deepest on and join those beside them. Where two lobes meet there is a neck; of those
// that are narrow, the one that parts the deepest lobes counts.
struct Lobes {
  std::array<double, count> depth;
  std::array<int, count> root, order;

  int find(int k) {
    while (root[k] != k)
      k = root[k] = root[root[k]];
    return k;
  }
  bool deeper(int a, int b) const { return depth[a] != depth[b] ? depth[a] > depth[b] : a < b; }
  /// The sample at the neck and the deepest ones of its lobes; -1: none. Necks are looked for between two depths.
  std::array<int, 3> neck(double narrow, double least) {
    std::array<int, 3> best{-1, -1, -1};
    double most = 0;
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int a, int b) { return deeper(a, b); });
    root.fill(-1);
    for (const int k : order) {
      const double here = depth[k];
      if (here < least)
        break;
      root[k] = k;
      for (int d = 0; d < 27; ++d) {
        const int x = k / (wide * wide) + d / 9 - 1, y = k / wide % wide + d / 3 % 3 - 1, z = k % wide + d % 3 - 1;
        const int beside = (x * wide + y) * wide + z;
        if (std::min({x, y, z}) < 0 || std::max({x, y, z}) >= wide || root[beside] < 0)
          continue;
        const int a = find(k), b = find(beside);
        if (a == b)
          continue;
        const double parted = std::min(depth[a], depth[b]) - here;
        if (parted > most && here < narrow)
          most = parted, best = {k, a, b};
        root[deeper(a, b) ? b : a] = deeper(a, b) ? a : b;
      }
    }
    return best;
  }
};

} // namespace

bool Isosurface::neck(Vec3d p, Neck& neck) const {
  Lobes lobes;
  Vec3d u, gradient;
  Vec3i next;
  double f;
  const double h = frame_.spacing;
  if (!evaluate(p, f, gradient) || !view().locate(p + Vec3d{h / 2, h / 2, h / 2}, u, next))
    return false;
  // In spacings about half the neck's width; negative where the isosurface is not quite open there.
  const double side = f > 0 ? -1 : 1, narrow = 0.15 * h * norm(gradient), least = -0.03 * h * norm(gradient);
  const auto look = [&](Vec3d centre, double step) {
    const auto place = [&](int k) {
      const Vec3i at{k / (wide * wide) - half, k / wide % wide - half, k % wide - half};
      return centre + step * to_double(at);
    };
    for (int k = 0; k < count; ++k)
      lobes.depth[k] = evaluate(place(k), f, gradient) ? side * f : -1e30;
    const auto [k, a, b] = lobes.neck(narrow, least);
    if (k >= 0)
      neck = {place(k), (place(a) - place(b)) / norm(place(a) - place(b))};
    return k >= 0;
  };
  for (const double step : {h / 8, h / 4})
    if (look(frame_.position(next), step)) {
      if (look(neck.at, step / 8))
        look(neck.at, step / 64);
      return true;
    }
  return false;
}

} // namespace molmesh
