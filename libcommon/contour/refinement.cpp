// refinement.cpp — merging surface cells bottom-up.
#include "contour/refinement.hpp"
#include "contour/cube.hpp"
#include "geom/morton.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::contour {
namespace {

constexpr double least_share = 0.02;
constexpr double least_cosine = 0.82; // normals within 35° of their mean: one sheet, no crease
constexpr double least_margin = 0.25; // of the mean point from a merged cell's faces, in its edge length
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

/// The dual vertex of a cell merged from these would lie well within it: one near the cell's boundary makes
/// slivers.
bool central(const SurfaceSample* begin, const SurfaceSample* end, Vec3i corner, int32_t extent) {
  Vec3d mean;
  for (const SurfaceSample* s = begin; s < end; ++s)
    mean += s->point;
  mean = mean / double(end - begin);
  for (int a = 0; a < 3; ++a) {
    const double share = (mean[a] - corner[a]) / extent;
    if (share < least_margin || share > 1 - least_margin)
      return false;
  }
  return true;
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

} // namespace

double crossing_share(double a, double b, double isovalue) {
  const bool logarithmic = a > 0 && b > 0;
  const auto f = [&](double v) { return logarithmic ? std::log(v / isovalue) : v - isovalue; };
  const double fa = f(a), fb = f(b);
  return std::clamp(fa == fb ? 0.5 : fa / (fa - fb), least_share, 1 - least_share);
}

Vec3d mass_centre(const float value[8], double isovalue) {
  Vec3d sum;
  int n = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int c = 0; c < 8; ++c) {
      const int d = c | 1 << axis;
      if (d == c || (value[c] > isovalue) == (value[d] > isovalue))
        continue;
      Vec3d p{double(c & 1), double(c >> 1 & 1), double(c >> 2)};
      p[axis] = crossing_share(value[c], value[d], isovalue);
      sum += p;
      ++n;
    }
  return n ? sum / double(n) : Vec3d{0.5, 0.5, 0.5};
}

SurfaceSample surface_sample(const SurfaceCell& cell, double isovalue) {
  const float* v = cell.value;
  Vec3d gradient;
  for (int c = 0; c < 8; ++c)
    for (int a = 0; a < 3; ++a)
      gradient[a] += (c >> a & 1 ? 1.0 : -1.0) * v[c];
  const double length = norm(gradient);
  return {to_double(morton_point(cell.key)) + mass_centre(v, isovalue),
          length > 0 ? gradient / length : Vec3d{0, 0, 0}};
}

RefinedNodes refine(const Lattice& lattice, const std::vector<SurfaceCell>& cells, const RefineOptions& options,
                    int threads) {
  RefinedNodes refined(static_cast<size_t>(lattice.top_level) + 1);
  const auto n = static_cast<int64_t>(cells.size());
  if (lattice.top_level == 0)
    return refined;
  const double isovalue = lattice.isovalue;
  std::vector<SurfaceSample> samples;
  std::vector<uint8_t> whole(static_cast<size_t>(n), 0); // the cell's node so far is one plain sheet
  std::vector<int8_t> merged(static_cast<size_t>(n), 0); // highest level at which the cell's node makes a good cell
  if (options.adapt > 0) {
    samples.resize(static_cast<size_t>(n));
    par::for_n(n, threads, [&](int64_t i) {
      const SurfaceCell& cell = cells[static_cast<size_t>(i)];
      samples[static_cast<size_t>(i)] = surface_sample(cell, isovalue);
      double value[8];
      for (int c = 0; c < 8; ++c)
        value[c] = double(cell.value[c]) - isovalue;
      whole[static_cast<size_t>(i)] = one_disc(value);
    });
  } else {
    append_uniform(lattice, options, refined[1]);
  }
  // Nodes of a level: ranges of surface cells.
  const auto ranges = [&](int l) {
    std::vector<int64_t> begin;
    for (int64_t i = 0; i < n; ++i)
      if (i == 0 || cells[static_cast<size_t>(i)].key >> 3 * l != cells[static_cast<size_t>(i) - 1].key >> 3 * l)
        begin.push_back(i);
    begin.push_back(n);
    return begin;
  };
  for (int l = 1; l <= std::min(most_merges, lattice.top_level) && options.adapt > 0; ++l) {
    const std::vector<int64_t> begin = ranges(l);
    par::for_n(static_cast<int64_t>(begin.size()) - 1, threads, 64, [&](int64_t node) {
      const auto b = static_cast<size_t>(begin[static_cast<size_t>(node)]),
                 e = static_cast<size_t>(begin[static_cast<size_t>(node) + 1]);
      const SurfaceSample *first = &samples[b], *last = first + (e - b);
      const Vec3i corner = morton_point(cells[b].key >> 3 * l << 3 * l);
      const int32_t extent = 1 << l;
      bool one = corner.x + extent <= lattice.cells.x && corner.y + extent <= lattice.cells.y &&
                 corner.z + extent <= lattice.cells.z;
      for (size_t i = b; one && i < e; ++i)
        one = whole[i];
      one = one && nearly_plane(first, last, options.adapt) && keeps_topology(lattice, corner, extent);
      const bool good = one && central(first, last, corner, extent);
      for (size_t i = b; i < e; ++i) {
        whole[i] = one;
        if (good)
          merged[i] = static_cast<int8_t>(l);
      }
    });
  }
  for (int l = 1; l <= lattice.top_level; ++l)
    for (const std::vector<int64_t> begin = ranges(l); int64_t first : begin)
      if (first < n && merged[static_cast<size_t>(first)] < l)
        refined[static_cast<size_t>(l)].push_back(cells[static_cast<size_t>(first)].key >> 3 * l);
  return refined;
}

} // namespace molmesh::contour
