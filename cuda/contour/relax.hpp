// relax.hpp — contour::relax on a Backend: the host's passes. A team searches a vertex's place, one element of its
// star a thread, in the order and with the rounding of the host.
#pragma once
#include "contour/relaxation/relax_passes.hpp"
#include "contour/surface_distance/move_nearer.hpp"
#include "cuda/contour/quick_division.hpp"
#include "cuda/optimize/device_isosurface.hpp"
#include "geom/predicates.hpp"
#include "geom/star_quality_items.hpp"
#include <bit>

namespace molmesh::cuda {

using contour::Fate;
using contour::RelaxView;

/// What the threads of a star's team tell each other.
struct StarShared {
  static constexpr int most_places = 14;
  float side[6];
  double place[most_places][3];
  bool allowed[most_places];
};

/// Of contour::move_vertex: all threads of the team ask the same and get the same answer. What they share
/// comes by Team::least, or lies in memory; each write is followed by a sync before it is read, each read before
/// the next write. A star of 32 elements at most lies in the threads' registers while places are judged.
/// Waiting is most of the time: what can be asked at once is, several places for each element, a probe each thread.
template <class Team>
class TeamStar {
public:
  static constexpr int most_places = StarShared::most_places;

  /// star_element, quality: scratch for all stars, as MoveTeams has it.
  MOLMESH_HD TeamStar(const RelaxView& r, int32_t c, Team team, StarElement<float>* star_element, float* quality,
                      StarShared& shared)
      : r_(r), team_(team), vertex_(r.vertex[c]), n_(static_cast<int32_t>(r.first[c + 1] - r.first[c])),
        element_(r.element + r.first[c]), star_element_(star_element + r.first[c]), quality_(quality + r.first[c]),
        shared_(shared), origin_(r.e.position[vertex_]) {
    int32_t first[2] = {n_, n_};
    for (int32_t k = team_.rank(); k < n_; k += Team::size)
      if (int32_t& f = first[is_meshed(k)]; k < f)
        f = k;
    for (const int meshed : {0, 1})
      if (const int32_t k = team_.least(first[meshed]); k < n_) {
        const double length = norm(corner(k, 1) - corner(k, 2));
        inverse_[meshed] = 1 / (length < 1e-300 ? 1e-300 : length);
      }
    for (int32_t k = team_.rank(); k < n_; k += Team::size) {
      const bool meshed = is_meshed(k);
      const StarElement<float> made =
          make_star_element(local(corner(k, 1), meshed), local(corner(k, 2), meshed), local(corner(k, 3), meshed));
      if (k == team_.rank())
        mine_ = made, mine_meshed_ = meshed;
      star_element_[k] = made;
    }
    team_.sync();
  }

  /// Mean of the star's edges at the vertex.
  MOLMESH_HD double length() const {
    double sum = 0;
    for (int32_t k = 0; k < n_; ++k)
      for (size_t i = 0; i < 4; ++i)
        sum += norm(r_.e.position[r_.e.tet[element_[k]][i]] - origin_);
    return sum / (3. * double(n_));
  }

  MOLMESH_HD TeamStar& star_quality() { return *this; }

  MOLMESH_HD float worst(Vec3d x, float) const {
    float least = 3e38f;
    for_each_element([&](int32_t, bool meshed, const StarElement<float>& s) {
      const float q = evaluate(s, meshed, x);
      least = q < least ? q : least;
    });
    return team_.least(least);
  }

  /// The first of place[begin, end) whose worst element is above `above`; end: none.
  MOLMESH_HD int first_above(const Vec3d* place, int begin, int end, float above, float& q) const {
    constexpr int at_once = Team::size > 1 ? 7 : 1;
    for (int first = begin; first < end; first += at_once) {
      float least[at_once];
      for (float& l : least)
        l = 3e38f;
      const auto at = [&](int i) { return place[first + i < end ? first + i : end - 1]; };
      for_each_element([&](int32_t, bool meshed, const StarElement<float>& s) {
        QuickDivision by; // no branches: the places are in flight together
        float here[at_once];
        for (int i = 0; i < at_once; ++i)
          here[i] = quality(s, local(at(i), meshed), by);
        for (int i = 0; i < at_once && !by.holds(); ++i)
          here[i] = quality(s, local(at(i), meshed));
        for (int i = 0; i < at_once; ++i) {
          const float weighed = (meshed ? 1 : contour::unmeshed_weight) * here[i];
          least[i] = weighed < least[i] ? weighed : least[i];
        }
      });
      for (int i = 0; i < at_once; ++i)
        least[i] = team_.least(least[i]);
      for (int i = 0; i < at_once && first + i < end; ++i)
        if (least[i] > above) {
          q = least[i];
          return first + i;
        }
    }
    return end;
  }

