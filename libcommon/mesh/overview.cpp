// overview.cpp — one pass over elements and triangles; sums are added up chunk by chunk, in order.
#include "mesh/overview.hpp"
#include "geom/tet_measures.hpp"
#include "mesh/region_order.hpp"
#include "par/par.hpp"
#include <cmath>

namespace molmesh {
namespace {

constexpr int64_t chunk = 1 << 14;

/// Sums of f(i, sum) over each chunk of [0, n), in order.
template <class Sum, class F>
std::vector<Sum> sums_of_chunks(int64_t n, int threads, F&& f) {
  std::vector<Sum> sums(static_cast<size_t>((n + chunk - 1) / chunk));
  par::for_n(static_cast<int64_t>(sums.size()), threads, 1, [&](int64_t c) {
    for (int64_t i = c * chunk; i < std::min(n, (c + 1) * chunk); ++i)
      f(i, sums[c]);
  });
  return sums;
}

/// Cosines with their sign kept and squared, which are in the same order: no root and no arc for each angle.
struct Elements {
  double least = 1, most = -1, volume = 0;
};

double degrees(double signed_square) {
  return std::acos(std::copysign(std::sqrt(std::fabs(signed_square)), signed_square)) * 180 / M_PI;
}

} // namespace

Overview overview(const TetMesh& m, int threads) {
  const RegionOrder order(m);
  const auto elements =
      sums_of_chunks<Elements>(static_cast<int64_t>(m.tet.size()), threads, [&](int64_t i, Elements& sum) {
        const Tet& t = m.tet[i];
        const Vec3d a = m.point[t[0]], ab = m.point[t[1]] - a, ac = m.point[t[2]] - a, ad = m.point[t[3]] - a;
        const Vec3d bc = ac - ab, bd = ad - ab;
        const Vec3d n[4] = {cross(bc, bd), cross(ad, ac), cross(ab, ad), cross(ac, ab)}; // outward
        const double square[4] = {norm2(n[0]), norm2(n[1]), norm2(n[2]), norm2(n[3])};
        for (int f = 0; f < 4; ++f)
          for (int g = f + 1; g < 4; ++g) {
            const double c = -dot(n[f], n[g]), signed_square = c * std::fabs(c) / (square[f] * square[g]);
            sum.least = std::min(sum.least, signed_square);
            sum.most = std::max(sum.most, signed_square);
          }
        if (order.is_inside(m.region[i]))
          sum.volume -= dot(n[3], ad) / 6;
      });
  const auto areas =
      sums_of_chunks<double>(static_cast<int64_t>(m.tri.size()), threads, [&](int64_t i, double& sum) {
        const Tri& t = m.tri[i];
        if (m.boundary[i] == Boundary::surface)
          sum += tri_area(m.point[t[0]], m.point[t[1]], m.point[t[2]]);
      });
  Overview all;
  Elements extremes;
  for (const Elements& e : elements) {
    extremes.least = std::min(extremes.least, e.least);
    extremes.most = std::max(extremes.most, e.most);
    all.volume += e.volume;
  }
  for (const double area : areas)
    all.area += area;
  if (!m.tet.empty()) {
    all.least_angle = degrees(extremes.most);
    all.largest_angle = degrees(extremes.least);
  }
  return all;
}

} // namespace molmesh
