// search_part.cpp — brings points back to the target and elements over the goal, with repair after every trial.
#include "optimize/search/search_part.hpp"
#include "optimize/acceptance/surface_fit.hpp"
#include "optimize/search/local_search.hpp"
#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace molmesh::optimize {
namespace {

constexpr size_t most_points = 64; // more were let go here and there: that is what the rounds are for
constexpr size_t most_states = 4;
constexpr int trials_at_wall = 300;

constexpr Leeway bold{1e-5f, true, 2, false, false}, in_necks{1e-5f, true, 2, true, false},
    bending{1e-5f, true, 8, true, true}, yielding{1e-5f, true, 8, true, false},
    of_elements{1e-5f, true, 0, false, false};

Acceptance acceptance_of(const Strategy& s) {
  Acceptance a(s.guard);
  a.goal = s.goal;
  a.worst_first = s.worst_first;
  return a;
}

// Where the isosurface grazes a wall the mesh has no room for it: long searches there nearly always fail.
bool at_wall(std::vector<int32_t> points, const DynamicMesh& m, double spacing) {
  std::erase_if(points, [&](int32_t v) { return m.vertex[v].kind != Kind::surface; });
  return points.empty() ||
         std::any_of(points.begin(), points.end(), [&](int32_t v) { return !m.walls.clear(m.point[v], spacing); });
}

class Recovery {
public:
  Recovery(Region& r, const std::vector<int32_t>& slots, const Strategy& strategy)
      : r_(r), strategy_(strategy), search_(r, slots, acceptance_of(strategy), bold) {}

  void run() {
    // Where the mesh ends in it, a surface that bends freely could turn inside out unseen.
    const bool bends = strategy_.moves >= Moves::bending && r_.is_alone();
    // A guard wider than that lets it bend so far.
    const bool yields = strategy_.guard.angle > Guard::widest_unbent;
    const Leeway& leeway = bends ? bending : yields ? yielding : bold;
    if (!try_points(leeway))
      return;
    try_harder();
    if (strategy_.moves >= Moves::necks)
      try_necks(bends || yields ? leeway : in_necks);
  }

private:
  bool is_off(int32_t v) const { return r_.mesh.incident[v] >= 0 && off(r_, v) > 1; }

  // False when no points are off, or too many.
  bool try_points(const Leeway& leeway) {
    search_.leeway = leeway;
    const std::vector<int32_t> points = search_.faults.points_off();
    if (points.empty() || points.size() > most_points)
      return false;
    if (points.size() > 1)
      all_back(points);
    for (const int32_t v : search_.faults.points_off())
      if (is_off(v) && r_.looks_left())
        bring_back(v);
    here_.reset();
    return true;
  }
  void try_necks(const Leeway& leeway) {
    search_.leeway = leeway;
    follow_necks();
    try_harder();
  }

  // True when operation(acceptance) leaves the part better, once it is repaired; nothing has changed otherwise.
  template <class Operation>
  bool attempt(const Snapshot& snapshot, const Faults& before, Operation&& operation) {
    r_.changed.clear();
    if (r_.looks_left() && operation(search_.first_step())) {
      search_.fit_changed();
      search_.repair();
      if (search_.leeway.fits_after && search_.cost() == 0)
        search_.fit_bent();
      if (search_.is_better(before)) {
        nearly_.clear();
        return true;
      }
      if (strategy_.hill_climbing > 0)
        remember(before, snapshot);
    }
    r_.restore(snapshot);
    return false;
  }

  // Saves, as changes, a state in which only elements are still below the goal.
  void remember(const Faults& before, const Snapshot& snapshot) {
    const Faults now = search_.faults();
    if (!now.fewer_than(before, search_.leeway.bent_for_point))
      return;
    const double cost = search_.cost() + 0.3 * double(now.off);
    const auto at = std::find_if(nearly_.begin(), nearly_.end(), [&](const auto& n) { return cost <= n.first; });
    if (at != nearly_.end() && at->first == cost)
      return; // the same, by another way
    if (at == nearly_.end() && nearly_.size() >= most_states)
      return;
    nearly_.emplace(at, cost, r_.changes_since(snapshot));
    if (nearly_.size() > most_states)
      nearly_.pop_back();
  }

  // The states saved since the part last changed, best first.
  void try_harder() {
    if (nearly_.empty())
      return;
    const Snapshot snapshot = r_.save(search_.elements());
    const Faults before = search_.faults();
    const bool grazed = at_wall(search_.faults.points_off(), r_.mesh, r_.spacing());
    int climbs = grazed ? std::min(strategy_.hill_climbing, trials_at_wall) : strategy_.hill_climbing,
        walks = grazed ? 0 : strategy_.threshold;
    for (const auto& [cost, state] : std::exchange(nearly_, {})) {
      r_.restore(snapshot);
      r_.redo(state);
      search_.climb(before, climbs);
      if (walks > 0 && !search_.is_better(before))
        search_.walk(before, walks);
      if (search_.is_better(before))
        return;
    }
    r_.restore(snapshot);
  }

  // A cavity smaller than the grid is off with all its points.
  void all_back(const std::vector<int32_t>& points) {
    attempt(r_.save(search_.elements()), search_.faults(), [&](const Acceptance& a) {
      if (search_.leeway.off_target)
        return step_by_step(points, 0.1f);
      bool done = false;
      for (int sweep = 0; sweep < 4; ++sweep)
        for (const int32_t v : points)
          if (is_off(v))
            done |= smooth_vertex(r_, a, v);
      return done;
    });
  }