  /// Puts those of y[0, n) in front that constrain(y[i]) allows, and where it moves them, in order; returns how
  /// many. A thread asks for a place.
  template <class Constrain>
  MOLMESH_HD int constrain_all(const Constrain& constrain, Vec3d* y, int n) const {
    for (int i = team_.rank(); i < n; i += Team::size) {
      Vec3d p = y[i];
      shared_.allowed[i] = constrain(p);
      for (int a = 0; a < 3; ++a)
        shared_.place[i][a] = p[a];
    }
    team_.sync();
    int allowed = 0;
    for (int i = 0; i < n; ++i)
      if (shared_.allowed[i])
        y[allowed++] = {shared_.place[i][0], shared_.place[i][1], shared_.place[i][2]};
    team_.sync(); // read before it is written again
    return allowed;
  }

  MOLMESH_HD Vec3d ascent(Vec3d x, double step) {
    // Of equals the first, and one that is asked for before others.
    uint64_t least = ~uint64_t{0};
    for_each_element([&](int32_t k, bool meshed, const StarElement<float>& s) {
      uint32_t bits = std::bit_cast<uint32_t>(evaluate(s, meshed, x) + 0.0f); // in the numbers' order
      bits ^= bits >> 31 ? ~uint32_t{0} : uint32_t{1} << 31;
      const uint64_t key = uint64_t{bits} << 32 | uint32_t{!meshed} << 31 | static_cast<uint32_t>(k);
      least = key < least ? key : least;
    });
    const auto worst = static_cast<int32_t>(team_.least(least) & 0x7FFFFFFF);
    const bool meshed = is_meshed(worst);
    const auto d = static_cast<float>(step * inverse_[meshed]);
    for (int s = team_.rank(); s < 6; s += Team::size) {
      Vec3f y = local(x, meshed);
      y[s / 2] = s % 2 ? y[s / 2] - d : y[s / 2] + d;
      shared_.side[s] = quality(star_element_[worst], y);
    }
    team_.sync();
    Vec3d g;
    for (int a = 0; a < 3; ++a)
      g[a] = double(shared_.side[2 * a]) - double(shared_.side[2 * a + 1]);
    team_.sync(); // read before it is written again
    const double length = norm(g);
    return length > 0 ? g / length : Vec3d{};
  }

  MOLMESH_HD bool take(Vec3d x, float worst) {
    constexpr float refused = -2;
    for (int32_t k = team_.rank(); k < n_; k += Team::size) {
      const Tet& t = r_.e.tet[element_[k]];
      Vec3d p[4];
      for (size_t i = 0; i < 4; ++i)
        p[i] = t[i] == vertex_ ? x : r_.e.position[t[i]];
      const float q = weight(k) * tet_quality(p[0], p[1], p[2], p[3], r_.shape);
      quality_[k] = q <= worst || orient3d(p[0], p[1], p[2], p[3]) <= 0 ? refused : q;
    }
    team_.sync();
    bool allowed = true;
    for (int32_t k = 0; k < n_; ++k)
      allowed = allowed && quality_[k] != refused;
    if (!allowed) {
      team_.sync();
      return false;
    }
    if (team_.rank() == 0)
      r_.e.position[vertex_] = x;
    for (int32_t k = team_.rank(); k < n_; k += Team::size)
      r_.quality[element_[k]] = quality_[k];
    return true;
  }

private:
  MOLMESH_HD bool is_meshed(int32_t k) const { return r_.classes.is_meshed(r_.e.tet[element_[k]]); }
  MOLMESH_HD float weight(int32_t k) const { return is_meshed(k) ? 1 : contour::unmeshed_weight; }
  /// Of element k, the vertex in front.
  MOLMESH_HD Vec3d corner(int32_t k, int i) const {
    const Tet& t = r_.e.tet[element_[k]];
    const int moving = t[0] == vertex_ ? 0 : t[1] == vertex_ ? 1 : t[2] == vertex_ ? 2 : 3;
    return r_.e.position[t[star_corner(moving, i)]];
  }
  MOLMESH_HD Vec3f local(Vec3d x, bool meshed) const {
    const Vec3d u = (x - origin_) * inverse_[meshed];
    return {static_cast<float>(u.x), static_cast<float>(u.y), static_cast<float>(u.z)};
  }
  template <class By = const Division>
  MOLMESH_HD float quality(const StarElement<float>& s, const Vec3f& y, By&& by = {}) const {
    float q;
    star_element_quality(s, y.x, y.y, y.z, q, static_cast<float>(r_.shape), by);
    return q;
  }
  /// With the vertex at x.
  MOLMESH_HD float evaluate(const StarElement<float>& s, bool meshed, Vec3d x) const {
    return (meshed ? 1 : contour::unmeshed_weight) * quality(s, local(x, meshed));
  }
  /// see(k, meshed, star_element) of this thread's elements.
  template <class See>
  MOLMESH_HD void for_each_element(const See& see) const {
    if (team_.rank() < n_)
      see(team_.rank(), mine_meshed_, mine_);
    for (int32_t k = team_.rank() + Team::size; k < n_; k += Team::size)
      see(k, is_meshed(k), StarElement<float>(star_element_[k]));
  }

