// relax.cpp — proposals from frozen positions, of which an independent set is taken, round by round.
#include "contour/relax.hpp"
#include "contour/detail/at.hpp"
#include "improve/search.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::contour {

using detail::at;
namespace {

constexpr double least_angle = 13; // degrees; 160° counts alike
constexpr int most_rounds = 8;

struct Candidate {
  int32_t vertex;
  uint8_t frozen;     ///< bit a: on a wall across axis a
  int64_t begin, end; ///< its elements, in Relaxation::element_
  bool waiting = true;
  float worst = 0, proposed = -1; ///< quality now; at `place`, -1: no better place
  Vec3d place;
};

class Relaxation {
public:
  Relaxation(Elements& elements, const std::vector<uint8_t>& lattice_class, int threads)
      : e_(elements), threads_(threads) {
    const auto n = static_cast<int64_t>(e_.tet.size());
    quality_.resize(at(n));
    par::for_n(n, threads_, [&](int64_t t) {
      const Tet& v = e_.tet[at(t)];
      quality_[at(t)] = of_lattice(v, lattice_class) ? 1 : quality(v);
    });
    find_candidates();
  }

  int64_t round() {
    const auto n = static_cast<int64_t>(candidate_.size());
    par::for_n(n, threads_, 16, [&](int64_t i) { propose(candidate_[at(i)]); });
    std::vector<uint8_t> taken(at(n));
    par::for_n(n, threads_, 64, [&](int64_t i) { taken[at(i)] = first_among_neighbours(i); });
    int64_t moved = 0;
    for (int64_t i = 0; i < n; ++i)
      if (taken[at(i)]) {
        take(candidate_[at(i)]);
        ++moved;
      }
    return moved;
  }

private:
  /// An edge of the lattice with the middles of two boxes of one size.
  static bool of_lattice(const Tet& t, const std::vector<uint8_t>& lattice_class) {
    const auto known = static_cast<int32_t>(lattice_class.size());
    if (std::any_of(t.begin(), t.end(), [&](int32_t v) { return v >= known; }))
      return false;
    const auto of = [&](size_t i) { return lattice_class[at(t[i])]; };
    return of(0) == 1 && of(1) == 1 && of(2) >= 2 && of(2) == of(3);
  }

  float quality(const Tet& t) const {
    return improve::tet_quality(e_.position[at(t[0])], e_.position[at(t[1])], e_.position[at(t[2])],
                                e_.position[at(t[3])]);
  }

  void find_candidates() {
    std::vector<int32_t> number(e_.position.size(), none);
    std::vector<uint8_t> frozen(e_.position.size(), 0);
    for (size_t i = 0; i < e_.tri.size(); ++i)
      for (int32_t v : e_.tri[i]) {
        if (e_.boundary[i] == surface)
          number[at(v)] = bound;
        else
          frozen[at(v)] = static_cast<uint8_t>(frozen[at(v)] | 1 << (e_.boundary[i] - box_x0) / 2);
      }
    for (size_t t = 0; t < e_.tet.size(); ++t)
      if (quality_[t] < goal_)
        for (int32_t v : e_.tet[t])
          if (number[at(v)] == none) {
            number[at(v)] = static_cast<int32_t>(candidate_.size());
            candidate_.push_back({v, frozen[at(v)], 0, 0, true, 0, -1, {}});
          }
    std::vector<int64_t> start(candidate_.size());
    for (const Tet& t : e_.tet)
      for (int32_t v : t)
        if (number[at(v)] >= 0)
          ++start[at(number[at(v)])];
    element_.resize(at(par::exclusive_scan(start)));
    for (size_t i = 0; i < candidate_.size(); ++i)
      candidate_[i].begin = candidate_[i].end = start[i];
    for (size_t t = 0; t < e_.tet.size(); ++t)
      for (int32_t v : e_.tet[t])
        if (number[at(v)] >= 0)
          element_[at(candidate_[at(number[at(v)])].end++)] = static_cast<int32_t>(t);
    number_ = std::move(number);
  }

