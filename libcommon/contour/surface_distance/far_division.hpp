// far_division.hpp — which edges of far triangles are divided, where the new vertices go, and who makes room for
// them. On the host, since they are few.
#pragma once
#include "contour/surface_distance/far_patch.hpp"
#include "contour/surface_distance/nearer_items.hpp"
#include "geom/predicates.hpp"
#include "geom/tet_measures.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace molmesh::contour {

/// The patch comes to have fewer far triangles, or what triangles cost falls by a tenth of what the two at an edge
/// did; none gets farther than the farthest of the two. No element comes below `goal`, or where one at the edge is
/// below it, below that one; no new vertex is farther than 0.45 spacings from the isosurface.
template <class Surface>
class FarDivision {
public:
  FarDivision(FarPatch& patch, const Surface& surface, float goal, double shape)
      : p_(patch), surface_(surface), h_(surface.spacing()), goal_(goal), shape_(shape) {}

  /// How many edges were divided.
  int64_t run() {
    constexpr int most_sweeps = 4;
    const size_t before = p_.position.size();
    p_.find_stars();
    std::vector<uint8_t> given_up;
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      bool divided = false;
      for (size_t t = 0, n = p_.triangle.size(); t < n; ++t) {
        given_up.resize(p_.triangle.size());
        if (p_.triangle[t].off <= CentroidDistance::most || given_up[t])
          continue;
        const auto first_new = static_cast<int32_t>(p_.position.size());
        given_up[t] = !divide_at(t);
        for (auto m = first_new; m < static_cast<int32_t>(p_.position.size()); ++m) {
          divided = true;
          for (const size_t near : p_.triangles_at(m)) // those round it may try again
            for (const int32_t v : p_.triangle[near].tri)
              for (const size_t other : p_.triangles_at(v))
                if (other < given_up.size())
                  given_up[other] = 0;
        }
      }
      if (!divided)
        break;
    }
    return static_cast<int64_t>(p_.position.size() - before);
  }