  const RelaxView& r_;
  Team team_;
  int32_t vertex_, n_;
  const int32_t* element_;
  StarElement<float>* star_element_; ///< [n]
  float* quality_;                   ///< [n]
  StarShared& shared_;
  Vec3d origin_;
  StarElement<float> mine_{}; ///< of the thread's first element
  bool mine_meshed_ = false;
  double inverse_[2] = {0, 0}; ///< of the unit of length, of either
};

/// Those who have the turn.
struct MoveTeams {
  RelaxView r;
  IsosurfaceView surface;
  double most_distance;
  const int32_t* active;
  Fate* fate;
  StarElement<float>* star_element; ///< [star entries]
  float* quality;                   ///< [star entries]
  using Shared = StarShared;
  template <class Team>
  MOLMESH_HD void operator()(int64_t i, Team team, Shared& shared) const {
    if (fate[i] != Fate::stays)
      return;
    TeamStar<Team> star(r, active[i], team, star_element, quality, shared);
    if (contour::move_vertex(r, surface, most_distance, active[i], star) && team.rank() == 0)
      fate[i] = Fate::moves;
  }
};

/// Those who have the turn; what a vertex's triangles are off all threads of its team write alike.
struct MoveNearerTeams {
  contour::NearerView v;
  IsosurfaceView surface;
  const int32_t* active;
  Fate* fate;
  StarElement<float>* star_element; ///< [star entries]
  float* quality;                   ///< [star entries]
  using Shared = StarShared;
  template <class Team>
  MOLMESH_HD void operator()(int64_t i, Team team, Shared& shared) const {
    if (fate[i] != Fate::stays)
      return;
    TeamStar<Team> star(v.r, active[i], team, star_element, quality, shared);
    if (contour::move_nearer_or_make_room(v, surface, active[i], star) && team.rank() == 0)
      fate[i] = Fate::moves;
  }
};

template <par::Launcher Backend>
class TeamMover {
public:
  TeamMover(Backend& b, const Isosurface& surface) : b_(b), surface_(b, surface) {}
  void judge(const contour::Qualities& all) {
    const auto tets = double(all.e.tets);
    b_.for_n("element qualities", all.e.tets, all, {tets * 20 + double(all.e.positions) * 25, 180. * tets, true});
  }
  void begin(const RelaxView&, int64_t candidates, int64_t entries) {
    entries_ = double(entries) / double(candidates);
    star_element_ = b_.template array<StarElement<float>>(entries);
    quality_ = b_.template array<float>(entries);
  }
  void move(const RelaxView& r, const int32_t* active, int64_t n, Fate* fate, double most_distance) {
    b_.for_teams("move vertices", n,
                 MoveTeams{r, surface_.view(), most_distance, active, fate, star_element_.data(), quality_.data()},
                 {double(n) * entries_ * 112});
  }
  void measure(const contour::ElementsView& e, float* off) {
    b_.for_n("measure triangles", e.tris, contour::MeasureTriangles<IsosurfaceView>{e, surface_.view(), off},
             {double(e.tris) * 140});
  }
  void move_nearer(const contour::NearerView& v, const int32_t* active, int64_t n, Fate* fate) {
    b_.for_teams("move nearer", n,
                 MoveNearerTeams{v, surface_.view(), active, fate, star_element_.data(), quality_.data()},
                 {double(n) * entries_ * 112});
  }

private:
  Backend& b_;
  DeviceIsosurface<Backend> surface_;
  double entries_ = 0; ///< of a star, in the mean
  typename Backend::template Array<StarElement<float>> star_element_;
  typename Backend::template Array<float> quality_;
};

} // namespace molmesh::cuda
