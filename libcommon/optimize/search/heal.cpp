// heal.cpp — the few elements that nothing helps which has to help at once.
#include "optimize/search/heal.hpp"
#include "optimize/acceptance/faults.hpp"
#include "optimize/schedule/schedule.hpp"
#include "optimize/search/mend.hpp"
#include "par/par.hpp"

namespace molmesh::optimize {

constexpr int most_trials = 300; // of Mending::shake
constexpr int most_steps = 1000; // of Mending::wander

void heal_part(Editor& editor, DynamicMesh& m, std::vector<int32_t> slots, const Pass& pass, int32_t time,
               par::Helpers& helpers) {
  FaultCount faults(editor, m, slots, pass.goal);
  Mending mending(editor, m, slots, pass, &helpers);
  mending.floor = 1e-5f;
  mending.loose = true;
  editor.time = time;
  const Snapshot snapshot = editor.save(mending.elements());
  const Faults before = faults();
  Faults allowed = before;
  ++allowed.off; // no point has to come back
  int trials = most_trials, steps = most_steps;
  mending.mend();
  mending.shake(faults, allowed, 0, trials);
  if (pass.effort > 4 && mending.deficit() > 0)
    mending.wander(faults, allowed, 0, steps);
  if (const Faults now = faults(); now.below >= before.below || !faults.better_than(allowed, 0))
    editor.restore(snapshot);
}

Counts Schedule::heal(const Pass& pass) {
  constexpr size_t most = 64; // many are no business of long searches
  const int32_t time = ++time_;
  const std::vector<int32_t> low = low_elements(FaultCount::share * pass.goal, true);
  if (low.empty() || low.size() > most)
    return {};
  std::vector<int32_t> points;
  for (const int32_t t : low)
    points.push_back(m_.element[t].v[0]);
  par::sort_unique(points, 1);
  find_crowded(everywhere);
  set_parts_around(points, passes_++, pass.cell * cell_);
  const std::vector<int32_t> items = elements_of_parts();
  return for_parts(items, parts_of(items), pass.guard,
                   [&](Editor& editor, std::vector<int32_t>& list) {
                     std::vector<int32_t> slots = list;
                     slots.insert(slots.end(), editor.reserve().begin(), editor.reserve().end());
                     heal_part(editor, m_, std::move(slots), pass, time, helpers_);
                   },
                   {.slots_per_item = 0.25});
}

} // namespace molmesh::optimize
