// surface_distances.cpp — elements against distance: how far density2tet's surface is from the isosurface,
// tolerance by tolerance. surface_distances FILE.vdb ADAPT…: the interior's elements, how far the centroids of its
// surface triangles are from the isosurface, in grid spacings, and how many are turned by over 45° from the field's
// normal.
#include "contour/contour.hpp"
#include "formats/vdb/vdb.hpp"
#include "geom/tet_measures.hpp"
#include "isosurface/isosurface.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

using namespace molmesh;

namespace {

struct Distances {
  std::vector<double> off; ///< ascending, of the triangles that lie where the field is known
  int64_t turned = 0;
};

/// From p, where log G / isovalue is f, to the first place on the other side along any of 2,000 directions, in
/// spacings; `most` where that is farther. Where two layers meet this is nearer than the foot along the gradient.
double nearest(const Isosurface& isosurface, Vec3d p, double f, double most) {
  constexpr int directions = 2000;
  constexpr double step = 0.01, golden_angle = 2.39996322972865332;
  for (int k = 0; k < directions; ++k) {
    const double z = (2. * k + 1) / directions - 1, across = std::sqrt(1 - z * z), turn = golden_angle * k;
    const Vec3d along = isosurface.spacing() * Vec3d{across * std::cos(turn), across * std::sin(turn), z};
    double there;
    Vec3d gradient;
    for (double r = step; r < most; r += step)
      if (isosurface.evaluate(p + r * along, there, gradient) && (there > 0) != (f > 0))
        most = r;
  }
  return most;
}

Distances measure(const TetMesh& mesh, const Isosurface& isosurface) {
  Distances all;
  for (size_t t = 0; t < mesh.tri.size(); ++t) {
    if (mesh.boundary[t] != surface)
      continue;
    std::array<Vec3d, 3> x;
    for (size_t i = 0; i < 3; ++i)
      x[i] = mesh.point[mesh.tri[t][i]];
    const Vec3d centroid = (x[0] + x[1] + x[2]) / 3., across = tri_normal(x[0], x[1], x[2]);
    constexpr double reach = 5, near = 0.5; // spacings
    double f;
    Vec3d foot = centroid, gradient;
    if (!isosurface.evaluate(centroid, f, gradient)) {
      ++all.turned;
      continue;
    }
    const bool has_foot = isosurface.project(foot, reach * isosurface.spacing());
    const double off = has_foot ? norm(foot - centroid) / isosurface.spacing() : reach;
    all.off.push_back(off > near ? nearest(isosurface, centroid, f, off) : off);
    all.turned += !(dot(across, gradient) <= -std::sqrt(0.5) * norm(across) * norm(gradient));
  }
  std::sort(all.off.begin(), all.off.end());
  return all;
}

} // namespace

int main(int count, char** arg) {
  if (count < 3) {
    std::fprintf(stderr, "surface_distances FILE.vdb ADAPT...\n");
    return 2;
  }
  std::ifstream in(arg[1], std::ios::binary);
  const int threads = par::default_threads();
  const BlockGrid grid = formats::read_vdb(in, arg[1], threads);
  const Isosurface isosurface(grid, threads);
  std::printf("%8s %10s %10s %7s %7s %7s %7s %15s %14s\n", "adapt", "tetrahedra", "triangles", "median", "99 %",
              "99.9 %", "most", "beyond 0.5", "turned, 1/1000");
  for (int i = 2; i < count; ++i) {
    contour::Options options;
    if (const std::string adapt = arg[i]; adapt != "auto")
      options.adapt = std::atof(arg[i]);
    options.threads = threads;
    contour::Summary summary;
    const TetMesh mesh = contour::contour(grid, options, summary, [](const std::string&) {});
    const Distances d = measure(mesh, isosurface);
    const size_t n = d.off.size();
    const auto at = [&](double share) { return d.off[std::min(n - 1, static_cast<size_t>(share * double(n)))]; };
    const auto beyond = d.off.end() - std::upper_bound(d.off.begin(), d.off.end(), 0.5);
    std::printf("%8.4g %10zu %10zu %7.3f %7.3f %7.3f %7.2f %6td %7.4f%% %14.1f\n", summary.adapt, mesh.tet.size(),
                n, at(0.5), at(0.99), at(0.999), d.off.back(), beyond, 100. * double(beyond) / double(n),
                1e3 * double(d.turned) / double(n));
    std::fflush(stdout);
  }
}
