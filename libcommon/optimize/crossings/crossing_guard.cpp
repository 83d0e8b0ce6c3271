// crossing_guard.cpp — triangles near those that move, told apart by planes first and by the exact test last.
#include "optimize/crossings/crossing_guard.hpp"
#include "geom/intersect.hpp"  // exact test of two triangles
#include "geom/predicates.hpp" // on which side of a triangle a point lies
#include "geom/tet_measures.hpp"
#include "mesh/box_tree.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

namespace molmesh::optimize {
namespace {

// Whether they share an edge and nearly lie on each other. No element is so thin, so it is not the mesh that is
// between them: nothing is, or the mesh overlaps itself. A vertex with three triangles can be turned over by way of
// this, where all share edges and none crosses another.
bool fold_up(const DynamicMesh& m, const FreeTriangle& a, const FreeTriangle& b, const Apart& apart) {
  constexpr double most_cosine = -0.9945; // of their normals: 6 degrees between them
  if (!apart.share_edge() || dot(a.normal, b.normal) > -0.9f)
    return false;
  const auto normal = [&](const FreeTriangle& t) {
    return tri_normal(m.point[t.v[0]], m.point[t.v[1]], m.point[t.v[2]]);
  };
  const Vec3d of_a = normal(a), of_b = normal(b);
  return dot(of_a, of_b) < most_cosine * std::sqrt(norm2(of_a) * norm2(of_b));
}

} // namespace

// Whether a triangle of these vertices is there.
bool CrossingGuard::is_there(std::array<int32_t, 3> v, uint32_t leaving) {
  std::sort(v.begin(), v.end());
  const auto same = [&](std::array<int32_t, 3> w) {
    std::sort(w.begin(), w.end());
    return v == w;
  };
  return std::any_of(now_.begin(), now_.end(), same) || std::any_of(near_.begin(), near_.end(), [&](Near& n) {
           return same(n.triangle.v) && stays_near(n, leaving);
         });
}

// Whether t is a side of a hole that is inside out: of four triangles, or of six, which are two tips over one
// triangle. Those at t's edges are in beyond_.
bool CrossingGuard::turns_over(const std::array<int32_t, 3>& t, uint32_t leaving) {
  const auto across = [&](size_t k, int32_t apex) {
    return std::any_of(beyond_.begin(), beyond_.end(),
                       [&](const Beyond& b) { return b.edge == int(k) && b.apex == apex; });
  };
  const auto p = [&](int32_t v) { return m_.point[v]; };
  return std::any_of(beyond_.begin(), beyond_.end(), [&](const Beyond& b) {
    const auto i = size_t(b.edge), j = (i + 1) % 3, k = (i + 2) % 3;
    if (across(j, b.apex) && across(k, b.apex))
      return i == 0 && !(orient3d(p(t[0]), p(t[1]), p(t[2]), p(b.apex)) > 0);
    // t[i] is a tip: its three triangles stand on t[j], t[k] and this one.
    const auto third = std::find_if(beyond_.begin(), beyond_.end(), [&](const Beyond& c) {
      return c.edge == int(j) && c.apex != b.apex && across(k, c.apex);
    });
    if (third == beyond_.end() || !is_there({b.apex, third->apex, t[j]}, leaving) ||
        !is_there({b.apex, third->apex, t[k]}, leaving))
      return false;
    const auto part = [&](int32_t from, int32_t to) { return tet_volume(p(t[i]), p(from), p(to), p(b.apex)); };
    return !(part(t[j], t[k]) + part(t[k], third->apex) + part(third->apex, t[j]) > 0);
  });
}

// Whether triangles at a tip, each with the same vertex beyond the edge opposite the tip, close a hole that is
// inside out.
bool CrossingGuard::is_inside_out(const std::vector<std::array<int32_t, 3>>& fan, int32_t tip,
                                  int32_t other) const {
  double volume = 0;
  std::vector<int32_t> border;
  for (const auto& t : fan) {
    volume += tet_volume(m_.point[t[0]], m_.point[t[1]], m_.point[t[2]], m_.point[other]);
    std::copy_if(t.begin(), t.end(), std::back_inserter(border), [&](int32_t v) { return v != tip; });
  }
  if (volume > 0)
    return false;
  std::sort(border.begin(), border.end());
  for (size_t i = 0; i < border.size(); i += 2)
    if (border[i] != border[i + 1] || (i > 0 && border[i] == border[i - 1]))
      return false; // it goes on elsewhere
  return true;
}

bool CrossingGuard::fan_turns_over() const {
  for (size_t k = 0; k < 3 && now_.size() > 2; ++k) {
    const int32_t tip = now_[0][k], other = opposite_[0][k];
    const auto beyond = [&](size_t i) {
      const auto at = size_t(std::find(now_[i].begin(), now_[i].end(), tip) - now_[i].begin());
      return at < 3 ? opposite_[i][at] : -1;
    };
    bool all = other >= 0;
    for (size_t i = 1; all && i < now_.size(); ++i)
      all = beyond(i) == other;
    if (all && is_inside_out(now_, tip, other))
      return true;
  }
  return false;
}

// The vertices of the fans of near_ that close such a hole.
void CrossingGuard::add_fans_that_turn_over(SmallNumbers& vertices) const {
  std::vector<std::array<int32_t, 4>> edge;  // ends, triangle, corner opposite
  std::vector<std::array<int32_t, 3>> stand; // tip, beyond, triangle
  for (size_t n = 0; n < near_.size(); ++n)
    for (size_t k = 0; k < 3; ++k) {
      const auto& v = near_[n].triangle.v;
      const auto [low, high] = std::minmax(v[(k + 1) % 3], v[(k + 2) % 3]);
      edge.push_back({low, high, int32_t(n), v[k]});
    }
  std::sort(edge.begin(), edge.end());
  for (size_t i = 1; i < edge.size(); ++i) {
    const auto &a = edge[i - 1], &b = edge[i];
    if (a[0] == b[0] && a[1] == b[1]) {
      stand.push_back({a[3], b[3], a[2]});
      stand.push_back({b[3], a[3], b[2]});
    }
  }
  std::sort(stand.begin(), stand.end());
  std::vector<std::array<int32_t, 3>> fan;
  for (size_t i = 0; i < stand.size(); ++i) {
    fan.push_back(near_[size_t(stand[i][2])].triangle.v);
    if (i + 1 < stand.size() && stand[i + 1][0] == stand[i][0] && stand[i + 1][1] == stand[i][1])
      continue;
    if (fan.size() > 2 && is_inside_out(fan, stand[i][0], stand[i][1])) {
      vertices(stand[i][1]);
      for (const auto& t : fan)
        std::for_each(t.begin(), t.end(), std::ref(vertices));
    }
    fan.clear();
  }
}

// near_: what may stand in the way of any triangle of now_. Triangles of other parts change meanwhile, each in its
// own cell, so none of those is met; triangles of no part stay as they are.
void CrossingGuard::gather_near(const FreeTriangles& from, const Boxf& around, bool may_be_stale) {
  from.any(around, [&](const FreeTriangle& other) {
    const size_t n = near_.size();
    near_.push_back({other, may_be_stale ? Near::Stays::may_be_stale : Near::Stays::not_asked});
    if (n % 8 == 0)
      near_box_.emplace_back();
    near_box_[n / 8].set(n % 8, static_cast<int32_t>(n), other);
    return false;
  });
}

bool CrossingGuard::stays_near(Near& n, uint32_t leaving) const {
  if (n.stays == Near::Stays::yes || n.stays == Near::Stays::no)
    return n.stays == Near::Stays::yes;
  const auto owner = [&](size_t k) { return parts_.owner[n.triangle.v[k]]; };
  const bool stays = !((owner(0) >= 0 && owner(0) != part_ && owner(0) == owner(1) && owner(0) == owner(2)) ||
                       (leaving != 0 && stamp_[n.triangle.face / 4] == leaving) ||
                       (n.stays == Near::Stays::may_be_stale && changes.knows(n.triangle.face)));
  n.stays = stays ? Near::Stays::yes : Near::Stays::no;
  return stays;
}

// Triangles of a hole with four of them share edges, all with all: turned inside out none crosses another.
void CrossingGuard::note_edge(const Apart& apart, const std::array<int32_t, 3>& other) {
  if (apart.share_edge())
    beyond_.push_back({std::countr_zero(apart.of_first), other[std::countr_zero(apart.of_second)]});
}

// Whether they are seen not to cross without the exact test.
bool CrossingGuard::lie_beside(const FreeTriangle& a, const FreeTriangle& b, const Apart& apart) const {
  return a.runs_alike(b, apart.beside()) && side_by_side(m_.point, a, b, apart);
}

// Whether it crosses the near one, which may be itself and may not stay; their common edge is noted.
bool CrossingGuard::crosses(const FreeTriangle& now, Near& near, uint32_t leaving) {
  const FreeTriangle& other = near.triangle;
  const Apart apart(now.v, other.v);
  const bool beside = lie_beside(now, other, apart);
  // Whether it stays is further away in memory.
  if ((beside && !apart.share_edge()) || !stays_near(near, leaving))
    return false;
  note_edge(apart, other.v);
  return fold_up(m_, now, other, apart) || (!beside && triangles_cross(m_.point, now.v, other.v));
}

bool CrossingGuard::leave_part() const {
  return std::any_of(now_.begin(), now_.end(), [&](const auto& t) {
    return std::any_of(t.begin(), t.end(), [&](int32_t v) { return parts_.at(m_.point[v]) != part_; });
  });
}

bool CrossingGuard::cross(uint32_t leaving) {
  if (leave_part())
    return true;
  boxed_.clear();
  Boxf around; // all of them
  for (const auto& t : now_)
    around.add(boxed_.emplace_back(free_triangle(m_.point, t, -1)));
  if (now_.empty())
    return false;
  near_.clear();
  near_box_.clear();
  opposite_.assign(now_.size(), {-1, -1, -1});
  gather_near(changes, around, false);
  gather_near(*free_, around, true);
  for (size_t i = 0; i < now_.size(); ++i) {
    const FreeTriangle& now = boxed_[i];
    beyond_.clear();
    for (const auto& o : now_)
      note_edge(Apart(now.v, o), o);
    for (size_t j = 0; j < i; ++j)
      if (const Apart apart(now.v, now_[j]);
          fold_up(m_, now, boxed_[j], apart) ||
          (!lie_beside(now, boxed_[j], apart) && triangles_cross(m_.point, now.v, now_[j])))
        return true;
    for (const EightBoxes& eight : near_box_)
      for (uint32_t met = eight.met(now); met; met &= met - 1)
        if (crosses(now, near_[eight.id[std::countr_zero(met)]], leaving))
          return true;
    if (turns_over(now.v, leaving))
      return true;
    for (const Beyond& b : beyond_)
      opposite_[i][size_t(b.edge)] = b.apex;
  }
  return fan_turns_over();
}

void CrossingGuard::add_at(const std::vector<int32_t>& elements, int32_t v, int32_t without) {
  for (const int32_t t : elements) {
    const Element& e = m_.element[t];
    if (without >= 0 && e.find(without) >= 0)
      continue;
    for (size_t f = 0; f < 4; ++f)
      if (e.n[f] < 0 && e.v[f] != v && m_.labels[e.label[f]].curved() && m_.watched(outward_triangle(e.v, f))) {
        now_.push_back(outward_triangle(e.v, f));
        face_.push_back(4 * int64_t(t) + int64_t(f));
      }
  }
}

void CrossingGuard::note_moved() {
  for (size_t i = 0; i < face_.size(); ++i)
    changes.insert(free_triangle(m_.point, now_[i], face_[i]));
}

std::vector<int32_t> CrossingGuard::find_crossing(std::vector<int64_t> face) {
  par::sort_unique(face, 1);
  clear();
  near_.clear();
  moved_.clear();
  OpenTable has_moved;
  has_moved.reserve(face.size());
  Boxf around; // all of them
  for (const int64_t f : face) {
    const auto v = outward_triangle(m_.element[f / 4].v, size_t(f % 4));
    has_moved[uint64_t(f)] = 1;
    moved_.push_back(free_triangle(m_.point, v, f));
    near_.push_back({moved_.back(), Near::Stays::yes});
    around.add(moved_.back());
  }
  const BoxTree moved(moved_.size(), [&](size_t n) { return moved_[n]; });
  for (const FreeTriangles* const from : {&std::as_const(changes), free_})
    from->any(around, [&](const FreeTriangle& other) {
      Near n{other, from == free_ ? Near::Stays::may_be_stale : Near::Stays::not_asked};
      if (moved.any(other, [](size_t) { return true; }) && !has_moved.find(uint64_t(other.face)) &&
          stays_near(n, 0))
        near_.push_back(n);
      return false;
    });
  const BoxTree tree(near_.size(), [&](size_t n) { return near_[n].triangle; });
  SmallNumbers vertices;
  const auto add = [&](const FreeTriangle& t) { std::for_each(t.v.begin(), t.v.end(), std::ref(vertices)); };
  // Each with those after it: the first of a hole's four has the others at its edges.
  for (size_t i = 0; i < face.size(); ++i) {
    const FreeTriangle& now = near_[i].triangle;
    beyond_.clear();
    tree.any(
        now,
        [&](size_t n) {
          if (crosses(now, near_[n], 0))
            add(now), add(near_[n].triangle);
          return false;
        },
        i + 1);
    if (turns_over(now.v, 0)) {
      add(now);
      for (const Beyond& b : beyond_)
        vertices(b.apex);
    }
  }
  add_fans_that_turn_over(vertices);
  if (!vertices.met().empty() || changes.alive() > 0) {
    for (const FreeTriangle& t : moved_)
      changes.insert(t);
    moved_.clear();
  }
  return vertices.met();
}

FreeTriangleChanges CrossingGuard::take_changes() const {
  FreeTriangleChanges all = changes.changes();
  all.there.insert(all.there.end(), moved_.begin(), moved_.end());
  return all;
}

} // namespace molmesh::optimize
