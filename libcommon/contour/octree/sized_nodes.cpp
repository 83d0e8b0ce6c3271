// sized_nodes.cpp — looks at the nodes round each ball.
#include "contour/octree/sized_nodes.hpp"
#include "geom/morton.hpp"
#include <algorithm>
#include <unordered_map>

namespace molmesh::contour {
namespace {

using Words = std::unordered_map<uint64_t, uint64_t>; // of 4³ nodes

void add(Words& words, Vec3i node) {
  const uint64_t key = morton(node);
  words[key >> 6] |= uint64_t{1} << (key & 63);
}

/// The cell of the axis that x lies in, the first or last where it lies beyond.
int32_t cell_at(const LatticeView& l, int axis, double x) {
  const double* const first = l.axis[axis];
  const auto after = std::upper_bound(first, first + l.cells[axis] + 1, x) - first;
  return static_cast<int32_t>(std::clamp<int64_t>(after - 1, 0, int64_t{l.cells[axis]} - 1));
}

/// Calls take(node, low, high) for the nodes of the level that may meet the ball.
template <class Take>
void nodes_near(const LatticeView& l, const SizeBall& ball, int level, Take take) {
  Vec3i first, last;
  for (int a = 0; a < 3; ++a) {
    first[a] = cell_at(l, a, ball.center[a] - ball.radius) >> level;
    last[a] = cell_at(l, a, ball.center[a] + ball.radius) >> level;
  }
  const int32_t edge = 1 << level;
  Vec3i n;
  for (n.x = first.x; n.x <= last.x; ++n.x)
    for (n.y = first.y; n.y <= last.y; ++n.y)
      for (n.z = first.z; n.z <= last.z; ++n.z) {
        const Vec3i low = edge * n;
        Vec3i high = low + Vec3i{edge, edge, edge};
        for (int a = 0; a < 3; ++a)
          high[a] = std::min(high[a], l.cells[a]);
        take(n, l.position(low), l.position(high));
      }
}

std::vector<par::KeyedWord> ascending(const Words& words) {
  std::vector<par::KeyedWord> all;
  for (const auto& [key, word] : words)
    all.push_back({key, word});
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
  return all;
}

} // namespace

std::vector<par::KeyedWord> united(const std::vector<par::KeyedWord>& a, const std::vector<par::KeyedWord>& b) {
  Words words;
  for (const auto* set : {&a, &b})
    for (const par::KeyedWord& w : *set)
      words[w.key] |= w.word;
  return ascending(words);
}

SizedNodes sized_nodes(const LatticeView& l, const std::vector<SizeBall>& balls) {
  constexpr int most_level = 20;
  std::vector<Words> divided(most_level), loose(most_merges);
  for (const SizeBall& ball : balls) {
    const auto allowed = [&](int level) { return double(1 << level) * l.spacing <= ball.size * (1 + 1e-9); };
    for (int level = 1; level <= most_merges && allowed(level); ++level)
      nodes_near(l, ball, level, [&](Vec3i n, Vec3d low, Vec3d high) {
        if (norm2(0.5 * (low + high) - ball.center) <= ball.radius * ball.radius)
          add(loose[static_cast<size_t>(level) - 1], n);
      });
    int level = 1;
    while (level < most_level && allowed(level))
      ++level;
    nodes_near(l, ball, level, [&](Vec3i n, Vec3d low, Vec3d high) {
      Vec3d nearest = ball.center;
      for (int a = 0; a < 3; ++a)
        nearest[a] = std::clamp(nearest[a], low[a], high[a]);
      if (norm2(nearest - ball.center) < ball.radius * ball.radius)
        add(divided[static_cast<size_t>(level) - 1], n);
    });
  }
  SizedNodes nodes;
  for (const Words& words : divided)
    nodes.divided.push_back(ascending(words));
  for (const Words& words : loose)
    nodes.loose.push_back(ascending(words));
  return nodes;
}

} // namespace molmesh::contour
