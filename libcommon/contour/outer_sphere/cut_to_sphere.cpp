// cut_to_sphere.cpp — points beside the sphere move onto it, and elements that cross it are cut.
#include "contour/outer_sphere/cut_to_sphere.hpp"
#include "base/error.hpp"
#include "geom/predicates.hpp"
#include "geom/tet_measures.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>

namespace molmesh::contour {
namespace {

/// Longest edges of the elements at the surface that must lie between surface and sphere, and how many a radius is
/// proposed with: other cells may come to lie there.
constexpr double least_room = 2, proposed_room = 3;
/// A point moves onto the sphere if the sphere crosses one of its edges nearer than this share of the edge.
constexpr double near_share = 0.3;

enum Side : int8_t { within = -1, on = 0, beyond = 1 };

/// Of the mesh, that the sphere crosses.
struct Edge {
  int32_t in, out;  ///< points within and beyond
  double share = 0; ///< of the edge within
  bool operator<(const Edge& e) const { return in != e.in ? in < e.in : out < e.out; }
  bool operator==(const Edge& e) const { return in == e.in && out == e.out; }
};

class Cut {
public:
  Cut(TetMesh& mesh, const Sphere& sphere, int threads) : m_(mesh), sphere_(sphere), threads_(threads) {}

  void run() {
    require_room();
    find_sides();
    const LargeArray<int64_t> crossing = crossing_tets();
    find_edges(crossing);
    move_near_points();
    cut_tets();
    label_triangles();
    drop_unused_points();
    m_.sphere = sphere_;
  }

private:
  int64_t tets() const { return static_cast<int64_t>(m_.tet.size()); }
  Vec3d point(int32_t v) const { return m_.point[v]; }
  bool is_on(int32_t v) const { return size_t(v) >= side_.size() || side_[v] == on; }

  void require_room() const {
    std::vector<uint8_t> of_surface(m_.point.size(), 0);
    for (size_t t = 0; t < m_.tri.size(); ++t)
      if (m_.boundary[t] == Boundary::surface)
        for (const int32_t v : m_.tri[t])
          of_surface[v] = 1;
    struct Reach {
      double least = 0, proposed = 0;
    };
    const Reach reach = par::reduce(
        tets(), threads_, Reach(),
        [&](int64_t i) {
          Reach r;
          const Tet& t = m_.tet[i];
          double longest = 0;
          for (size_t j = 0; m_.region[i] == outside && j < 4; ++j) {
            if (!of_surface[t[j]])
              continue;
            for (size_t k = 0; longest == 0 && k < 6; ++k)
              for (size_t l = 0; l < k; ++l)
                if (k < 4)
                  longest = std::max(longest, norm(point(t[k]) - point(t[l])));
            const double far = norm(point(t[j]) - sphere_.center);
            r.least = std::max(r.least, far + least_room * longest);
            r.proposed = std::max(r.proposed, far + proposed_room * longest);
          }
          return r;
        },
        [](Reach a, const Reach& b) {
          return Reach{std::max(a.least, b.least), std::max(a.proposed, b.proposed)};
        });
    if (reach.least <= sphere_.radius)
      return;
    char text[200];
    std::snprintf(text, sizeof text,
                  "the sphere of %.3f Å about %.3f %.3f %.3f meets the molecule's surface or comes too near it, "
                  "expected a radius of at least %.1f Å",
                  sphere_.radius, sphere_.center.x, sphere_.center.y, sphere_.center.z,
                  std::ceil(10 * reach.proposed) / 10);
    fail(Status::failed, text, {"box"});
  }

  void find_sides() {
    side_.resize(m_.point.size());
    par::for_n(static_cast<int64_t>(side_.size()), threads_,
               [&](int64_t v) { side_[v] = sphere_.height(m_.point[v]) > 0 ? beyond : within; });
  }

  bool has(const Tet& t, Side s) const {
    return std::any_of(t.begin(), t.end(), [&](int32_t v) { return side_[v] == s; });
  }
  LargeArray<int64_t> crossing_tets() const {
    return par::select<int64_t>(tets(), threads_,
                                [&](int64_t i) { return has(m_.tet[i], within) && has(m_.tet[i], beyond); });
  }

