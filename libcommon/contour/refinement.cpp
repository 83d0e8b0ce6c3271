// refinement.cpp — level by level from the finest: what the surface asks for, and what follows from that.
#include "contour/refinement.hpp"
#include "contour/merging.hpp"
#include "geom/morton.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::contour {
namespace {

/// Of the surface's middle from a face with smaller cells behind, in the node's edge length: seen from nearer,
/// those cells' faces are aslant, and their elements flat.
constexpr double least_margin = 0.2;

/// All nodes of level 1 in the grid whose cells are to be fine in a uniform mesh.
void append_uniform(const Lattice& lattice, const RefineOptions& options, std::vector<uint64_t>& nodes) {
  const GridFrame& frame = lattice.grid().frame;
  const Vec3i cells = lattice.cells, base = lattice.base();
  Vec3i lower, upper; // nodes
  for (int a = 0; a < 3; ++a) {
    lower[a] = std::max(0, frame.lower[a] - base[a]) >> 1;
    upper[a] = std::min(cells[a], frame.lower[a] + frame.points[a] - 1 - base[a]);
    upper[a] = (upper[a] + 1) >> 1;
  }
  Vec3i p;
  for (p.x = lower.x; p.x < upper.x; ++p.x)
    for (p.y = lower.y; p.y < upper.y; ++p.y)
      for (p.z = lower.z; p.z < upper.z; ++p.z) {
        bool wanted = false;
        for (int n = 0; n < 27 && !wanted; ++n) {
          const Vec3i q = 2 * p + Vec3i{n % 3, n / 3 % 3, n / 9};
          if (q.x > cells.x || q.y > cells.y || q.z > cells.z)
            continue;
          wanted = lattice.inside(q) ? options.inside : options.outside;
        }
        if (wanted)
          nodes.push_back(morton(p));
      }
}

/// Bit f: the middle of the samples is near face f of the node.
uint8_t near_faces(const SurfaceSample* begin, const SurfaceSample* end, Vec3i corner, int32_t extent) {
  Vec3d mean;
  for (const SurfaceSample* s = begin; s < end; ++s)
    mean += s->point;
  mean = mean / double(end - begin);
  uint8_t faces = 0;
  for (int a = 0; a < 3; ++a) {
    const double share = (mean[a] - corner[a]) / extent;
    faces =
        static_cast<uint8_t>(faces | (share < least_margin) << 2 * a | (share > 1 - least_margin) << (2 * a + 1));
  }
  return faces;
}

} // namespace

Refinement::Refinement(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                       const std::vector<SurfaceSample>& samples, const RefineOptions& options, int threads)
    : lattice_(lattice), cells_(cells), samples_(samples), options_(options), threads_(threads),
      merged_(merge_levels(lattice, cells, samples, options.adapt, threads)) {}

void Refinement::operator()(int level, std::vector<uint64_t>& nodes) const {
  const std::vector<int64_t> begin = node_ranges(cells_, level);
  for (size_t k = 0; k + 1 < begin.size(); ++k)
    if (merged_[static_cast<size_t>(begin[k])] < level)
      nodes.push_back(cells_[static_cast<size_t>(begin[k])].key >> 3 * level);
  if (options_.adapt > 0)
    spread(level, begin, nodes);
  else if (level == 1)
    append_uniform(lattice_, options_, nodes);
}

void Refinement::spread(int level, const std::vector<int64_t>& begin, std::vector<uint64_t>& nodes) const {
  struct Surface {
    uint64_t key;
    uint8_t near; ///< near_faces; none once the node has children
  };
  std::vector<Surface> node(begin.size() - 1);
  par::for_n(static_cast<int64_t>(node.size()), threads_, 64, [&](int64_t k) {
    const auto b = static_cast<size_t>(begin[static_cast<size_t>(k)]),
               e = static_cast<size_t>(begin[static_cast<size_t>(k) + 1]);
    const uint64_t key = cells_[b].key >> 3 * level;
    const bool one = merged_[b] >= level;
    node[static_cast<size_t>(k)] = {
        key, one ? near_faces(&samples_[b], &samples_[b] + (e - b), morton_point(key << 3 * level), 1 << level)
                 : uint8_t{0}};
  });
  for (size_t done = 0; done < nodes.size(); ++done) {
    const Vec3i p = morton_point(nodes[done]);
    for (int f = 0; f < 6; ++f) {
      Vec3i q = p;
      q[f / 2] += f % 2 ? 1 : -1;
      if (q[f / 2] < 0)
        continue;
      const uint64_t key = morton(q);
      const auto it =
          std::lower_bound(node.begin(), node.end(), key, [](const Surface& s, uint64_t k) { return s.key < k; });
      if (it == node.end() || it->key != key || !(it->near >> (f ^ 1) & 1))
        continue;
      it->near = 0;
      nodes.push_back(key);
    }
  }
}

} // namespace molmesh::contour