  void propose(Candidate& c) const {
    if (!c.waiting)
      return;
    c.waiting = false;
    c.proposed = -1;
    c.worst = 1;
    for (int64_t k = c.begin; k < c.end; ++k)
      c.worst = std::min(c.worst, quality_[at(element_[at(k)])]);
    if (c.worst >= goal_)
      return;
    thread_local improve::Spokes spokes;
    const Vec3d from = e_.position[at(c.vertex)];
    spokes.clear(from);
    double length = 0;
    for (int64_t k = c.begin; k < c.end; ++k) {
      const Tet& t = e_.tet[at(element_[at(k)])];
      std::array<Vec3d, 4> p;
      int moving = 0;
      for (int i = 0; i < 4; ++i) {
        p[at(i)] = e_.position[at(t[at(i)])];
        length += norm(p[at(i)] - from);
        if (t[at(i)] == c.vertex)
          moving = i;
      }
      spokes.add(p, moving);
    }
    length /= 3. * double(c.end - c.begin);
    Vec3d axis[3];
    int axes = 0;
    for (int a = 0; a < 3; ++a)
      if (!(c.frozen >> a & 1))
        axis[axes++][a] = 1;
    const auto free = [](const Vec3d&) { return true; };
    Vec3d x = from;
    float best = c.worst;
    if (!improve::pattern_search(spokes, x, best, goal_, length, axis, axes, free, free))
      return;
    best = 1; // judged again in double precision
    for (int64_t k = c.begin; k < c.end; ++k) {
      std::array<Vec3d, 4> p;
      for (int i = 0; i < 4; ++i) {
        const int32_t v = e_.tet[at(element_[at(k)])][at(i)];
        p[at(i)] = v == c.vertex ? x : e_.position[at(v)];
      }
      best = std::min(best, improve::tet_quality(p[0], p[1], p[2], p[3]));
    }
    if (best <= c.worst)
      return;
    c.place = x;
    c.proposed = best;
  }

  /// Whether candidate i, which has a proposal, has the worst element of all neighbours with one.
  bool first_among_neighbours(int64_t i) const {
    const Candidate& c = candidate_[at(i)];
    if (c.proposed < 0)
      return false;
    for (int64_t k = c.begin; k < c.end; ++k)
      for (int32_t v : e_.tet[at(element_[at(k)])]) {
        const int32_t j = number_[at(v)];
        if (j < 0 || j == i || candidate_[at(j)].proposed < 0)
          continue;
        const float other = candidate_[at(j)].worst;
        if (other < c.worst || (other == c.worst && j < i))
          return false;
      }
    return true;
  }

  void take(Candidate& c) {
    e_.position[at(c.vertex)] = c.place;
    c.proposed = -1;
    for (int64_t k = c.begin; k < c.end; ++k) {
      const int32_t t = element_[at(k)];
      quality_[at(t)] = quality(e_.tet[at(t)]);
      for (int32_t v : e_.tet[at(t)])
        if (number_[at(v)] >= 0)
          candidate_[at(number_[at(v)])].waiting = true;
    }
  }

  static constexpr int32_t none = -1, bound = -2;
  Elements& e_;
  int threads_;
  const float goal_ = static_cast<float>(improve::angle_quality(least_angle));
  std::vector<float> quality_;       ///< [tets]
  std::vector<int32_t> number_;      ///< [vertices] candidate, or none, or bound
  std::vector<Candidate> candidate_; ///< in the order in which elements meet them
  std::vector<int32_t> element_;
};

} // namespace

int64_t relax(Elements& elements, const std::vector<uint8_t>& lattice_class, int threads) {
  Relaxation relaxation(elements, lattice_class, threads);
  int64_t moved = 0;
  for (int round = 0; round < most_rounds; ++round) {
    const int64_t now = relaxation.round();
    if (now == 0)
      break;
    moved += now;
  }
  return moved;
}

} // namespace molmesh::contour