  double share_within(Vec3d in, Vec3d out) const {
    const Vec3d along = out - in, from = in - sphere_.center;
    const double a = norm2(along), b = dot(from, along),
                 c = (norm(from) - sphere_.radius) * (norm(from) + sphere_.radius);
    const double root = std::sqrt(std::max(0., b * b - a * c));
    return std::clamp(b > 0 ? -c / (b + root) : (root - b) / a, 0., 1.);
  }

  void find_edges(const LargeArray<int64_t>& crossing) {
    edge_.clear();
    for (const int64_t i : crossing) {
      const Tet& t = m_.tet[i];
      for (const int32_t v : t)
        for (const int32_t w : t)
          if (side_[v] == within && side_[w] == beyond)
            edge_.push_back({v, w, 0});
    }
    par::sort_unique(edge_, threads_);
    par::for_n(static_cast<int64_t>(edge_.size()), threads_, [&](int64_t e) {
      Edge& edge = edge_[e];
      edge.share = share_within(point(edge.in), point(edge.out));
    });
  }

  // In the order of how near the sphere crosses: what moves makes others' edges cross no more. A point whose
  // elements would not stay positive goes back.
  void move_near_points() {
    struct End {
      int32_t v, edge;
      bool operator<(const End& e) const { return v != e.v ? v < e.v : edge < e.edge; }
    };
    std::vector<End> ends;
    for (size_t e = 0; e < edge_.size(); ++e) {
      ends.push_back({edge_[e].in, static_cast<int32_t>(e)});
      ends.push_back({edge_[e].out, static_cast<int32_t>(e)});
    }
    std::sort(ends.begin(), ends.end());
    struct Near {
      double share;
      size_t first, last; ///< of its edges in ends
      bool operator<(const Near& n) const { return share != n.share ? share < n.share : first < n.first; }
    };
    // Of the edges that the sphere still crosses.
    const auto nearest = [&](size_t first, size_t last) {
      double share = 1;
      for (size_t i = first; i < last; ++i) {
        const Edge& e = edge_[ends[i].edge];
        if (side_[e.in] == within && side_[e.out] == beyond)
          share = std::min(share, e.in == ends[i].v ? e.share : 1 - e.share);
      }
      return share;
    };
    std::vector<Near> near;
    for (size_t i = 0, j; i < ends.size(); i = j) {
      for (j = i; j < ends.size() && ends[j].v == ends[i].v;)
        ++j;
      if (const double share = nearest(i, j); share < near_share)
        near.push_back({share, i, j});
    }
    std::sort(near.begin(), near.end());
    for (const Near& n : near)
      if (nearest(n.first, n.last) < near_share) {
        const int32_t v = ends[n.first].v;
        moved_.push_back({v, side_[v], point(v)});
        side_[v] = on;
        m_.point[v] = sphere_.nearest(point(v));
      }
    std::sort(moved_.begin(), moved_.end(), [](const Moved& a, const Moved& b) { return a.v < b.v; });
    put_back_bad();
  }

  void put_back_bad() {
    const LargeArray<int64_t> touched =
        par::select<int64_t>(tets(), threads_, [&](int64_t i) { return has(m_.tet[i], on); });
    for (bool again = true; again;) {
      again = false;
      for (const int64_t i : touched) {
        const Tet& t = m_.tet[i];
        if (!has(t, within) || is_positive(t))
          continue;
        Moved* farthest = nullptr;
        for (const int32_t v : t)
          if (side_[v] == on) {
            Moved& mv = *std::lower_bound(moved_.begin(), moved_.end(), v,
                                          [](const Moved& a, int32_t b) { return a.v < b; });
            if (!farthest || norm2(mv.from - point(v)) > norm2(farthest->from - point(farthest->v)))
              farthest = &mv;
          }
        if (!farthest)
          continue;
        side_[farthest->v] = farthest->side;
        m_.point[farthest->v] = farthest->from;
        again = true;
      }
    }
  }

  bool is_positive(const Tet& t) const { return orient3d(point(t[0]), point(t[1]), point(t[2]), point(t[3])) > 0; }

