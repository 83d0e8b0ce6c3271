// margin.cpp — bisects an upper bound on G behind a face of the box.
#include "density/field/margin.hpp"
#include "base/error.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace molmesh::density {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A cluster and how deep behind a face of the box it begins, Å.
struct Deep {
  size_t cluster;
  double depth;
};

/// Those nearer than their cutoff to what lies `margin` beyond the face.
std::vector<Deep> near_face(const Field& f, const Box& all, int axis, bool high, double margin, bool near_only) {
  std::vector<Deep> near;
  for (size_t c = 0; c < f.group.size(); ++c) {
    const double depth = high ? all.hi[axis] - f.box[c].hi[axis] : f.box[c].lo[axis] - all.lo[axis];
    if (!near_only || (margin + depth) * (margin + depth) < f.cutoff2[c])
      near.push_back({c, depth});
  }
  return near;
}

/// ln of an upper bound of G `margin` or more beyond a face of the box; without clusters beyond their cutoff when
/// `near_only`.
double ln_bound_behind(const Field& f, const std::vector<Deep>& near, double margin, bool near_only) {
  OpenGroups groups(f);
  std::vector<double> open(groups.levels() + 1, -infinity); // [0]: G; [last]: the innermost group
  double& innermost = open.back();
  int64_t current = -1;
  const auto close = [&](size_t l, int64_t g) {
    double& to = l + 1 < groups.levels() ? open[l + 1] : open[0];
    to = log_add(to, f.level[l].exponent[g] * open[l]);
    open[l] = -infinity;
  };
  const auto close_innermost = [&] {
    if (current < 0)
      return;
    groups.enter(current, close);
    double& to = groups.levels() > 1 ? open[1] : open[0];
    to = log_add(to, f.level[0].exponent[current] * innermost);
    innermost = -infinity;
  };
  for (const auto& [c, depth] : near) {
    if (near_only && (margin + depth) * (margin + depth) >= f.cutoff2[c])
      continue;
    if (f.group[c] != current)
      close_innermost();
    current = f.group[c];
    innermost = log_add(innermost, f.ln_peak[c] - f.decay * (margin + depth) * (margin + depth));
  }
  close_innermost();
  groups.finish(close);
  return open[0];
}

GridFrame frame(Vec3d lo, Vec3d extent, double h, int longest, int64_t n) {
  GridFrame f{lo, h, {0, 0, 0}, {0, 0, 0}};
  for (int a = 0; a < 3; ++a) {
    // A corner that rounding puts a hair beyond the last point counts as on it.
    const double cells = a == longest ? static_cast<double>(n - 1) : std::ceil(extent[a] / h * (1 - 1e-12));
    if (!(cells < 1 << 29))
      fail(Status::usage,
           "the grid would have more than 2^29 points along an axis, expected a larger spacing or "
           "decay, or a smaller margin",
           {"spacing", "decay", "margin"});
    // The file's transform and the mesh's points are doubles: these are resolved to 1e-5 of a spacing there.
    if (!(std::max(std::abs(lo[a]), std::abs(lo[a] + extent[a])) < 1e10 * h))
      fail(Status::usage,
           "atoms are over 10^10 spacings from the origin, expected a larger spacing or nearer atoms", {"spacing"});
    f.points[a] = static_cast<int32_t>(std::max(1.0, cells)) + 1;
  }
  return f;
}

} // namespace

double sufficient_margin(const Field& f, double value) {
  const Box all = f.bounds();
  const bool near_only = value > 10 * f.far_error;
  const double limit = std::log(near_only ? value - f.far_error : value);
  double margin = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool high : {false, true}) {
      const std::vector<Deep> near = near_face(f, all, axis, high, margin, near_only);
      const auto enough = [&](double m) { return ln_bound_behind(f, near, m, near_only) < limit; };
      if (enough(margin))
        continue;
      double lo = margin, hi = std::max(1.0, 2 * margin);
      while (!enough(hi)) {
        lo = hi;
        hi *= 2;
      }
      while (hi - lo > std::max(0.01, 1e-9 * hi))
        (enough((lo + hi) / 2) ? hi : lo) = (lo + hi) / 2;
      margin = hi;
    }
  return margin;
}

double longest_edge(const Box& box, double margin) {
  const Vec3d e = box.hi - box.lo;
  return std::max({e.x, e.y, e.z}) + 2 * margin;
}

GridFrame frame_with_spacing(const Box& box, double margin, double h) {
  const Vec3d m{margin, margin, margin};
  return frame(box.lo - m, box.hi - box.lo + 2.0 * m, h, -1, 0);
}

GridFrame frame_with_points(const Box& box, double margin, int64_t n) {
  const Vec3d m{margin, margin, margin}, extent = box.hi - box.lo + 2.0 * m;
  int longest = 0;
  for (int a = 1; a < 3; ++a)
    if (extent[a] > extent[longest])
      longest = a;
  return frame(box.lo - m, extent, extent[longest] / static_cast<double>(n - 1), longest, n);
}

} // namespace molmesh::density
