// validity.cpp — checks rule after rule, each over all of its items.
#include "mesh/validity.hpp"
#include "geom/predicates.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/surface_crossings.hpp"
#include "mesh/triangle_match.hpp"
#include "mesh/validity_covering.hpp"
#include "mesh/validity_duplicates.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh {
namespace {

struct Tally {
  int64_t count = 0, first = -1;
};
template <class Broken>
Tally tally(int64_t n, int threads, Broken broken) {
  return par::reduce(
      n, threads, Tally{},
      [&](int64_t i) {
        return broken(i) ? Tally{1, i} : Tally{};
      },
      [](Tally a, Tally b) {
        return Tally{a.count + b.count, a.first >= 0 ? a.first : b.first};
      });
}

template <class Cell>
std::string described(const char* what, int64_t i, const Cell& cell) {
  std::string s = what + (' ' + std::to_string(i)) + " (points";
  for (int32_t v : cell)
    s += ' ' + std::to_string(v);
  return s + ')';
}

class Checker {
public:
  Checker(const TetMesh& m, int threads) : m_(m), threads_(threads) {}

  Validity check() {
    if (!check_indices())
      return std::move(v_);
    check_tets();
    check_points();
    across_ = face_neighbors(m_, threads_);
    check_faces();
    side_ = boundary_faces(m_, across_, threads_);
    check_triangles();
    check_regions();
    check_box();
    if (v_.valid())
      check_skin();
    return std::move(v_);
  }

private:
  std::string tet(int64_t i) const { return described("tet", i, m_.tet[i]); }
  std::string tri(int64_t i) const { return described("triangle", i, m_.tri[i]); }
  std::string face(int64_t i) const { return described("face of tet", i / 4, face_points(m_, i)); }
  void fault(const char* rule, int64_t count, const std::string& example) {
    if (count > 0)
      v_.faults.push_back({rule, count, example});
  }
  template <class Describe>
  void fault(const char* rule, Tally t, Describe describe) {
    if (t.count > 0)
      fault(rule, t.count, describe(t.first));
  }
  Vec3d point(int32_t i) const { return m_.point[i]; }
  int64_t tets() const { return static_cast<int64_t>(m_.tet.size()); }
  int64_t tris() const { return static_cast<int64_t>(m_.tri.size()); }
  int64_t points() const { return static_cast<int64_t>(m_.point.size()); }

  bool check_indices() {
    const auto outside = [&](const auto& cell) {
      for (int32_t v : cell)
        if (v < 0 || v >= points())
          return true;
      return false;
    };
    fault("index", tally(tets(), threads_, [&](int64_t i) { return outside(m_.tet[i]); }),
          [&](int64_t i) { return tet(i); });
    if (!v_.valid())
      return false;
    fault("index", tally(tris(), threads_, [&](int64_t i) { return outside(m_.tri[i]); }),
          [&](int64_t i) { return tri(i); });
    return v_.valid();
  }

  void check_tets() {
    const auto flat = [&](int64_t i) {
      const Tet& t = m_.tet[i];
      return orient3d(point(t[0]), point(t[1]), point(t[2]), point(t[3])) <= 0;
    };
    fault("volume", tally(tets(), threads_, flat), [&](int64_t i) { return tet(i); });
  }

  void check_points() {
    const std::vector<int32_t> twin = point_twins(m_.point, threads_);
    fault("duplicate_point", tally(points(), threads_, [&](int64_t i) { return twin[i] >= 0; }),
          [&](int64_t i) { return "points " + std::to_string(twin[i]) + " and " + std::to_string(i); });
    std::vector<uint8_t> used(m_.point.size(), 0);
    for (const Tet& t : m_.tet)
      for (int32_t i : t)
        used[i] = 1;
    fault("unused_point", tally(points(), threads_, [&](int64_t i) { return !used[i]; }),
          [&](int64_t i) { return "point " + std::to_string(i); });
  }

