// equal_shares.cpp — blocks near an interface and the ratio of the shares at their points.
#include "label/equal_shares.hpp"
#include "label/divide.hpp"
#include "mesh/region_order.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::label {

BlockGrid share_ratio(const ShareFinder& shares, int32_t first, int32_t second, const GridFrame& frame,
                      const std::vector<Vec3d>& near, double around, int threads) {
  constexpr double most = 30; // ln: what a float holds well
  BlockGrid grid;
  grid.frame = frame;
  grid.info.isovalue = 1;
  for (const Vec3d& p : near) {
    const Vec3d u = (p - frame.origin) / frame.spacing;
    Vec3i low, high;
    for (int a = 0; a < 3; ++a) {
      low[a] = static_cast<int32_t>(std::floor(u[a] - around / frame.spacing)) & ~7;
      high[a] = static_cast<int32_t>(std::ceil(u[a] + around / frame.spacing)) & ~7;
    }
    for (int x = low.x; x <= high.x; x += 8)
      for (int y = low.y; y <= high.y; y += 8)
        for (int z = low.z; z <= high.z; z += 8)
          grid.corner.push_back({x, y, z});
  }
  const auto key = [](const Vec3i& c) { return std::array{c.x, c.y, c.z}; };
  std::sort(grid.corner.begin(), grid.corner.end(),
            [&](const Vec3i& a, const Vec3i& b) { return key(a) < key(b); });
  grid.corner.erase(std::unique(grid.corner.begin(), grid.corner.end()), grid.corner.end());
  const size_t blocks = grid.corner.size();
  grid.value.resize(512 * blocks, 0);
  grid.active.resize(8 * blocks, 0);
  constexpr size_t run = 256; // blocks at a time: places take more memory than values
  for (size_t begin = 0; begin < blocks; begin += run) {
    const size_t n = std::min(run, blocks - begin);
    std::vector<Vec3d> place(512 * n);
    for (size_t i = 0; i < place.size(); ++i)
      place[i] = frame.position(grid.corner[begin + i / 512] + within_block(static_cast<int>(i % 512)));
    const std::vector<Shares> at = shares.at(place);
    par::for_n(static_cast<int64_t>(8 * n), threads, [&](int64_t w) {
      uint64_t word = 0;
      for (size_t b = 0; b < 64; ++b) {
        const size_t i = 64 * static_cast<size_t>(w) + b;
        const double f = at[i].ln_of(first), s = at[i].ln_of(second);
        if (f > Shares::none && s > Shares::none) {
          word |= uint64_t{1} << b;
          grid.value[512 * begin + i] = static_cast<float>(std::exp(std::clamp(f - s, -most, most)));
        }
      }
      grid.active[8 * begin + static_cast<size_t>(w)] = word;
    });
  }
  return grid;
}

std::map<int32_t, Interface> interfaces_of(const TetMesh& m) {
  const RegionOrder order(m);
  std::map<int32_t, Interface> all;
  std::map<std::array<int32_t, 3>, int32_t> first; // a triangle of each label
  std::vector<uint8_t> marked(m.point.size(), 0);
  std::map<int32_t, std::vector<int32_t>> vertex;
  for (size_t t = 0; t < m.tri.size() && order.last_domain > Region::cavity; ++t) {
    const int32_t label = m.boundary[t];
    if (label <= Boundary::box_z1)
      continue;
    if (vertex.find(label) == vertex.end()) {
      std::array<int32_t, 3> k = m.tri[t];
      std::sort(k.begin(), k.end());
      first[k] = label;
      for (const int32_t v : k)
        marked[v] = 1;
    }
    vertex[label].insert(vertex[label].end(), m.tri[t].begin(), m.tri[t].end());
  }
  for (auto& [label, list] : vertex) {
    par::sort_unique(list, 1);
    Interface& i = all[label];
    i.group = {INT32_MAX, -1};
    for (const int32_t v : list)
      i.point.push_back(m.point[v]);
  }
  for (size_t t = 0; t < m.tet.size() && !first.empty(); ++t) {
    const Tet& v = m.tet[t];
    if (marked[v[0]] + marked[v[1]] + marked[v[2]] + marked[v[3]] < 3)
      continue;
    for (size_t f = 0; f < 4; ++f) {
      std::array<int32_t, 3> k{v[(f + 1) % 4], v[(f + 2) % 4], v[(f + 3) % 4]};
      std::sort(k.begin(), k.end());
      if (const auto at = first.find(k); at != first.end()) {
        auto& group = all[at->second].group;
        group[0] = std::min(group[0], m.region[t] - first_domain);
        group[1] = std::max(group[1], m.region[t] - first_domain);
      }
    }
  }
  return all;
}

namespace {

GridFrame halved(GridFrame frame) {
  frame.spacing /= 2;
  return frame;
}

} // namespace

EqualShares::EqualShares(const ShareFinder& shares, const Interface& i, const GridFrame& frame, int threads)
    : surface_(share_ratio(shares, i.group[0], i.group[1], halved(frame), i.point, 2.5 * frame.spacing, threads),
               threads),
      spacing_(frame.spacing) {}

} // namespace molmesh::label