  // The points on edges that still cross come behind all others.
  void place_crossings() {
    std::erase_if(edge_, [&](const Edge& e) { return side_[e.in] != within || side_[e.out] != beyond; });
    first_ = static_cast<int32_t>(m_.point.size());
    for (const Edge& e : edge_)
      m_.point.push_back(sphere_.nearest(point(e.in) + e.share * (point(e.out) - point(e.in))));
  }
  size_t edge_between(int32_t in, int32_t out) const {
    return size_t(std::lower_bound(edge_.begin(), edge_.end(), Edge{in, out}) - edge_.begin());
  }
  int32_t crossing(int32_t in, int32_t out) const { return first_ + static_cast<int32_t>(edge_between(in, out)); }
  /// Whether p comes before q among the points within that have edges to `out`: of two such edges the shorter part
  /// within gets the diagonal of the face between them, which is the shorter one then.
  bool before(int32_t p, int32_t q, int32_t out) const {
    const auto length = [&](int32_t v) { return norm2(m_.point[size_t(crossing(v, out))] - point(v)); };
    const double lp = length(p), lq = length(q);
    return lp != lq ? lp > lq : p < q;
  }

  void cut_tets() {
    place_crossings();
    size_t kept = 0;
    std::vector<Tet> cut;
    std::vector<int32_t> region;
    for (size_t i = 0; i < m_.tet.size(); ++i) {
      const Tet t = m_.tet[i];
      if (!has(t, within))
        continue;
      if (has(t, beyond)) {
        cut_tet(t, cut);
        region.resize(cut.size(), m_.region[i]);
      } else {
        m_.tet[kept] = t;
        m_.region[kept++] = m_.region[i];
      }
    }
    if (!std::all_of(cut.begin(), cut.end(), [&](const Tet& t) { return is_positive(t); }))
      fail(Status::failed, "an element that the sphere cuts has no volume left, expected another radius", {"box"});
    m_.tet.resize(kept);
    m_.region.resize(kept);
    m_.tet.insert(m_.tet.end(), cut.begin(), cut.end());
    m_.region.insert(m_.region.end(), region.begin(), region.end());
  }

  void cut_tet(Tet t, std::vector<Tet>& out) const {
    // Points within, on and beyond in this order, by an even permutation.
    int swaps = 0;
    for (size_t i = 1; i < 4; ++i)
      for (size_t j = i; j > 0 && side_[t[j - 1]] > side_[t[j]]; --j)
        std::swap(t[j - 1], t[j]), ++swaps;
    const auto count = [&](Side s) {
      return std::count_if(t.begin(), t.end(), [&](int32_t v) { return side_[v] == s; });
    };
    const bool turned = swaps % 2 != 0;
    const auto end = [&](int32_t in, int32_t v) { return side_[v] == on ? v : crossing(in, v); };
    const int32_t a = t[0], b = t[1], c = t[2], d = t[3];
    switch (count(within)) {
    case 1:
      add({a, end(a, b), end(a, c), end(a, d)}, turned, out);
      break;
    case 2:
      if (count(on) == 1) {
        const bool a_first = before(a, b, d);
        prism({a, b, c}, {crossing(a, d), crossing(b, d), c}, a_first ? Order{0, 1, 2} : Order{1, 0, 2}, turned,
              out);
      } else {
        // Columns a to b, and on the sphere between the edges to c, to d.
        const int32_t ac = crossing(a, c), ad = crossing(a, d), bc = crossing(b, c), bd = crossing(b, d);
        const bool c_later = before(a, b, c), d_later = before(a, b, d);
        const bool c_first =
            c_later == d_later ? norm2(point(ac) - point(bd)) <= norm2(point(ad) - point(bc)) : d_later;
        const Order order = c_later && d_later ? (c_first ? Order{0, 1, 2} : Order{0, 2, 1})
                            : c_later          ? Order{2, 0, 1}
                            : d_later          ? Order{1, 0, 2}
                                               : (c_first ? Order{1, 2, 0} : Order{2, 1, 0});
        prism({a, ac, ad}, {b, bc, bd}, order, turned, out);
      }
      break;
    default: {
      Order order{0, 1, 2};
      const std::array<int32_t, 3> in{a, b, c};
      std::sort(order.begin(), order.end(), [&](size_t i, size_t j) { return before(in[i], in[j], d); });
      prism({a, b, c}, {crossing(a, d), crossing(b, d), crossing(c, d)}, order, turned, out);
    }
    }
  }