  void check_faces() {
    const std::vector<int64_t> copies = tet_copies(m_, across_);
    if (!copies.empty())
      fault("duplicate_tet", static_cast<int64_t>(copies.size()), tet(copies.front()));
    const auto neighbor = [&](int64_t f) { return across_[f]; };
    fault("crowded_face", tally(4 * tets(), threads_, [&](int64_t f) { return neighbor(f) == crowded_face; }),
          [&](int64_t f) { return face(f); });
    const auto folded = [&](int64_t f) {
      return neighbor(f) > f && same_turn(face_points(m_, f), face_points(m_, neighbor(f)));
    };
    fault("folded_face", tally(4 * tets(), threads_, folded), [&](int64_t f) { return face(f); });
  }

  void check_triangles() {
    TriangleMatch match = match_triangles(m_, across_, side_, threads_);
    const int64_t n = static_cast<int64_t>(match.owner.size());
    const auto count = [&](const char* rule, TriangleMatch::Kind broken) {
      fault(rule, tally(n + tris(), threads_, [&](int64_t i) { return match.kind[i] == broken; }),
            [&](int64_t i) { return i < n ? face(match.owner[i]) : tri(i - n); });
    };
    count("missing_triangle", TriangleMatch::missing);
    count("stray_triangle", TriangleMatch::stray);
    count("duplicate_triangle", TriangleMatch::twice);
    count("triangle_orientation", TriangleMatch::turned);
    one_sided_ = std::move(match.one_sided);
  }

  void check_regions() {
    v_.region = summarize_regions(m_, side_, threads_);
    SurfaceFaults all;
    std::string open, crowded_edge, pinched;
    for (const RegionSummary& r : v_.region) {
      const SurfaceFaults& f = r.boundary.faults;
      const std::string of = " of region " + std::to_string(r.region);
      const auto edge = [&](std::array<int32_t, 2> e) {
        return "edge (points " + std::to_string(e[0]) + ' ' + std::to_string(e[1]) + ')' + of;
      };
      if (all.open_edges == 0 && f.open_edges)
        open = edge(f.open_edge);
      if (all.crowded_edges == 0 && f.crowded_edges)
        crowded_edge = edge(f.crowded_edge);
      if (all.pinched_points == 0 && f.pinched_points)
        pinched = "point " + std::to_string(f.pinched_point) + of;
      all.open_edges += f.open_edges;
      all.crowded_edges += f.crowded_edges;
      all.pinched_points += f.pinched_points;
      v_.volume += r.volume;
    }
    fault("open_edge", all.open_edges, open);
    fault("crowded_edge", all.crowded_edges, crowded_edge);
    fault("pinched_point", all.pinched_points, pinched);
    v_.surface = summary_of(Boundary::surface);
    if (m_.sphere)
      v_.outer_sphere = summary_of(Boundary::outer_sphere);
  }

  SurfaceSummary summary_of(int32_t label) const {
    std::vector<Tri> tri;
    for (size_t t = 0; t < m_.tri.size(); ++t)
      if (m_.boundary[t] == label)
        tri.push_back(m_.tri[t]);
    return summarize_surface(m_.point, tri, threads_);
  }

