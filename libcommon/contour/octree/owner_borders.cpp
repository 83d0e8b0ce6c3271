// owner_borders.cpp — halves nodes in which several domains own the inside, level by level.
#include "contour/octree/owner_borders.hpp"
#include "geom/morton.hpp"
#include <algorithm>
#include <map>

namespace molmesh::contour {
namespace {

constexpr int start_level = 4;
constexpr size_t samples = 9; // corners and middle
constexpr double wide = 0.5;  // of what leads vary by: linear ones would need none

Vec3d sample(const LatticeView& l, Vec3i low, int edge, size_t k) {
  const double half = 0.5 * edge;
  Vec3d p = to_double(low);
  for (int a = 0; a < 3; ++a) {
    p[a] += k == 8 ? half : (k >> a & 1) * edge;
    p[a] = std::min(p[a], double(l.cells[a]));
  }
  return l.between(p);
}

bool is_divided(const Owner* at) {
  double least = at[0].lead, most = least;
  for (size_t k = 1; k < samples; ++k) {
    if (at[k].owner != at[0].owner)
      return true;
    least = std::min(least, at[k].lead);
    most = std::max(most, at[k].lead);
  }
  return least < wide * (most - least);
}

bool any_inside(const LatticeView& l, Vec3i low) {
  for (int k = 0; k < 27; ++k) {
    const Vec3i p = low + Vec3i{k / 9, k / 3 % 3, k % 3};
    if (p.x <= l.cells.x && p.y <= l.cells.y && p.z <= l.cells.z && l.value(p) > l.isovalue)
      return true;
  }
  return false;
}

} // namespace

std::vector<par::KeyedWord> owner_borders(const Lattice& lattice, const FindOwners& owners) {
  const LatticeView& l = lattice.view();
  std::vector<Vec3i> node; // lower corners
  const int first = std::max(1, std::min(start_level, lattice.top_level));
  Vec3i low, high;
  for (int a = 0; a < 3; ++a) {
    low[a] = std::max(0, l.grid_first[a]) >> first;
    high[a] = (std::min(l.cells[a], l.grid_last[a]) - 1) >> first;
  }
  for (int x = low.x; x <= high.x; ++x)
    for (int y = low.y; y <= high.y; ++y)
      for (int z = low.z; z <= high.z; ++z)
        node.push_back(Vec3i{x, y, z} * (1 << first));
  for (int level = first;; --level) {
    const int edge = 1 << level;
    std::vector<Vec3d> place;
    for (const Vec3i& n : node)
      for (size_t k = 0; k < samples; ++k)
        place.push_back(sample(l, n, edge, k));
    const std::vector<Owner> at = owners(place);
    std::vector<Vec3i> divided;
    for (size_t i = 0; i < node.size(); ++i)
      if (is_divided(&at[samples * i]))
        divided.push_back(node[i]);
    node.clear();
    if (level == 1) {
      node = std::move(divided);
      break;
    }
    for (const Vec3i& n : divided)
      for (int k = 0; k < 8; ++k) {
        const Vec3i child = n + Vec3i{k & 1, k >> 1 & 1, k >> 2} * (edge / 2);
        if (child.x < l.cells.x && child.y < l.cells.y && child.z < l.cells.z)
          node.push_back(child);
      }
  }
  std::map<uint64_t, uint64_t> words;
  for (const Vec3i& n : node)
    if (any_inside(l, n)) {
      const uint64_t key = morton(Vec3i{n.x / 2, n.y / 2, n.z / 2});
      words[key >> 6] |= uint64_t{1} << (key & 63);
    }
  std::vector<par::KeyedWord> out;
  for (const auto& [key, word] : words)
    out.push_back({key, word});
  return out;
}

} // namespace molmesh::contour