private:
  static constexpr double most_distance = 0.45, reach = 5; // in spacings
  static constexpr float least_floor = 1e-6F;

  struct Cost {
    double sum = 0;
    int far = 0;
  };
  /// Of the first edge divided: what is to be lowered, and what holds for all that follow from it.
  struct Start {
    Cost all;
    int32_t middle; ///< the first new vertex
    float floor;    ///< of elements; > 0
    double at_edge = 0;
    float farthest = CentroidDistance::most;
    int tried = 0; ///< places, of all new vertices
  };

  Cost cost() const {
    Cost c;
    for (const FarPatch::Triangle& t : p_.triangle) {
      c.sum += CentroidDistance::cost(t.off);
      c.far += t.off > CentroidDistance::most;
    }
    return c;
  }

  /// The longest edge of triangle t for which it goes well.
  bool divide_at(size_t t) {
    const Cost before = cost();
    for (const size_t i : longest_first(t)) {
      const FarPatch::Edge edge = p_.edge(t, i);
      if (!p_.is_divisible(edge))
        continue;
      start_ = {before, static_cast<int32_t>(p_.position.size()), goal_};
      for (const size_t k : edge.triangles) {
        start_.at_edge += CentroidDistance::cost(p_.triangle[k].off);
        start_.farthest = std::max(start_.farthest, p_.triangle[k].off);
      }
      for (const size_t k : edge.elements)
        start_.floor = std::max(std::min(start_.floor, p_.element[k].quality), least_floor);
      if (divide(edge, 1))
        return true;
    }
    return false;
  }
  std::array<size_t, 3> longest_first(size_t t) const {
    const Tri& v = p_.triangle[t].tri;
    const auto length2 = [&](size_t i) { return norm2(p_.position[v[i]] - p_.position[v[(i + 1) % 3]]); };
    std::array<size_t, 3> order{0, 1, 2};
    std::stable_sort(order.begin(), order.end(), [&](size_t i, size_t j) { return length2(i) > length2(j); });
    return order;
  }

  /// Where the new vertex finds a place but a triangle at it is far, that one's edges are next. False: nothing is
  /// changed.
  bool divide(const FarPatch::Edge& edge, int depth) {
    constexpr int most_depth = 3;
    const size_t moves = moved_.size();
    const Vec3d a = p_.position[edge.end[0]], b = p_.position[edge.end[1]];
    const int32_t m = p_.divide(edge, 0.5 * (a + b));
    bool done = false;
    if (find_place(m, edge)) {
      done = is_good();
      const size_t worst = farthest_at(m);
      if (!done && depth < most_depth && p_.triangle[worst].off > CentroidDistance::most)
        for (const size_t i : longest_first(worst)) {
          const FarPatch::Edge next = p_.edge(worst, i);
          if (p_.is_divisible(next) && (done = divide(next, depth + 1)))
            break;
        }
    }
    if (done) {
      judge(m);
      for (; moved_.size() > moves; moved_.pop_back())
        judge(moved_.back().first);
      return true;
    }
    move_back(moves);
    p_.join(edge);
    for (const size_t t : edge.triangles)
      p_.triangle[t].off = off_of(p_.triangle[t].tri);
    return false;
  }
  void judge(int32_t v) {
    for (const size_t t : p_.elements_at(v))
      p_.element[t].quality = quality_of(p_.element[t].tet, p_.element[t].weight);
  }

  /// Of the new vertex, near the isosurface. Elements may be inverted at first.
  bool find_place(int32_t m, const FarPatch::Edge& edge) {
    constexpr double short_of = 0.4; // in spacings, of the foot
    constexpr int most_tried = 6;    // what goes well does within three
    const Vec3d x = p_.position[m];
    Vec3d foot = x;
    if (!find_foot(foot, edge))
      return false;
    const double way = norm(foot - x), least = way > short_of * h_ ? 1 - short_of * h_ / way : 0;
    const size_t moves = moved_.size();
    for (const double further : {0., 0.5, 1.}) {
      const Vec3d y = x + (least + further * (1 - least)) * (foot - x);
      if (!is_near(y))
        continue;
      if (++start_.tried > most_tried)
        return false;
      move(m, y);
      if (make_room(m)) {
        choose_place(m);
        return true;
      }
      move_back(moves);
    }
    return false;
  }
  /// Where the field is not known, the way there is that of the normals at the edge's ends.
  bool find_foot(Vec3d& x, const FarPatch::Edge& edge) const {
    constexpr double step = 0.25;
    const Vec3d from = x;
    if (surface_.project(x, reach * h_))
      return true;
    Vec3d along, normal;
    double distance;
    for (const int32_t v : edge.end)
      if (surface_.probe(p_.position[v], distance, normal))
        along += normal;
    const double length = norm(along);
    for (double way = step; length > 0 && way <= reach; way += step)
      for (const double side : {1., -1.}) {
        x = from + side * way * h_ / length * along;
        if (surface_.project(x, reach * h_))
          return true;
      }
    return false;
  }
  bool is_near(Vec3d y) const {
    double distance;
    Vec3d normal;
    return surface_.probe(y, distance, normal) && std::fabs(distance) <= most_distance * h_;
  }

  /// Until all elements round m and the free vertices by it are good enough.
  bool make_room(int32_t m) {
    constexpr int most_rounds = 8;
    constexpr float more = 1.2F, least_gain = 0.05F; // of the floor
    const float floor = start_.floor;
    const std::vector<int32_t> around = free_by(m);
    float worst = -1;
    for (int round = 0; round < most_rounds; ++round) {
      const float before = worst;
      bool any = false;
      for (const int32_t v : around)
        any |= make_better(v, more * floor, [](Vec3d) { return true; });
      any |= make_better(m, floor, [&](Vec3d y) { return is_near(y); });
      worst = worst_at(m, p_.position[m]);
      for (const int32_t v : around)
        worst = std::min(worst, worst_at(v, p_.position[v]));
      if (worst >= floor)
        return true;
      if (!any || (round > 0 && worst < before + least_gain * floor))
        break;
    }
    return false;
  }
  /// Free vertices of elements at m, and of elements at those.
  std::vector<int32_t> free_by(int32_t m) const {
    std::vector<int32_t> all;
    const auto collect = [&](int32_t c) {
      for (const size_t t : p_.elements_at(c))
        for (const int32_t v : p_.element[t].tet)
          if (p_.is_free[v])
            all.push_back(v);
    };
    const auto unique = [&] {
      std::sort(all.begin(), all.end());
      all.erase(std::unique(all.begin(), all.end()), all.end());
    };
    collect(m);
    unique();
    for (const int32_t v : std::vector<int32_t>(all))
      collect(v);
    unique();
    return all;
  }
  /// Vertex v moves to where its worst element is best, unless that is good enough.
  template <class May>
  bool make_better(int32_t v, float enough, May may) {
    constexpr double first = 0.8, last = 0.05; // steps, in spacings
    const Vec3d x = p_.position[v];
    Vec3d place = x;
    std::vector<size_t> star = p_.elements_at(v);
    float best = worst_of(star, v, x);
    if (best >= enough)
      return false;
    for (double step = first; step >= last; step *= 0.5)
      for (int k = 0; k < 27; ++k) {
        const Vec3d way{double(k % 3 - 1), double(k / 3 % 3 - 1), double(k / 9 - 1)};
        if (k == 13)
          continue;
        const Vec3d y = x + step * h_ / norm(way) * way;
        if (const float q = worst_of(star, v, y, best); q > best && may(y)) {
          best = q;
          place = y;
        }
      }
    if (place == x)
      return false;
    move(v, place);
    return true;
  }

  /// Along the isosurface's normal, where the triangles at m cost least.
  void choose_place(int32_t m) {
    const Vec3d x = p_.position[m];
    Vec3d foot = x, best = x;
    double least = cost_at(m);
    if (surface_.project(foot, reach * h_))
      for (const double way : {1.4, 1.2, 1., 0.8, 0.6, 0.4, 0.2}) {
        const Vec3d y = x + way * (foot - x);
        if (!is_near(y) || worst_at(m, y) < start_.floor)
          continue;
        p_.position[m] = y;
        if (const double c = cost_at(m); c < least) {
          least = c;
          best = y;
        }
      }
    p_.position[m] = best;
    cost_at(m);
  }
  /// Measures them, too.
  double cost_at(int32_t m) {
    double sum = 0;
    for (const size_t t : p_.triangles_at(m))
      sum += CentroidDistance::cost(p_.triangle[t].off = off_of(p_.triangle[t].tri));
    return sum;
  }
  size_t farthest_at(int32_t m) const {
    const std::vector<size_t>& all = p_.triangles_at(m);
    return *std::max_element(all.begin(), all.end(),
                             [&](size_t s, size_t t) { return p_.triangle[s].off < p_.triangle[t].off; });
  }
  bool is_good() const {
    constexpr double least_gain = 0.1;
    for (auto m = start_.middle; m < static_cast<int32_t>(p_.position.size()); ++m)
      if (p_.triangle[farthest_at(m)].off > start_.farthest)
        return false;
    const Cost now = cost();
    return now.far < start_.all.far || now.sum < start_.all.sum - least_gain * start_.at_edge;
  }

  void move(int32_t v, Vec3d y) {
    moved_.push_back({v, p_.position[v]});
    p_.position[v] = y;
  }
  void move_back(size_t moves) {
    for (; moved_.size() > moves; moved_.pop_back())
      p_.position[moved_.back().first] = moved_.back().second;
  }

  float worst_at(int32_t v, Vec3d y) {
    std::vector<size_t> star = p_.elements_at(v);
    return worst_of(star, v, y);
  }
  /// Of elements at vertex v, with it at y; some value ≤ above as soon as one is no better than that, and that one
  /// is asked first from then on.
  float worst_of(std::vector<size_t>& star, int32_t v, Vec3d y, float above = -2) {
    std::swap(p_.position[v], y);
    float worst = 1;
    for (size_t i = 0; i < star.size() && worst > above; ++i) {
      const FarPatch::Element& e = p_.element[star[i]];
      worst = std::min(worst, quality_of(e.tet, e.weight));
      if (worst <= above)
        std::swap(star[i], star[0]);
    }
    std::swap(p_.position[v], y);
    return worst;
  }
  /// Of one that is not positive: less the more it is inverted, so that there is a way back.
  float quality_of(const Tet& tet, float weight) const {
    std::array<Vec3d, 4> x;
    for (size_t i = 0; i < 4; ++i)
      x[i] = p_.position[tet[i]];
    const double volume6 = six_volume(x[0], x[1], x[2], x[3]);
    if (volume6 > 0) {
      const float q = tet_quality(x[0], x[1], x[2], x[3], shape_);
      if (q >= surely_positive || (q > 0 && orient3d(x[0], x[1], x[2], x[3]) > 0))
        return weight * q;
    }
    double sum = 0;
    for (size_t i = 0; i < 4; ++i)
      for (size_t j = 0; j < i; ++j)
        sum += norm2(x[i] - x[j]);
    return static_cast<float>(-std::fabs(volume6) / (sum * std::sqrt(sum)));
  }
  float off_of(const Tri& tri) const {
    Vec3d centroid;
    for (const int32_t v : tri)
      centroid += p_.position[v];
    return CentroidDistance::of(surface_, centroid / 3.);
  }

  FarPatch& p_;
  const Surface& surface_;
  double h_;
  float goal_;
  double shape_;
  Start start_{};
  std::vector<std::pair<int32_t, Vec3d>> moved_; ///< from where
};

/// Of each patch; how many edges in all.
template <class Surface>
int64_t divide_far(std::vector<FarPatch>& patches, const Surface& surface, float goal, double shape, int threads) {
  std::vector<int64_t> divided(patches.size());
  par::for_n(static_cast<int64_t>(patches.size()), threads, 1, [&](int64_t i) {
    const auto k = static_cast<size_t>(i);
    divided[k] = FarDivision<Surface>(patches[k], surface, goal, shape).run();
  });
  return std::accumulate(divided.begin(), divided.end(), int64_t{0});
}

} // namespace molmesh::contour
