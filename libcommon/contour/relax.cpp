// relax.cpp — rounds: of the vertices of bad elements an independent set search a better place.
#include "contour/relax.hpp"
#include "contour/detail/at.hpp"
#include "contour/detail/stars.hpp"
#include "geom/predicates.hpp"
#include "improve/search.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace molmesh::contour {

using detail::at;
namespace {

constexpr double largest_angle = 159.8; // degrees; 13.2° counts alike
/// Of a surface vertex from the surface, in spacings, if it was nearer: pass by pass, for what is left.
constexpr double most_distance[] = {0.03, 0.06, 0.15};
constexpr double least_along = 0.25; // square of the normal's part within a wall
constexpr int most_rounds = 100;

/// Whose turn it is: another order in each round, lest one vertex that creeps holds up its neighbours.
uint32_t turn(int32_t candidate, int round) {
  uint64_t h =
      static_cast<uint64_t>(candidate) * 0x9E3779B97F4A7C15u + static_cast<uint64_t>(round) * 0xC2B2AE3D27D4EB4Fu;
  h = (h ^ h >> 29) * 0x165667B19E3779F9u;
  return static_cast<uint32_t>(h >> 33);
}

class Relaxation {
public:
  Relaxation(Elements& elements, const std::vector<uint8_t>& lattice_class, const improve::Target* surface,
             int threads)
      : e_(elements), surface_(surface), threads_(threads) {
    const auto n = static_cast<int64_t>(e_.tet.size());
    quality_.resize(at(n));
    par::for_n(n, threads_, [&](int64_t t) {
      const Tet& v = e_.tet[at(t)];
      quality_[at(t)] = of_lattice(v, lattice_class) ? 1 : quality(v);
    });
    bound_.assign(e_.position.size(), 0);
    for (size_t i = 0; i < e_.tri.size(); ++i)
      for (int32_t v : e_.tri[i])
        bound_[at(v)] = static_cast<uint8_t>(
            bound_[at(v)] | (e_.boundary[i] == molmesh::surface ? on_surface : 1 << (e_.boundary[i] - box_x0) / 2));
  }

  int64_t run() {
    int64_t moved = 0;
    for (const double distance : most_distance) {
      most_distance_ = distance;
      if (!find_candidates())
        break;
      for (int round = 0; round < most_rounds && !active_.empty(); ++round)
        moved += move_some(round);
    }
    return moved;
  }

private:
  static constexpr uint8_t on_surface = 8; ///< of bound_; bits 0 to 2: on a wall across that axis
  static constexpr uint32_t at_rest = std::numeric_limits<uint32_t>::max(); ///< of turn_: does not want to move

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

  /// All vertices of bad elements that may move. False when there are none.
  bool find_candidates() {
    std::vector<int32_t> vertices;
    for (size_t t = 0; t < e_.tet.size(); ++t)
      if (quality_[t] < goal_)
        for (int32_t v : e_.tet[t])
          if (surface_ || !(bound_[at(v)] & on_surface))
            vertices.push_back(v);
    par::sort_unique(vertices, threads_);
    const size_t n = vertices.size();
    if (n == 0)
      return false;
    star_.gather(std::move(vertices), e_.tet, e_.position.size(), threads_);
    worst_.resize(n);
    turn_.assign(n, at_rest);
    wakes_.assign(n, 0);
    active_.resize(n);
    std::iota(active_.begin(), active_.end(), 0);
    return true;
  }

  int64_t move_some(int round) {
    const auto n = static_cast<int64_t>(active_.size());
    par::for_n(n, threads_, [&](int64_t i) {
      const int32_t c = active_[at(i)];
      float w = 1;
      for (int32_t t : star_[c])
        w = std::min(w, quality_[at(t)]);
      worst_[at(c)] = w;
      turn_[at(c)] = w < goal_ ? turn(c, round) : at_rest;
    });
    enum : uint8_t { waits, stays, moves };
    std::vector<uint8_t> fate(at(n));
    par::for_n(n, threads_, 64,
               [&](int64_t i) { fate[at(i)] = first_among_neighbours(active_[at(i)]) ? stays : waits; });
    // No two of them share an element.
    par::for_n(n, threads_, 16, [&](int64_t i) {
      if (fate[at(i)] == stays && move(active_[at(i)]))
        fate[at(i)] = moves;
    });
    const auto wake = [&](int32_t c) { std::atomic_ref(wakes_[at(c)]).store(1, std::memory_order_relaxed); };
    par::for_n(n, threads_, 64, [&](int64_t i) {
      const int32_t c = active_[at(i)];
      if (fate[at(i)] == waits && turn_[at(c)] != at_rest)
        wake(c);
      if (fate[at(i)] == moves)
        for (int32_t t : star_[c])
          for (int32_t v : e_.tet[at(t)])
            if (star_.number[at(v)] >= 0)
              wake(star_.number[at(v)]);
    });
    for (int32_t c : active_)
      turn_[at(c)] = at_rest;
    active_.clear();
    for (size_t c = 0; c < wakes_.size(); ++c)
      if (std::exchange(wakes_[c], 0))
        active_.push_back(static_cast<int32_t>(c));
    return std::count(fate.begin(), fate.end(), moves);
  }

