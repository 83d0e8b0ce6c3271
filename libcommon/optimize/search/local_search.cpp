// local_search.cpp — repair by rounds; first improvement and threshold accepting among operations.
#include "optimize/search/local_search.hpp"
#include "optimize/acceptance/surface_fit.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <optional>

namespace molmesh::optimize {

std::vector<int32_t> LocalSearch::below(float goal, const std::vector<int32_t>& of) const {
  std::vector<int32_t> list;
  for (const int32_t t : of)
    if (r_.mesh.element[t].alive() && r_.mesh.element[t].q < goal)
      list.push_back(t);
  return list;
}

std::vector<int32_t> LocalSearch::bad() {
  return below(FaultCount::share * accept_.goal, below_goal_());
}

std::vector<int32_t> LocalSearch::elements() const {
  std::vector<int32_t> all;
  for (const int32_t t : slots_)
    if (r_.mesh.element[t].alive())
      all.push_back(t);
  return all;
}

Acceptance LocalSearch::first_step() const {
  Acceptance a = accept_;
  a.aim = Aim::fit;
  a.goal = leeway.floor * accept_.goal;
  a.worst_first = !accept_.worst_first;
  a.may_bend = true;
  return a;
}

void LocalSearch::fit_listed(const Acceptance& accept) {
  for (int sweep = 0; sweep < 3 && !r_.changed.empty(); ++sweep) {
    std::vector<int32_t> list;
    list.swap(r_.changed);
    par::sort_unique(list, 1);
    for (const int32_t t : list)
      if (r_.mesh.element[t].alive())
        fit_element(r_, accept, t);
  }
}

void LocalSearch::fit_changed() {
  Acceptance a = first_step();
  a.may_bend = false;
  fit_listed(a);
}

void LocalSearch::fit_bent() {
  Acceptance a = accept_;
  a.aim = Aim::fit;
  a.worst_first = !accept_.worst_first;
  a.off_target = leeway.off_target;
  r_.changed.clear();
  for (const int32_t t : slots_)
    for (size_t f = 0; f < 4; ++f)
      if (r_.mesh.element[t].alive() && is_bent(r_, a, t, f)) {
        r_.changed.push_back(t);
        break;
      }
  fit_listed(a);
}

void LocalSearch::repair(int rounds) {
  Acceptance a = accept_;
  a.may_bend = leeway.may_bend;
  a.off_target = leeway.off_target;
  // After two without effect, one of each measure, all are.
  for (int k = 0, idle = 0; k < rounds && idle < 2 && r_.looks_left(); ++k) {
    const int64_t done = r_.counts.total();
    a.worst_first = (k % 2 == 0) == accept_.worst_first;
    std::vector<int32_t> list = below_goal_();
    if (list.empty())
      return;
    for (int sweep = 0; sweep < 4 && !list.empty(); ++sweep) {
      sort_worst_first(r_.mesh, list);
      r_.changed.clear();
      for (const int32_t t : list)
        if (r_.mesh.element[t].alive() && r_.mesh.element[t].q < a.goal)
          improve_element(r_, a, t, true);
      list = below(a.goal, r_.changed);
    }
    idle = r_.counts.total() == done ? idle + 1 : 0;
  }
}

double LocalSearch::cost() {
  double sum = 0;
  for (const int32_t t : bad())
    sum += 1.2 - std::sqrt(r_.mesh.element[t].q / accept_.goal);
  return sum;
}

// The worst elements and those beside them.
std::vector<int32_t> LocalSearch::worst() {
  constexpr size_t most = 4;
  std::vector<int32_t> list = bad();
  sort_worst_first(r_.mesh, list);
  list.resize(std::min(list.size(), most));
  for (size_t i = 0, n = list.size(); i < n; ++i)
    for (const int32_t t : r_.mesh.element[list[i]].n)
      if (t >= 0 && r_.owned(t) && std::find(list.begin(), list.end(), t) == list.end())
        list.push_back(t);
  return list;
}

bool LocalSearch::operate(const Trial& trial) {
  const Acceptance a = first_step();
  const int32_t t = trial.element;
  const auto [i, j] = edges[trial.operation % 6];
  r_.changed.clear();
  switch (trial.operation / 6) {
  case 0:
    return remove_edge(r_, a, t, i, j);
  case 1:
    return split_edge(r_, a, t, i, j);
  case 2:
    return contract_edge(r_, a, t, i, j);
  case 3:
    return contract_edge(r_, a, t, j, i);
  case 4:
    return merge_edge(r_, a, t, i, j);
  default:
    return swap_face(r_, a, t, trial.operation % 6);
  }
}

void LocalSearch::repair_after() {
  fit_changed();
  repair(2);
}

// The last state that was kept, as the part moves on by small steps: an earlier one, and what has changed since.
class LocalSearch::Checkpoint {
public:
  explicit Checkpoint(const LocalSearch& s) : s_(s) {}
  /// The present state. More than an eighth of the part is saved as a whole: going back would take long.
  void keep() {
    if (all_)
      changes_ = s_.r_.changes_since(*all_);
    if (!all_ || 8 * changes_->element.size() > all_->element.size()) {
      all_ = s_.r_.save(s_.elements());
      changes_.reset();
    }
  }
  /// keep() came before.
  void go_back() {
    s_.r_.restore(*all_);
    if (changes_)
      s_.r_.redo(*changes_);
  }

private:
  const LocalSearch& s_;
  std::optional<Snapshot> all_, changes_;
};

// What the cost and the faults after a trial must be under.
struct LocalSearch::Limit {
  const Faults& before;
  int64_t off;
  double least;
};

LocalSearch::Outcome LocalSearch::attempt(const Trial& trial, Limit& limit) {
  if (!operate(trial))
    return Outcome::idle;
  repair_after();
  if (const double now = cost(); now < 0.995 * limit.least)
    if (const Faults f = faults(); f.off <= limit.off && f.fewer_than(limit.before, leeway.bent_for_point)) {
      limit.least = now;
      return Outcome::better;
    }
  return Outcome::worse;
}

void LocalSearch::climb(const Faults& before, int& trials) {
  Limit limit{before, faults().off, cost()};
  Checkpoint here(*this);
  for (bool done = true; done && limit.least > 0;) {
    done = false;
    here.keep();
    const std::vector<int32_t> around = worst();
    for (size_t i = 0; i < around.size() * operations && !done && trials > 0 && r_.looks_left(); ++i) {
      const Outcome outcome = attempt({around[i / operations], static_cast<int>(i % operations)}, limit);
      trials -= outcome != Outcome::idle;
      done = outcome == Outcome::better;
      if (outcome == Outcome::worse)
        here.go_back();
    }
  }
}

void LocalSearch::walk(const Faults& before, int& trials) {
  constexpr double first_rise = 0.15; // of the cost, in one step
  constexpr int idle_for_a_trial = 20;
  uint64_t state = 1; // the same walk every time
  const auto random = [&](size_t n) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<size_t>((state >> 33) % n);
  };
  const int64_t off_at_first = faults().off;
  const int all = trials;
  double current = cost();
  Checkpoint here(*this);
  here.keep();
  std::vector<int32_t> list = worst();
  for (int idle = idle_for_a_trial * trials;
       current > 0 && trials > 0 && idle > 0 && !list.empty() && r_.looks_left();) {
    const int32_t t = list[random(list.size())];
    if (!operate({t, static_cast<int>(random(operations))})) {
      --idle;
      continue;
    }
    const double rise = first_rise * trials-- / all;
    repair_after();
    const double now = cost();
    const Faults f = faults();
    if (now > (1 + rise) * current || f.off > off_at_first || !f.fewer_than(before, leeway.bent_for_point)) {
      here.go_back();
      continue;
    }
    current = now;
    here.keep();
    list = worst();
  }
}

} // namespace molmesh::optimize
