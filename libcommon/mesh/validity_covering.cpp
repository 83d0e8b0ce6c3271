// validity_covering.cpp — counts the tetrahedra that hold a point: how often a ray from it leaves through the skin,
// less how often it enters.
#include "mesh/validity_covering.hpp"
#include "geom/predicates.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/box_tree.hpp"
#include "mesh/disjoint_sets.hpp"
#include "mesh/group_by_key.hpp"
#include "mesh/triangle_order.hpp"
#include <algorithm>
#include <cmath>
#include <optional>

namespace molmesh {
namespace {

/// [triangles] The first of the triangles that each is connected with through edges.
std::vector<int32_t> pieces(const std::vector<Tri>& tri, int64_t points, int threads) {
  const auto end = [&](int64_t half, size_t which) {
    return tri[half / 3][(static_cast<size_t>(half % 3) + which) % 3];
  };
  std::vector<uint32_t> first(3 * tri.size()); // half edge at the same edge
  for_each_group(
      static_cast<int64_t>(first.size()), points, threads,
      [&](int64_t h) {
        return GroupKey{std::min(end(h, 0), end(h, 1)), uint32_t(std::max(end(h, 0), end(h, 1)))};
      },
      [&](const uint32_t* half, int n) {
        for (int i = 0; i < n; ++i)
          first[half[i]] = half[0];
      });
  DisjointSets sets(tri.size());
  for (size_t h = 0; h < first.size(); ++h)
    sets.join(static_cast<int32_t>(h / 3), static_cast<int32_t>(first[h] / 3));
  std::vector<int32_t> piece;
  for (size_t t = 0; t < tri.size(); ++t)
    piece.push_back(sets.first(static_cast<int32_t>(t)));
  return piece;
}

/// The skin to be met by rays.
class Skin {
public:
  Skin(const std::vector<Vec3d>& point, const std::vector<Tri>& tri, int threads)
      : point_(point), tri_(in_order(tri, order_along_curve(point, tri, threads))),
        tree_(
            tri_.size(), [this](size_t i) { return box_around(at(tri_[i][0]), at(tri_[i][1]), at(tri_[i][2])); },
            threads) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Tri& t : tri_)
      for (const int32_t v : t) {
        low = std::min(low, at(v).x);
        high = std::max(high, at(v).x);
      }
    beyond_ = high + (high - low);
  }
  /// Tetrahedra that p is in; none where the ray meets an edge or p lies on a triangle.
  std::optional<int> covered(Vec3d p) const {
    const Vec3d q{beyond_, p.y, p.z};
    bool unclear = false;
    int count = 0;
    tree_.any(box_around(p, p, q), [&](size_t i) {
      const Vec3d a = at(tri_[i][0]), b = at(tri_[i][1]), c = at(tri_[i][2]);
      const int from = orient3d(a, b, c, p), to = orient3d(a, b, c, q);
      if (from == to && from != 0)
        return false;
      const int ab = orient3d(p, q, a, b), bc = orient3d(p, q, b, c), ca = orient3d(p, q, c, a);
      const bool outside = std::min({ab, bc, ca}) < 0 && std::max({ab, bc, ca}) > 0;
      unclear = !outside && (from == 0 || to == 0 || ab == 0 || bc == 0 || ca == 0);
      count += outside ? 0 : to;
      return unclear;
    });
    return unclear ? std::nullopt : std::optional(count);
  }

private:
  Vec3d at(int32_t v) const { return point_[v]; }
  const std::vector<Vec3d>& point_;
  std::vector<Tri> tri_;
  BoxTree tree_;
  double beyond_;
};

} // namespace

Covering check_covering(const TetMesh& m, const std::vector<int64_t>& skin, int threads) {
  Covering found;
  if (skin.empty())
    return found;
  std::vector<Tri> tri(skin.size());
  par::for_n(static_cast<int64_t>(skin.size()), threads, [&](int64_t i) { tri[i] = face_points(m, skin[i]); });
  const auto at = [&](int32_t v) { return m.point[v]; };
  const std::vector<int32_t> piece = pieces(tri, static_cast<int64_t>(m.point.size()), threads);
  std::vector<int32_t> largest(tri.size(), -1); // of a piece, at its first triangle
  std::vector<double> area(tri.size());
  for (size_t t = 0; t < tri.size(); ++t)
    if (const double a = tri_area(at(tri[t][0]), at(tri[t][1]), at(tri[t][2])); a > area[piece[t]]) {
      area[piece[t]] = a;
      largest[piece[t]] = static_cast<int32_t>(t);
    }
  std::erase(largest, -1);
  const Skin all(m.point, tri, threads);
  const auto is_wrong = [&](int64_t i) {
    const auto t = static_cast<size_t>(largest[i]);
    const int64_t face = skin[t];
    const Vec3d a = at(tri[t][0]), b = at(tri[t][1]), c = at(tri[t][2]), apex = at(m.tet[face / 4][face % 4]);
    constexpr double near = 1e-4;
    for (const bool inner : {true, false})
      for (const double share : {0.3137, 0.2718, 0.3679, 0.4142}) { // another place where a ray meets an edge
        const Vec3d on = a + share * (b - a) + 0.2929 * (c - a);
        const std::optional<int> covered = all.covered(on + (inner ? near : -near) * (apex - on));
        if (!covered)
          continue;
        if (*covered != (inner ? 1 : 0))
          return true;
        break;
      }
    return false;
  };
  return par::reduce(
      static_cast<int64_t>(largest.size()), threads, Covering{},
      [&](int64_t i) {
        return is_wrong(i) ? Covering{1, skin[largest[i]]} : Covering{};
      },
      [](const Covering& x, const Covering& y) {
        return Covering{x.wrong + y.wrong, x.wrong > 0 ? x.face : y.face};
      },
      16);
}

} // namespace molmesh
