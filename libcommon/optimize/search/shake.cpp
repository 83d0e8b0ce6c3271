// shake.cpp — a search among operations that make a part worse at first.
#include "optimize/mesh/part_copy.hpp"
#include "optimize/schedule/element_pass.hpp"
#include "optimize/search/mend.hpp"
#include <algorithm>
#include <atomic>

namespace molmesh::optimize {

// The worst elements and those beside them.
std::vector<int32_t> Mending::worst() {
  constexpr size_t most = 4;
  std::vector<int32_t> list = bad();
  sort_worst_first(m_, list);
  list.resize(std::min(list.size(), most));
  for (size_t i = 0, n = list.size(); i < n; ++i)
    for (const int32_t t : m_.element[list[i]].n)
      if (t >= 0 && editor_.owned(t) && std::find(list.begin(), list.end(), t) == list.end())
        list.push_back(t);
  return list;
}

bool Mending::operate(int32_t t, int k) {
  set_out();
  editor_.bold = true;
  editor_.changed.clear();
  const auto [i, j] = edges[k % 6];
  switch (k / 6) {
  case 0:
    return editor_.remove_edge(t, i, j);
  case 1:
    return editor_.split(t, i, j);
  case 2:
    return editor_.contract(t, i, j);
  case 3:
    return editor_.contract(t, j, i);
  case 4:
    return editor_.merge(t, i, j);
  default:
    return editor_.swap_face(t, k % 6);
  }
}

struct Mending::Trial {
  int32_t element;
  int operation;
};

// What the deficit and the faults after a trial must be under.
struct Mending::Aim {
  const Faults& before;
  int64_t bent_for_a_point, off;
  double least;
};

Mending::Outcome Mending::attempt(const Trial& trial, FaultCount& faults, Aim& aim) {
  if (!operate(trial.element, trial.operation))
    return Outcome::idle;
  set_out();
  flatten();
  mend(2);
  if (const double now = deficit(); now < 0.995 * aim.least)
    if (const Faults f = faults(); f.off <= aim.off && f.fewer_than(aim.before, aim.bent_for_a_point)) {
      aim.least = now;
      return Outcome::better;
    }
  return Outcome::worse;
}

// What mend(2) leaves of Editor::worst_first for the next trial, unless there was nothing to mend.
bool Mending::follows_mending() const {
  return editor_.worst_first != pass_.worst_first;
}

// From trial `from` on, with the other threads' help: the first that does not leave all as it was, or that the next
// would not follow like any other. Counts the trials down.
size_t Mending::first_telling(const std::vector<Trial>& all, size_t from, FaultCount& faults, const Aim& aim,
                              const Snapshot& here, int& trials) {
  const PartCopy copy = editor_.copy(slots_);
  std::vector<Outcome> outcome(all.size(), Outcome::none);
  std::atomic<size_t> next{from}, telling{all.size()};
  std::atomic<int> tried{0};
  const auto work_off = [&](Mending& mending, FaultCount& f, const Snapshot& start, auto&& number) {
    for (size_t i; tried < trials && (i = next++) < telling;) {
      Aim goal = aim;
      outcome[i] = mending.attempt({number(all[i].element), all[i].operation}, f, goal);
      if (outcome[i] == Outcome::idle)
        continue;
      ++tried;
      if (outcome[i] == Outcome::better || !mending.follows_mending()) {
        outcome[i] = Outcome::better;
        for (size_t first = telling; i < first && !telling.compare_exchange_weak(first, i);)
          ;
      }
      mending.editor_.restore(start);
      mending.editor_.worst_first = !pass_.worst_first;
    }
  };
  helpers_->share([&] { work_off(*this, faults, here, [](int32_t t) { return t; }); },
                  [&] {
                    PartCopy part = copy;
                    std::vector<uint32_t> stamp(part.mesh.element.size());
                    Editor editor(editor_, part, stamp);
                    editor.worst_first = !pass_.worst_first;
                    Mending mending(editor, part.mesh, part.slots, pass_, nullptr);
                    mending.floor = floor;
                    mending.loose = loose;
                    mending.bend = bend;
                    FaultCount f(editor, part.mesh, part.slots, pass_.goal);
                    work_off(mending, f, editor.save(mending.elements()),
                             [&](int32_t t) { return copy.number(t); });
                  });
  size_t i = from;
  for (; i < all.size() && trials > 0 && (outcome[i] == Outcome::idle || outcome[i] == Outcome::worse); ++i)
    trials -= outcome[i] == Outcome::worse;
  return i;
}

void Mending::shake(FaultCount& faults, const Faults& before, int64_t bent_for_a_point, int& trials) {
  Aim aim{before, bent_for_a_point, faults().off, deficit()};
  for (bool done = true; done && aim.least > 0;) {
    done = false;
    const Snapshot here = editor_.save(elements());
    std::vector<Trial> all;
    for (const int32_t t : worst())
      for (int k = 0; k < operations; ++k)
        all.push_back({t, k});
    for (size_t i = 0; i < all.size() && !done && trials > 0; ++i) {
      if (helpers_ && helpers_->any_idle() && editor_.alone() && follows_mending())
        i = first_telling(all, i, faults, aim, here, trials);
      if (i == all.size() || trials == 0)
        break;
      const Outcome outcome = attempt(all[i], faults, aim);
      trials -= outcome != Outcome::idle;
      done = outcome == Outcome::better;
      if (outcome == Outcome::worse)
        editor_.restore(here);
    }
  }
}

} // namespace molmesh::optimize
