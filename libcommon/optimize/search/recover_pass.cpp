// recover_pass.cpp — the points off the target and the parts around them, those left out where nothing has changed
// since the same was in vain.
#include "optimize/schedule/schedule.hpp"
#include "optimize/search/recover.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <utility>

namespace molmesh::optimize {

constexpr size_t room_for_shells = 3072; // elements, Editor::nest

// A body thinner than the grid is off with most of its points: trials at each would take minutes, and bring some
// back.
bool Schedule::is_hopeless(size_t points_off) const {
  constexpr size_t few = 64, share = 4;
  return points_off > few && share * points_off > surface_points().size();
}

Counts Schedule::recover(const Pass& pass) {
  const int32_t time = ++time_;
  const std::vector<int32_t> points = points_off();
  if (points.empty() || is_hopeless(points.size()))
    return {};
  find_crowded(everywhere); // they leave it meanwhile
  set_parts_around(points, passes_++, pass.cell * cell_);
  const std::vector<int32_t> items = elements_of_parts();
  std::vector<std::vector<int32_t>> off(static_cast<size_t>(parts_.count())); // of each part
  for (const int32_t v : points)
    if (const int32_t part = parts_.owner[v]; part >= 0)
      off[part].push_back(v);
  std::vector<uint8_t> failed(off.size());
  vain_.begin(pass);
  Pass shaking = pass;
  shaking.effort = 2;
  const Counts counts = for_parts(
      items, parts_of(items), pass.guard,
      [&](Editor& editor, std::vector<int32_t>& list) {
        const auto part = static_cast<size_t>(editor.part());
        int32_t touched = 0;
        for (const int32_t t : list)
          for (const int32_t v : m_.element[t].v)
            touched = std::max(touched, m_.touched[v]);
        if (vain_.knows(off[part], pass, touched))
          return;
        const bool shaken = pass.effort == 3 && vain_.knows(off[part], shaking, touched);
        std::vector<int32_t> slots = list;
        slots.insert(slots.end(), editor.reserve().begin(), editor.reserve().end());
        recover_part(editor, m_, std::move(slots), pass, time, shaken, helpers_);
        failed[part] = editor.counts.total() == 0;
      },
      {.slots_per_item = 0.25, .slots = room_for_shells, .weight = [&](int32_t part) { return off[part].size(); }});
  for (size_t part = 0; part < off.size(); ++part)
    if (failed[part])
      vain_.note(off[part], pass, time);
  return counts;
}

} // namespace molmesh::optimize
