// merging.cpp — bottom-up, level by level, until a node of the octree holds more than one plain sheet.
#include "contour/merging.hpp"
#include "contour/cube.hpp"
#include "geom/morton.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::contour {
namespace {

constexpr double least_cosine = 0.82; // normals within 35° of their mean: one sheet, no crease
constexpr int most_merges = 5;        // surface cells of 32 fine spacings at most

/// True when [begin, end) stays within `tolerance` of its mean plane.
bool nearly_plane(const SurfaceSample* begin, const SurfaceSample* end, double tolerance) {
  Vec3d normal, point;
  for (const SurfaceSample* s = begin; s < end; ++s) {
    normal += s->normal;
    point += s->point;
  }
  const double length = norm(normal);
  if (length == 0)
    return false;
  normal = normal / length;
  point = point / double(end - begin);
  return std::all_of(begin, end, [&](const SurfaceSample& s) {
    return dot(s.normal, normal) >= least_cosine && std::fabs(dot(s.point - point, normal)) <= tolerance;
  });
}

bool one_disc(const double value[8]) {
  const CellTopology t = cell_topology(value);
  return t.loops == 1 &&
         std::all_of(t.diagonal.begin(), t.diagonal.end(), [](Diagonal d) { return d == Diagonal::none; });
}

/// The signs of the 27 corners of the node's children.
bool keeps_topology(const Lattice& lattice, Vec3i corner, int32_t extent) {
  bool in[27];
  for (int n = 0; n < 27; ++n)
    in[n] = lattice.inside(corner + (extent / 2) * Vec3i{n % 3, n / 3 % 3, n / 9});
  double value[8];
  for (int c = 0; c < 8; ++c)
    value[c] = in[2 * (c & 1) + 6 * (c >> 1 & 1) + 18 * (c >> 2)] ? 1 : -1;
  if (!one_disc(value))
    return false;
  // Corners of the edge, face or cell whose middle is n: every combination of its 0s and 2s with each 1 made 0
  // or 2.
  for (int n = 0; n < 27; ++n) {
    const int at[3] = {n % 3, n / 3 % 3, n / 9};
    bool agrees = false;
    for (int c = 0; c < 8; ++c) {
      int m = 0;
      for (int a = 2; a >= 0; --a)
        m = 3 * m + (at[a] == 1 ? 2 * (c >> a & 1) : at[a]);
      agrees |= in[m] == in[n];
    }
    if (!agrees)
      return false;
  }
  return true;
}

} // namespace

std::vector<int64_t> node_ranges(const std::vector<SurfaceCell>& cells, int level) {
  std::vector<int64_t> begin;
  for (size_t i = 0; i < cells.size(); ++i)
    if (i == 0 || cells[i].key >> 3 * level != cells[i - 1].key >> 3 * level)
      begin.push_back(static_cast<int64_t>(i));
  begin.push_back(static_cast<int64_t>(cells.size()));
  return begin;
}

std::vector<int8_t> merge_levels(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                                 const std::vector<SurfaceSample>& samples, double adapt, int threads) {
  const auto n = static_cast<int64_t>(cells.size());
  std::vector<int8_t> merged(cells.size(), 0);
  if (!(adapt > 0))
    return merged;
  std::vector<uint8_t> whole(cells.size()); // the cell's node so far is one plain sheet
  par::for_n(n, threads, [&](int64_t i) {
    double value[8];
    for (int c = 0; c < 8; ++c)
      value[c] = double(cells[static_cast<size_t>(i)].value[c]) - double(lattice.isovalue);
    whole[static_cast<size_t>(i)] = one_disc(value);
  });
  for (int l = 1; l <= std::min(most_merges, lattice.top_level); ++l) {
    const std::vector<int64_t> begin = node_ranges(cells, l);
    par::for_n(static_cast<int64_t>(begin.size()) - 1, threads, 64, [&](int64_t node) {
      const auto b = static_cast<size_t>(begin[static_cast<size_t>(node)]),
                 e = static_cast<size_t>(begin[static_cast<size_t>(node) + 1]);
      const Vec3i corner = morton_point(cells[b].key >> 3 * l << 3 * l);
      const int32_t extent = 1 << l;
      bool one = corner.x + extent <= lattice.cells.x && corner.y + extent <= lattice.cells.y &&
                 corner.z + extent <= lattice.cells.z;
      for (size_t i = b; one && i < e; ++i)
        one = whole[i];
      one =
          one && nearly_plane(&samples[b], &samples[b] + (e - b), adapt) && keeps_topology(lattice, corner, extent);
      for (size_t i = b; i < e; ++i) {
        whole[i] = one;
        if (one)
          merged[i] = static_cast<int8_t>(l);
      }
    });
  }
  return merged;
}

} // namespace molmesh::contour
