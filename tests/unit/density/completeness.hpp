// completeness.hpp — a sparse density grid against the field summed by brute force: I1 to I3.
#pragma once
#include "density/density.hpp"
#include "unit/density/oracle.hpp"
#include <algorithm>
#include <catch2/catch.hpp>

namespace molmesh::test {

inline BlockGrid compute(const Hierarchy& h, const density::Options& o) {
  density::Counts counts;
  return to_block_grid(density::compute(h, o, counts), 1);
}

/// Where all atoms of a crowd count.
inline density::Options around_a_crowd(double tolerance, double spacing = 1.5) {
  density::Options o;
  o.spacing = spacing;
  o.tolerance = tolerance;
  o.isovalue = 1000;
  o.band_lower = 900;
  o.band_upper = 1100;
  return o;
}

/// Worst |G_file - G| over ε·max(1, G) on a sample of the active points.
inline double worst_error(const Hierarchy& h, const BlockGrid& g, int samples) {
  std::mt19937 random(5);
  double worst = 0;
  for (int n = 0; n < samples;) {
    const size_t b = random() % g.corner.size();
    const int s = static_cast<int>(random() % 512);
    if (!(g.active[8 * b + static_cast<size_t>(s >> 6)] >> (s & 63) & 1))
      continue;
    const Vec3i p = g.corner[b] + within_block(s);
    const double exact = exact_density(h, g.info.decay, g.frame.position(p));
    worst = std::max(worst, std::abs(g.value[512 * b + static_cast<size_t>(s)] - exact) /
                                (g.info.tolerance * std::max(1.0, exact)));
    ++n;
  }
  return worst;
}

/// Every point of the grid by brute force: active exactly on the corners of band cells, the right side elsewhere.
/// Points within the tolerance of a limit may fall on either side of it.
inline void check_complete(const Hierarchy& h, const BlockGrid& g) {
  const Vec3i n = g.frame.points;
  const auto at = [&](int x, int y, int z) {
    return (size_t(x) * size_t(n.y) + size_t(y)) * size_t(n.z) + size_t(z);
  };
  std::vector<double> G(size_t(n.x) * size_t(n.y) * size_t(n.z));
  for (int x = 0; x < n.x; ++x)
    for (int y = 0; y < n.y; ++y)
      for (int z = 0; z < n.z; ++z)
        G[at(x, y, z)] = exact_density(h, g.info.decay, g.frame.position(g.frame.lower + Vec3i{x, y, z}));
  const double slack = g.info.tolerance * std::max(1.0, g.info.band_upper);
  std::vector<char> surely(G.size()), maybe(G.size());
  for (int x = 0; x + 1 < n.x; ++x)
    for (int y = 0; y + 1 < n.y; ++y)
      for (int z = 0; z + 1 < n.z; ++z) {
        double lo = 1e300, hi = 0;
        for (int c = 0; c < 8; ++c) {
          const double v = G[at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2))];
          lo = std::min(lo, v);
          hi = std::max(hi, v);
        }
        for (int c = 0; c < 8; ++c) {
          const size_t p = at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
          surely[p] |= lo <= g.info.band_upper - slack && hi >= g.info.band_lower + slack;
          maybe[p] |= lo <= g.info.band_upper + slack && hi >= g.info.band_lower - slack;
        }
      }
  const BlockIndex index(g);
  int64_t missed = 0, extra = 0, wrong_side = 0, wrong_value = 0;
  for (int x = 0; x < n.x; ++x)
    for (int y = 0; y < n.y; ++y)
      for (int z = 0; z < n.z; ++z) {
        const Vec3i p = g.frame.lower + Vec3i{x, y, z};
        const double exact = G[at(x, y, z)], v = value_at(g, index, p);
        if (is_active(g, index, p)) {
          extra += !maybe[at(x, y, z)];
          wrong_value += std::abs(v - exact) > g.info.tolerance * std::max(1.0, exact);
        } else {
          missed += surely[at(x, y, z)];
          wrong_side += v != (exact > g.info.isovalue ? g.info.inside_value : 0.0);
        }
      }
  CHECK(missed == 0);
  CHECK(extra == 0);
  CHECK(wrong_side == 0);
  CHECK(wrong_value == 0);
}

/// The same contents to the last bit (I4).
inline void check_equal(const BlockGrid& a, const BlockGrid& b) {
  CHECK(a.corner == b.corner);
  CHECK(a.value == b.value);
  CHECK(a.active == b.active);
  CHECK(a.inside == b.inside);
}

} // namespace molmesh::test
