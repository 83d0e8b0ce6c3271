// quality.cpp — measures all tetrahedra in one pass and merges the chunks in order.
#include "mesh/quality.hpp"
#include "geom/tet_measures.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <map>

namespace molmesh {
namespace {

struct Sum : Distribution {
  double sum = 0;
  int64_t count = 0;
  Sum(double first, double step, size_t bins) {
    low = first;
    width = step;
    bin.assign(bins, 0);
  }
  void add(double v, int64_t tet) {
    if (count == 0 || v < min)
      min = v, min_tet = tet;
    if (count == 0 || v > max)
      max = v, max_tet = tet;
    sum += v;
    ++count;
    constexpr double rounding = 1e-9; // of a bin: 60° of a lattice are 60°
    const double place = (v - low) / width + rounding;
    ++bin[place < 1 ? 0 : place < double(bin.size()) ? static_cast<size_t>(place) : bin.size() - 1];
  }
  void add(const Sum& later) {
    if (later.count == 0)
      return;
    if (count == 0 || later.min < min)
      min = later.min, min_tet = later.min_tet;
    if (count == 0 || later.max > max)
      max = later.max, max_tet = later.max_tet;
    sum += later.sum;
    count += later.count;
    for (size_t i = 0; i < bin.size(); ++i)
      bin[i] += later.bin[i];
  }
  Distribution done() const {
    Distribution d = *this;
    d.mean = count > 0 ? sum / double(count) : 0;
    return d;
  }
};

struct Sums {
  int64_t tets = 0, outside = 0;
  Sum dihedral{0, 5, 36}, q{0, 0.05, 20}, eta{0, 0.05, 20}, ratio{1, 0.5, 20};

  void add(Vec3d a, Vec3d b, Vec3d c, Vec3d d, int64_t tet, AngleLimits limits) {
    ++tets;
    const Dihedrals angles = dihedrals(a, b, c, d);
    bool beyond = false;
    for (int e = 0; e < 6; ++e) {
      double degree = angles.degree[e];
      if (degree != degree)
        degree = e % 2 * 180.0; // flat: half are 0, half are 180
      beyond |= !limits.hold(degree);
      dihedral.add(degree, tet);
    }
    outside += beyond;
    const double sum2 = edge_sum2(a, b, c, d), joe_liu = sum2 > 0 ? joe_liu_q(six_volume(a, b, c, d), sum2) : 0;
    q.add(joe_liu, tet);
    eta.add(joe_liu_eta(joe_liu), tet);
    const double r = edge_ratio(a, b, c, d);
    ratio.add(r == r ? r : HUGE_VAL, tet);
  }
  void add(const Sums& later) {
    tets += later.tets;
    outside += later.outside;
    dihedral.add(later.dihedral);
    q.add(later.q);
    eta.add(later.eta);
    ratio.add(later.ratio);
  }
  Quality done() const { return {tets, outside, dihedral.done(), q.done(), eta.done(), ratio.done()}; }
};

using ByRegion = std::map<int32_t, Sums>;

} // namespace

MeshQuality measure_quality(const TetMesh& m, int threads, AngleLimits limits) {
  constexpr int64_t chunk = 1 << 14;
  const auto tets = static_cast<int64_t>(m.tet.size()), chunks = (tets + chunk - 1) / chunk;
  // Some chunks at a time: each of many regions has its sums in each chunk.
  const int64_t at_a_time = std::min<int64_t>(chunks, 4 * std::max(threads, 1));
  std::vector<ByRegion> part(static_cast<size_t>(at_a_time));
  ByRegion regions;
  for (int64_t first = 0; first < chunks; first += at_a_time) {
    const int64_t n = std::min(at_a_time, chunks - first);
    par::for_n(n, threads, 1, [&](int64_t slot) {
      ByRegion& mine = part[slot];
      const int64_t c = first + slot;
      mine.clear();
      for (int64_t i = c * chunk; i < std::min(tets, (c + 1) * chunk); ++i) {
        const Tet& t = m.tet[i];
        const auto p = [&](size_t k) { return m.point[t[k]]; };
        mine[m.region[i]].add(p(0), p(1), p(2), p(3), i, limits);
      }
    });
    for (int64_t slot = 0; slot < n; ++slot)
      for (const auto& [region, sums] : part[slot])
        regions[region].add(sums);
  }
  MeshQuality quality;
  Sums all;
  for (const auto& [region, sums] : regions) {
    quality.region.push_back(region);
    quality.of.push_back(sums.done());
    all.add(sums);
  }
  quality.all = all.done();
  return quality;
}

} // namespace molmesh
