// nearest_points.cpp — searches the mesh's points with nanoflann.
#include "mesh/nearest_points.hpp"
#include <cmath>
#include <cstdint>
#include <nanoflann.hpp>

namespace molmesh {
namespace {

struct Points {
  const TetMesh& m;
  size_t kdtree_get_point_count() const { return m.point.size(); }
  double kdtree_get_pt(size_t i, size_t axis) const { return m.point[i][static_cast<int>(axis)]; }
  template <class B>
  bool kdtree_get_bbox(B&) const {
    return false;
  }
};

} // namespace

std::vector<NearestPoint> nearest_points(const TetMesh& m, std::span<const Vec3d> place) {
  std::vector<NearestPoint> all(place.size());
  if (m.point.empty() || place.empty())
    return all;
  const Points points{m};
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3>;
  Index index(3, points);
  index.buildIndex();
  nanoflann::SearchParams sorted;
  sorted.sorted = true;
  std::vector<std::pair<uint32_t, double>> found;
  for (size_t i = 0; i < place.size(); ++i) {
    const double at[3] = {place[i].x, place[i].y, place[i].z};
    uint32_t nearest = 0;
    double distance2 = 0;
    index.knnSearch(at, 1, &nearest, &distance2);
    // Those within a bit more: the order of equals is the tree's own.
    index.radiusSearch(at, std::nextafter(distance2, 2 * distance2 + 1), found, sorted);
    for (const auto& [p, d2] : found)
      if (d2 < distance2 || (d2 == distance2 && p < nearest))
        nearest = p, distance2 = d2;
    all[i] = {static_cast<int64_t>(nearest), std::sqrt(distance2)};
  }
  return all;
}

} // namespace molmesh