  // A part of the way at a time; what is around is repaired in between. floor: share of the goal.
  bool step_by_step(const std::vector<int32_t>& points, float floor) {
    bool done = false;
    for (int step = 0; step < 12; ++step) {
      bool moved = false;
      for (const int32_t v : points)
        moved |= is_off(v) && step_to_surface(r_, search_.first_step(), v, floor * strategy_.goal);
      if (!moved)
        break;
      done = true;
      search_.repair();
    }
    return done;
  }

  // Where the target is narrow: this leaves elements as small as the neck, so it comes last.
  void follow_necks() {
    const double same = 0.1 * r_.spacing();
    std::vector<Vec3d> met;
    for (const int32_t v : search_.faults.points_off()) {
      Neck neck;
      if (!is_off(v) || !find_neck(r_, v, neck) ||
          std::any_of(met.begin(), met.end(), [&](Vec3d at) { return norm(at - neck.at) < same; }))
        continue;
      met.push_back(neck.at);
      const Snapshot snapshot = r_.save(search_.elements());
      const Faults before = search_.faults();
      for (const double ratio : {0.5, 0.35, 0.65})
        if (attempt(snapshot, before, [&](const Acceptance&) {
              return follow_neck(r_, v, neck, ratio) && (step_by_step(search_.faults.points_off(), 0.1f), true);
            }))
          break;
    }
  }

  void bring_back(int32_t v) {
    if (!here_)
      here_.emplace(r_.save(search_.elements()));
    if (try_all(v, *here_))
      here_.reset();
  }

  // True when the part has changed: then it is better.
  bool try_all(int32_t v, const Snapshot& snapshot) {
    const Faults before = search_.faults();
    const auto attempted = [&](auto&& operation) { return attempt(snapshot, before, operation); };
    if (attempted([&](const Acceptance& a) { return smooth_vertex(r_, a, v); }))
      return true;
    if (search_.leeway.off_target)
      for (const float floor : {0.1f, 0.01f})
        if (attempted([&](const Acceptance&) { return step_by_step({v}, floor); }))
          return true;
    for (const double ratio : {0.5, 0.35, 0.65})
      if (attempted([&](const Acceptance&) { return shrink_cavity(r_, v, ratio); }))
        return true;
    struct Edge {
      int32_t to, element; // neighbour on the surface
      int i, j;
    };
    std::vector<Edge> edges_at_v;
    for (const auto& [t, e] : snapshot.element)
      if (const int i = e.find(v); i >= 0)
        for (int j = 0; j < 4; ++j)
          if (j != i && follows_target(r_.mesh.vertex[e.v[j]].kind))
            edges_at_v.push_back({e.v[j], t, i, j});
    std::sort(edges_at_v.begin(), edges_at_v.end(), [](const Edge& a, const Edge& b) {
      return std::array{a.to, a.element, a.i, a.j} < std::array{b.to, b.element, b.i, b.j};
    });
    edges_at_v.erase(std::unique(edges_at_v.begin(), edges_at_v.end(),
                                 [](const Edge& a, const Edge& b) { return a.to == b.to; }),
                     edges_at_v.end());
    return std::any_of(edges_at_v.begin(), edges_at_v.end(), [&](const Edge& e) {
      return attempted([&](const Acceptance& a) { return contract_edge(r_, a, e.element, e.i, e.j); }) ||
             attempted([&](const Acceptance& a) { return merge_edge(r_, a, e.element, e.i, e.j); }) ||
             attempted([&](const Acceptance& a) { return remove_edge(r_, a, e.element, e.i, e.j); });
    });
  }

  Region& r_;
  const Strategy& strategy_;
  LocalSearch search_;
  std::optional<Snapshot> here_;                    ///< of bring_back(): nothing has changed since
  std::vector<std::pair<double, Snapshot>> nearly_; ///< cost, changes since the part last changed; ascending
};

} // namespace

void search_part(Region& r, const std::vector<int32_t>& slots, const Strategy& strategy) {
  const bool of_points = strategy.scope == Scope::points;
  if (of_points && strategy.goal_share == 1) {
    Recovery(r, slots, strategy).run();
    return;
  }
  LocalSearch search(r, slots, acceptance_of(strategy), of_points ? yielding : of_elements);
  if (of_points && at_wall(search.faults.points_off(), r.mesh, r.spacing()))
    return;
  const Snapshot snapshot = r.save(search.elements());
  const Faults before = search.faults();
  Faults allowed = before;
  if (of_points) {
    // Elements that had nowhere to go while these points were off often have then.
    Strategy lower = strategy;
    lower.goal_share = 1;
    lower.goal *= strategy.goal_share;
    Recovery(r, slots, lower).run();
    if (r.counts.total() == snapshot.counts.total())
      return;
  } else {
    ++allowed.off; // no point has to come back
  }
  int climbs = strategy.hill_climbing, walks = strategy.threshold;
  search.repair();
  search.climb(allowed, climbs);
  if (walks > 0 && search.cost() > 0)
    search.walk(allowed, walks);
  const bool keeps = search.is_better(allowed) && (of_points || search.faults().below < before.below);
  if (!keeps)
    r.restore(snapshot);
}

} // namespace molmesh::optimize
