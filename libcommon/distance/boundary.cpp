// boundary.cpp — for each ball the caps that others cut off its sphere, and the arcs that no cap covers.
#include "distance/boundary.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::distance {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Two directions at right angles to `axis` and to each other.
void span_plane(Vec3d axis, Vec3d& first, Vec3d& second) {
  const Vec3d least = std::abs(axis.x) < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  first = cross(axis, least);
  first = first / norm(first);
  second = cross(axis, first);
}

class BallCaps {
public:
  BallCaps(const UnionOfBalls& balls, double tolerance) : balls_(balls), tolerance_(tolerance) {}
  /// Caps of ball i, the largest first, without those within a larger one.
  const std::vector<Cap>& find(int32_t i) {
    const Ball& b = ball(i);
    near_.clear();
    all_.clear();
    kept_.clear();
    balls_.find_meeting(b, near_);
    for (const int32_t k : near_)
      if (k != i)
        add(b, ball(k), k);
    std::sort(all_.begin(), all_.end(), [](const Cap& a, const Cap& c) {
      return a.height != c.height ? a.height < c.height : a.other < c.other;
    });
    for (const Cap& c : all_)
      if (std::none_of(kept_.begin(), kept_.end(), [&](const Cap& larger) { return within(c, larger); }))
        kept_.push_back(c);
    return kept_;
  }
  const Ball& ball(int32_t i) const { return balls_.balls()[static_cast<size_t>(i)]; }

private:
  void add(const Ball& b, const Ball& other, int32_t number) {
    const Vec3d between = other.center - b.center;
    const double d = norm(between);
    if (!(d > 0)) // equal centres and radii: left out
      return;
    // (R² + d² - S²) / 2dR without the difference of large squares
    const double height = (d + (b.radius - other.radius) * ((b.radius + other.radius) / d)) / (2 * b.radius);
    if (height > -1 && height < 1)
      all_.push_back({between / d, height, std::sqrt((1 - height) * (1 + height)),
                      tolerance_ * other.radius / (d * b.radius), number});
  }
  /// By angles: larger ≥ between + smaller. Not of equal caps: either may bound the free part of the other's
  /// sphere.
  static bool within(const Cap& c, const Cap& larger) {
    constexpr double rounding = 1e-12;
    return dot(c.normal, larger.normal) >=
           larger.height * c.height + larger.circle_radius * c.circle_radius + rounding;
  }

  const UnionOfBalls& balls_;
  const double tolerance_;
  std::vector<int32_t> near_;
  std::vector<Cap> all_, kept_;
};

/// Arcs of one ball with those of higher number, and their ends.
class BallArcs {
public:
  void find(const Ball& b, int32_t number, const std::vector<Cap>& caps, std::vector<Arc>& arc,
            std::vector<Vec3d>& vertex) {
    const size_t first_vertex = vertex.size();
    for (const Cap& c : caps)
      if (c.other > number && uncovered(c, caps))
        add(b, number, c, arc, vertex, first_vertex);
  }

private:
  /// Where the directions t of a circle with a·cos t + b·sin t > c lie in a cap.
  struct Cover {
    double a, b, c;
  };
  struct Interval {
    double begin, end; ///< begin in [0, 2π)
  };

  /// Finds the caps that cover parts of the circle that ends a cap. False when one covers all of it.
  bool uncovered(const Cap& own, const std::vector<Cap>& caps) {
    cover_.clear();
    span_plane(own.normal, first_, second_);
    for (const Cap& o : caps) {
      if (&o == &own)
        continue;
      const Cover v{own.circle_radius * dot(first_, o.normal), own.circle_radius * dot(second_, o.normal),
                    o.buries() - own.height * dot(own.normal, o.normal)};
      if (v.c * v.c < v.a * v.a + v.b * v.b)
        cover_.push_back(v);
      else if (v.c < 0)
        return false;
    }
    return true;
  }

  void add(const Ball& b, int32_t number, const Cap& own, std::vector<Arc>& arc, std::vector<Vec3d>& vertex,
           size_t first_vertex) {
    const Arc circle{b.center + (own.height * b.radius) * own.normal,
                     own.normal,
                     first_,
                     second_,
                     b.radius * own.circle_radius,
                     1,
                     0,
                     Arc::Length::circle,
                     {number, own.other}};
    if (cover_.empty())
      return arc.push_back(circle);
    interval_.clear();
    double covered = -1e300; // up to here, from the turn before
    for (const Cover& v : cover_) {
      const double middle = std::atan2(v.b, v.a), half = std::acos(v.c / std::sqrt(v.a * v.a + v.b * v.b));
      double begin = middle - half;
      begin += begin < 0 ? 2 * pi : 0;
      interval_.push_back({begin, begin + 2 * half});
      covered = std::max(covered, interval_.back().end - 2 * pi);
    }
    std::sort(interval_.begin(), interval_.end(), [](Interval p, Interval q) { return p.begin < q.begin; });
    for (const Interval& i : interval_) {
      if (i.begin > covered) {
        const double c = std::cos(covered), s = std::sin(covered), length = i.begin - covered;
        Arc a = circle;
        a.first = c * first_ + s * second_;
        a.second = c * second_ - s * first_;
        a.end_x = std::cos(length);
        a.end_y = std::sin(length);
        a.length = length > pi ? Arc::Length::long_arc : Arc::Length::short_arc;
        arc.push_back(a);
        add_vertex(a.place(1, 0), vertex, first_vertex);
        add_vertex(a.place(a.end_x, a.end_y), vertex, first_vertex);
      }
      covered = std::max(covered, i.end);
    }
  }
  /// Most ends are those of two of the ball's arcs.
  static void add_vertex(Vec3d v, std::vector<Vec3d>& vertex, size_t first) {
    constexpr double same = 1e-8; // Å
    for (size_t i = first; i < vertex.size(); ++i)
      if (norm2(vertex[i] - v) < same * same)
        return;
    vertex.push_back(v);
  }