  using Order = std::array<size_t, 3>;
  /// Three elements, or two where a column has no length. (bottom, a point of the top) is positive unless turned.
  /// Diagonals run from the bottom of a column to the top of those that come later in the order.
  static void prism(const std::array<int32_t, 3>& bottom, const std::array<int32_t, 3>& top, const Order& order,
                    bool turned, std::vector<Tet>& out) {
    const auto [i, j, k] = order;
    const bool odd = (j + 3 - i) % 3 != 1;
    if (bottom[k] != top[k])
      add({bottom[i], bottom[j], bottom[k], top[k]}, turned != odd, out);
    if (bottom[j] != top[j])
      add({bottom[i], bottom[j], top[k], top[j]}, turned != odd, out);
    if (bottom[i] != top[i])
      add({bottom[i], top[i], top[j], top[k]}, turned != odd, out);
  }
  static void add(Tet t, bool turned, std::vector<Tet>& out) {
    if (turned)
      std::swap(t[2], t[3]);
    out.push_back(t);
  }

  // Faces of three points on the sphere that one element has.
  void label_triangles() {
    struct Face {
      Tri sorted, outward;
      bool operator<(const Face& f) const { return sorted < f.sorted; }
    };
    const auto candidate = par::select<int64_t>(tets(), threads_, [&](int64_t i) {
      const Tet& t = m_.tet[i];
      return std::count_if(t.begin(), t.end(), [&](int32_t v) { return is_on(v); }) >= 3;
    });
    std::vector<Face> face;
    for (const int64_t i : candidate) {
      const Tet& t = m_.tet[i];
      for (int f = 0; f < 4; ++f) {
        const Tri outward{t[tet_face(f, 0)], t[tet_face(f, 1)], t[tet_face(f, 2)]};
        if (!std::all_of(outward.begin(), outward.end(), [&](int32_t v) { return is_on(v); }))
          continue;
        Tri sorted = outward;
        std::sort(sorted.begin(), sorted.end());
        face.push_back({sorted, outward});
      }
    }
    par::sort(face, threads_);
    size_t kept = 0;
    for (size_t t = 0; t < m_.tri.size(); ++t)
      if (m_.boundary[t] < Boundary::box_x0 || m_.boundary[t] > Boundary::box_z1) {
        m_.tri[kept] = m_.tri[t];
        m_.boundary[kept++] = m_.boundary[t];
      }
    m_.tri.resize(kept);
    for (size_t i = 0, j; i < face.size(); i = j) {
      for (j = i; j < face.size() && face[j].sorted == face[i].sorted;)
        ++j;
      if (j == i + 1)
        m_.tri.push_back(face[i].outward);
    }
    m_.boundary.resize(kept);
    m_.boundary.resize(m_.tri.size(), Boundary::outer_sphere);
  }

  void drop_unused_points() {
    std::vector<int32_t> number(m_.point.size(), -1);
    for (const Tet& t : m_.tet)
      for (const int32_t v : t)
        number[v] = 0;
    int32_t used = 0;
    for (size_t v = 0; v < number.size(); ++v)
      if (number[v] == 0) {
        m_.point[used] = m_.point[v];
        number[v] = used++;
      }
    m_.point.resize(size_t(used));
    const auto renumber = [&](auto& cells) {
      par::for_n(static_cast<int64_t>(cells.size()), threads_, [&](int64_t i) {
        for (int32_t& v : cells[i])
          v = number[v];
      });
    };
    renumber(m_.tet);
    renumber(m_.tri);
  }

  struct Moved {
    int32_t v;
    Side side;
    Vec3d from;
  };
  TetMesh& m_;
  const Sphere sphere_;
  const int threads_;
  std::vector<Side> side_; ///< [points of the box]
  std::vector<Edge> edge_; ///< ascending
  std::vector<Moved> moved_;
  int32_t first_ = 0; ///< point on an edge
};

} // namespace

void cut_to_sphere(TetMesh& mesh, const Sphere& sphere, int threads) {
  Cut(mesh, sphere, threads).run();
}

} // namespace molmesh::contour