  void check_box() {
    if (m_.point.empty())
      return;
    v_.low = v_.high = m_.point[0];
    for (const Vec3d& p : m_.point)
      for (int k = 0; k < 3; ++k) {
        v_.low[k] = std::min(v_.low[k], p[k]);
        v_.high[k] = std::max(v_.high[k], p[k]);
      }
    const auto within = [](const std::vector<int32_t>& labels, int32_t last) {
      return std::all_of(labels.begin(), labels.end(), [&](int32_t l) { return l >= 1 && l <= last; });
    };
    const RegionOrder order(m_);
    const bool has_domains = order.last_domain > Region::cavity;
    if (!within(m_.region, order.last_domain) || !within(m_.boundary, has_domains ? INT32_MAX : Boundary::box_z1))
      return;
    if (m_.sphere) {
      check_sphere();
      return;
    }
    const auto side = [&](int64_t t) {
      return m_.boundary[t] > Boundary::box_z1 ? -1 : m_.boundary[t] - Boundary::box_x0;
    };
    int sides = 0;
    bool closed = true; // by the box alone
    for (int64_t t = 0; t < tris(); ++t) {
      if (side(t) >= 0)
        sides |= 1 << side(t);
      else if (one_sided_[t])
        closed = false;
    }
    const auto in_plane = [&](int64_t t, int s) {
      const double plane = s % 2 == 0 ? v_.low[s / 2] : v_.high[s / 2];
      for (int32_t i : m_.tri[t])
        if (point(i)[s / 2] != plane)
          return false;
      return true;
    };
    const auto wrong_label = [&](int64_t t) {
      if (side(t) >= 0)
        return !one_sided_[t];
      for (int s = 0; s < 6; ++s)
        if ((sides >> s & 1) && one_sided_[t] && in_plane(t, s))
          return true;
      return false;
    };
    fault("box_label", tally(tris(), threads_, wrong_label), [&](int64_t t) { return tri(t); });
    fault("box_plane", tally(tris(), threads_, [&](int64_t t) { return side(t) >= 0 && !in_plane(t, side(t)); }),
          [&](int64_t t) { return tri(t); });
    if (sides != 63 || !closed)
      return;
    const Vec3d extent = v_.high - v_.low;
    const double box = extent.x * extent.y * extent.z;
    constexpr double tolerance = 1e-12; // what rounding of each volume can add up to is well below
    if (!(std::fabs(v_.volume - box) <= tolerance * box))
      fault("box_volume", 1,
            "volumes add up to " + std::to_string(v_.volume) + " Å³, the box has " + std::to_string(box) + " Å³");
  }

  // The outer boundary is a sphere.
  void check_sphere() {
    const auto wrong_label = [&](int64_t t) {
      const int32_t label = m_.boundary[t];
      return (label > Boundary::outer_sphere && label <= Boundary::box_z1) ||
             (label == Boundary::outer_sphere && !one_sided_[t]);
    };
    fault("sphere_label", tally(tris(), threads_, wrong_label), [&](int64_t t) { return tri(t); });
    const auto off = [&](int64_t t) {
      return m_.boundary[t] == Boundary::outer_sphere &&
             std::any_of(m_.tri[t].begin(), m_.tri[t].end(), [&](int32_t v) {
               return !(std::fabs(m_.sphere->height(point(v))) <= m_.sphere->rounding());
             });
    };
    fault("sphere_point", tally(tris(), threads_, off), [&](int64_t t) { return tri(t); });
  }

  void check_skin() {
    std::vector<int64_t> skin;
    for (const int64_t f : side_)
      if (across_[f] == no_face)
        skin.push_back(f);
    const Covering c = check_covering(m_, skin, threads_);
    fault("overlap", c.wrong, c.wrong > 0 ? face(c.face) : "");
  }

  const TetMesh& m_;
  int threads_;
  Validity v_;
  LargeArray<int32_t> across_;
  std::vector<int64_t> side_;
  std::vector<uint8_t> one_sided_; ///< [tris] on a face with one tetrahedron
};

} // namespace

Validity check_validity(const TetMesh& m, int threads) {
  return Checker(m, threads).check();
}

void add_crossings(Validity& v, const TetMesh& m, int threads) {
  if (v.region.empty())
    return; // points out of range
  std::vector<Tri> tri;
  std::vector<int64_t> number;
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (m.boundary[t] < Boundary::box_x0 || m.boundary[t] > Boundary::box_z1) {
      tri.push_back(m.tri[t]);
      number.push_back(static_cast<int64_t>(t));
    }
  const Crossings c = find_crossings(m.point, tri, threads);
  if (c.pairs == 0)
    return;
  const auto name = [&](int32_t t) { return described("triangle", number[t], tri[t]); };
  v.faults.push_back({"crossing_triangles", c.pairs, name(c.first[0]) + " and " + name(c.first[1])});
}

} // namespace molmesh