  Vec3d first_, second_;
  std::vector<Cover> cover_;
  std::vector<Interval> interval_;
};

/// What a run of balls adds.
struct Part {
  std::vector<Arc> arc;
  std::vector<Vec3d> vertex;
  std::vector<int32_t> alone; ///< balls without caps
  std::vector<Cap> cap;
};

template <class T>
void append(std::vector<T>& to, std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
  from = {};
}

double tolerance_for(const std::vector<Ball>& balls) {
  double farthest = 0;
  for (const Ball& b : balls)
    for (int a = 0; a < 3; ++a)
      farthest = std::max(farthest, std::abs(b.center[a]) + b.radius);
  return 1e-9 + 0x1p-48 * farthest;
}

} // namespace

Ball Arc::bounds() const {
  if (length != Length::short_arc)
    return {middle, radius};
  const Vec3d begin = place(1, 0), end = place(end_x, end_y), half = 0.5 * (begin + end);
  // The middle of the arc may be farther from the chord's middle than its ends.
  const double chord = 0.5 * norm(end - begin), rise = radius - norm(half - middle);
  return {half, std::max(chord, rise)};
}

Boundary boundary_of(const UnionOfBalls& balls, int threads, const Region& region) {
  constexpr int64_t at_once = 128;
  const int64_t n = balls.size(), parts = (n + at_once - 1) / at_once;
  Boundary all;
  all.tolerance = tolerance_for(balls.balls());
  // An arc is that of the lower number, which may be a ball that meets one of the region.
  double largest = 0;
  for (const Ball& b : balls.balls())
    largest = std::max(largest, b.radius);
  const Vec3d more = 2 * largest * Vec3d{1, 1, 1};
  const Region around{region.lo - more, region.hi + more};
  std::vector<Part> part(static_cast<size_t>(parts));
  const auto each = [&](int64_t p, auto&& use) {
    for (int64_t i = p * at_once; i < std::min(n, (p + 1) * at_once); ++i)
      use(static_cast<int32_t>(i));
  };
  par::for_n(parts, threads, 1, [&](int64_t p) {
    BallCaps caps(balls, all.tolerance);
    BallArcs arcs;
    Part& to = part[static_cast<size_t>(p)];
    each(p, [&](int32_t i) {
      if (!around.meets(caps.ball(i)))
        return;
      const std::vector<Cap>& of = caps.find(i);
      if (of.empty())
        to.alone.push_back(i);
      arcs.find(caps.ball(i), i, of, to.arc, to.vertex);
    });
  });
  all.free.resize(static_cast<size_t>(n));
  for (Part& p : part) {
    for (const int32_t i : p.alone)
      all.free[static_cast<size_t>(i)] = 1;
    for (const Arc& a : p.arc)
      for (const int32_t b : a.ball)
        all.free[static_cast<size_t>(b)] = 1;
    append(all.arc, p.arc);
    append(all.vertex, p.vertex);
  }
  par::for_n(n, threads, 4096, [&](int64_t i) {
    const auto b = static_cast<size_t>(i);
    all.free[b] = all.free[b] && region.meets(balls.balls()[b]);
  });
  all.cap_begin.resize(static_cast<size_t>(n) + 1);
  par::for_n(parts, threads, 1, [&](int64_t p) {
    BallCaps caps(balls, all.tolerance);
    each(p, [&](int32_t i) {
      if (!all.free[static_cast<size_t>(i)])
        return;
      const std::vector<Cap>& of = caps.find(i);
      all.cap_begin[static_cast<size_t>(i)] = static_cast<int64_t>(of.size());
      std::vector<Cap>& to = part[static_cast<size_t>(p)].cap;
      to.insert(to.end(), of.begin(), of.end());
    });
  });
  par::exclusive_scan(all.cap_begin);
  for (Part& p : part)
    append(all.cap, p.cap);
  return all;
}

} // namespace molmesh::distance