  /// Whether candidate c wants to move and none of its neighbours does whose turn is earlier.
  bool first_among_neighbours(int32_t c) const {
    const uint32_t mine = turn_[at(c)];
    if (mine == at_rest)
      return false;
    for (int32_t t : star_[c])
      for (int32_t v : e_.tet[at(t)]) {
        const int32_t j = star_.number[at(v)];
        if (j >= 0 && (turn_[at(j)] < mine || (turn_[at(j)] == mine && j < c)))
          return false;
      }
    return true;
  }

  bool move(int32_t c) {
    struct Trial {
      improve::Spokes spokes;
      std::vector<std::array<Vec3d, 4>> corner;
      std::vector<int> moving;
      std::vector<float> quality;
    };
    thread_local Trial trial;
    const int32_t vertex = star_.vertex[at(c)];
    Vec3d x = e_.position[at(vertex)];
    trial.spokes.clear(x);
    trial.corner.clear();
    trial.moving.clear();
    double length = 0;
    for (int32_t element : star_[c]) {
      const Tet& t = e_.tet[at(element)];
      std::array<Vec3d, 4> p;
      int moving = 0;
      for (int i = 0; i < 4; ++i) {
        p[at(i)] = e_.position[at(t[at(i)])];
        length += norm(p[at(i)] - x);
        if (t[at(i)] == vertex)
          moving = i;
      }
      trial.spokes.add(p, moving);
      trial.corner.push_back(p);
      trial.moving.push_back(moving);
    }
    length /= 3. * double(trial.spokes.size());
    const uint8_t bound = bound_[at(vertex)];
    Vec3d axis[3];
    int axes = 0;
    for (int a = 0; a < 3; ++a)
      if (!(bound >> a & 1))
        axis[axes++][a] = 1;
    double most = 0; // from the surface
    if (bound & on_surface) {
      Vec3d normal;
      if (!surface_->probe(x, most, normal))
        return false;
      most = std::max(std::abs(most), most_distance_ * surface_->spacing());
    }
    const auto constrain = [&](Vec3d& y) { return !(bound & on_surface) || to_surface(y, bound, most); };
    const auto accept = [](const Vec3d&) { return true; };
    float best = worst_[at(c)];
    if (!improve::pattern_search(trial.spokes, x, best, goal_, length, axis, axes, constrain, accept))
      return false;
    trial.quality.clear(); // judged again in double precision, and exactly
    for (size_t k = 0; k < trial.corner.size(); ++k) {
      std::array<Vec3d, 4>& p = trial.corner[k];
      p[at(trial.moving[k])] = x;
      trial.quality.push_back(improve::tet_quality(p[0], p[1], p[2], p[3]));
      if (trial.quality.back() <= worst_[at(c)] || orient3d(p[0], p[1], p[2], p[3]) <= 0)
        return false;
    }
    e_.position[at(vertex)] = x;
    for (size_t k = 0; k < trial.quality.size(); ++k)
      quality_[at(star_[c][k])] = trial.quality[k];
    return true;
  }

  /// Moves y towards the surface, within the walls that `bound` names, until it is no farther than `most`.
  bool to_surface(Vec3d& y, uint8_t bound, double most) const {
    double distance;
    Vec3d normal;
    if (!surface_->probe(y, distance, normal))
      return false;
    if (std::abs(distance) <= most)
      return true;
    for (int a = 0; a < 3; ++a)
      if (bound >> a & 1)
        normal[a] = 0;
    const double along = norm2(normal);
    y -= (distance - std::copysign(most, distance)) / along * normal;
    return along > least_along;
  }

  Elements& e_;
  const improve::Target* surface_;
  int threads_;
  double most_distance_ = 0;
  const float goal_ = static_cast<float>(improve::angle_quality(largest_angle));
  std::vector<float> quality_;  ///< [tets]
  std::vector<uint8_t> bound_;  ///< [vertices]
  detail::Stars star_;          ///< of the candidates
  std::vector<float> worst_;    ///< [candidates] worst element's quality as the round began
  std::vector<uint32_t> turn_;  ///< [candidates]
  std::vector<uint8_t> wakes_;  ///< [candidates]
  std::vector<int32_t> active_; ///< candidates that may want to move, ascending
};

} // namespace

int64_t relax(Elements& elements, const std::vector<uint8_t>& lattice_class, const improve::Target* surface,
              int threads) {
  return Relaxation(elements, lattice_class, surface, threads).run();
}

} // namespace molmesh::contour
