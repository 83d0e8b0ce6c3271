// recover.cpp — points off the target come back, or leave the surface, where the elements around can be mended
// after.
#include "improve/choose.hpp"
#include "improve/element_pass.hpp"
#include "improve/schedule.hpp"
#include "improve/vertex_numbers.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::improve {
namespace {

constexpr float floor_share = 0.01f; // of the goal: what a step towards the target may leave for the mending

constexpr size_t most_points = 64;

// What is wrong in a part.
struct Faults {
  int64_t off = 0, bent = 0, below = 0;
  float worst = 2;
};

class Recovery {
public:
  Recovery(Editor& editor, DynamicMesh& m, std::vector<int32_t> slots, const Pass& pass, int32_t time)
      : editor_(editor), m_(m), slots_(std::move(slots)), pass_(pass), time_(time) {}

  void run() {
    const std::vector<int32_t> points = points_off();
    if (points.size() > most_points)
      return; // more than was let go here and there: that is what the rounds are for
    if (points.size() > 1 && attempt(editor_.save(inner()), faults(), [&] { return all_at_once(points); }) &&
        points_off().empty())
      return;
    for (const int32_t v : points)
      if (m_.incident[size_t(v)] >= 0 && editor_.off(v) > 1)
        bring_back(v);
  }

private:
  std::vector<int32_t> inner() const {
    std::vector<int32_t> all;
    for (const int32_t t : slots_)
      if (m_.element[size_t(t)].alive())
        all.push_back(t);
    return all;
  }
  std::vector<int32_t> points_off() {
    surface_points_.clear();
    for (const int32_t t : slots_)
      if (const Element& e = m_.element[size_t(t)]; e.alive())
        for (const int32_t v : e.v)
          if (m_.vertex[size_t(v)].kind == Kind::surface)
            surface_points_(v);
    std::vector<int32_t> off;
    for (const int32_t v : surface_points_.met())
      if (editor_.off(v) > 1)
        off.push_back(v);
    std::sort(off.begin(), off.end());
    return off;
  }
  void count_bad(Faults& f) const {
    for (const int32_t t : slots_)
      if (const Element& e = m_.element[size_t(t)]; e.alive()) {
        f.worst = std::min(f.worst, e.q);
        f.below += e.q < 0.94f * pass_.goal;
      }
  }
  void count_misfits(Faults& f) {
    f.off = static_cast<int64_t>(points_off().size());
    for (const int32_t t : slots_)
      for (size_t i = 0; i < 4 && m_.element[size_t(t)].alive(); ++i)
        f.bent += editor_.bent(t, i);
  }
  Faults faults() {
    Faults f;
    count_bad(f);
    count_misfits(f);
    return f;
  }
  bool better_than(const Faults& before) {
    Faults now;
    count_bad(now);
    if (now.below > before.below || (now.below > 0 && now.worst < before.worst))
      return false;
    count_misfits(now);
    return now.off < before.off && now.bent <= before.bent;
  }

  void flatten() {
    for (int sweep = 0; sweep < 3 && !editor_.changed.empty(); ++sweep) {
      std::vector<int32_t> list;
      list.swap(editor_.changed);
      par::sort_unique(list, 1);
      for (const int32_t t : list)
        if (m_.element[size_t(t)].alive())
          straighten_element(editor_, m_, t);
    }
  }
  void mend() {
    editor_.straighten = false;
    editor_.goal = pass_.goal;
    for (int k = 0; k < 6; ++k) {
      Pass pass = pass_;
      pass.worst_first = k % 2 == 0;
      editor_.worst_first = pass.worst_first;
      std::vector<int32_t> list;
      for (const int32_t t : slots_)
        if (m_.element[size_t(t)].alive() && m_.element[size_t(t)].q < pass.goal)
          list.push_back(t);
      if (list.empty())
        return;
      for (int sweep = 0; sweep < 4 && !list.empty(); ++sweep) {
        sort_worst_first(m_, list);
        editor_.changed.clear();
        for (const int32_t t : list)
          if (m_.element[size_t(t)].alive() && m_.element[size_t(t)].q < pass.goal)
            improve_element(editor_, m_, t, pass);
        list.clear();
        for (const int32_t t : editor_.changed)
          if (m_.element[size_t(t)].alive() && m_.element[size_t(t)].q < pass.goal)
            list.push_back(t);
      }
    }
  }

  // True when the operation leaves the part better, once it is mended; nothing has changed otherwise.
  template <class Operation>
  bool attempt(const Snapshot& snapshot, const Faults& before, Operation&& operation) {
    editor_.straighten = true;
    editor_.goal = floor_share * pass_.goal;
    editor_.time = time_;
    editor_.bold = true;
    editor_.changed.clear();
    const bool done = operation();
    editor_.bold = false;
    if (done) {
      flatten();
      mend();
      if (better_than(before))
        return true;
    }
    editor_.restore(snapshot);
    return false;
  }

  // A cavity smaller than the grid is off with all its points.
  bool all_at_once(const std::vector<int32_t>& points) {
    bool done = false;
    for (int sweep = 0; sweep < 4; ++sweep)
      for (const int32_t v : points)
        if (m_.incident[size_t(v)] >= 0 && editor_.off(v) > 1)
          done |= editor_.smooth(v);
    return done;
  }

  // Edges of the surface at v flip until it can leave.
  bool cut_off(int32_t v) {
    for (int flips = 0; flips < 8; ++flips) {
      bool flipped = false;
      for (size_t k = 0; k < slots_.size() && !flipped; ++k) {
        const Element e = m_.element[size_t(slots_[k])];
        const int i = e.alive() ? e.find(v) : -1;
        for (int j = 0; i >= 0 && j < 4 && !flipped; ++j)
          flipped = j != i && m_.vertex[size_t(e.v[size_t(j)])].kind == Kind::surface &&
                    editor_.remove_edge(slots_[k], i, j);
      }
      if (!flipped)
        return false;
      if (editor_.hand_over(v))
        return true;
    }
    return false;
  }
  void bring_back(int32_t v) {
    const Snapshot snapshot = editor_.save(inner());
    const Faults before = faults();
    if (attempt(snapshot, before, [&] { return editor_.smooth(v); }) ||
        attempt(snapshot, before, [&] { return editor_.hand_over(v); }) ||
        attempt(snapshot, before, [&] { return cut_off(v); }))
      return;
    std::vector<std::array<int32_t, 3>> edges; // neighbour on the surface, element, 4 i + j
    for (const auto& [t, e] : snapshot.element)
      if (const int i = e.find(v); i >= 0)
        for (int j = 0; j < 4; ++j)
          if (j != i && m_.vertex[size_t(e.v[size_t(j)])].kind == Kind::surface)
            edges.push_back({e.v[size_t(j)], t, 4 * i + j});
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end(), [](const auto& a, const auto& b) { return a[0] == b[0]; }),
                edges.end());
    for (const auto& [w, t, ij] : edges)
      if (attempt(snapshot, before, [&, e = t, k = ij] { return editor_.contract(e, k / 4, k % 4); }) ||
          attempt(snapshot, before, [&, e = t, k = ij] { return editor_.merge(e, k / 4, k % 4); }) ||
          attempt(snapshot, before, [&, e = t, k = ij] { return editor_.remove_edge(e, k / 4, k % 4); }))
        return;
  }

  Editor& editor_;
  DynamicMesh& m_;
  const std::vector<int32_t> slots_; ///< all that elements of this part may be in
  const Pass& pass_;
  const int32_t time_;
  VertexNumbers surface_points_;
};

} // namespace

Counts Schedule::recover(const Pass& pass) {
  set_parts(passes_++, pass.cell * cell_);
  const int32_t time = ++time_;
  PartRoom none;
  const Editor look(m_, target_, nullptr, parts_, stamp_, none, pass.guard);
  std::vector<uint8_t> off(m_.point.size());
  par::for_n(static_cast<int64_t>(off.size()), threads_, [&](int64_t v) {
    off[size_t(v)] = m_.incident[size_t(v)] >= 0 && look.off(static_cast<int32_t>(v)) > 1;
  });
  std::vector<int32_t> wanted;
  for (size_t v = 0; v < off.size(); ++v)
    if (off[v])
      wanted.push_back(parts_.owner[v]);
  if (wanted.empty())
    return {};
  par::sort_unique(wanted, threads_);
  const std::vector<int32_t> items = choose(static_cast<int64_t>(m_.element.size()), threads_, [&](int64_t t) {
    const Element& e = m_.element[size_t(t)];
    return e.alive() && std::binary_search(wanted.begin(), wanted.end(), part_of(e));
  });
  return for_parts(
      items, parts_of(items), pass.guard,
      [&](Editor& editor, std::vector<int32_t>& list) {
        std::vector<int32_t> slots = list;
        slots.insert(slots.end(), editor.reserve().begin(), editor.reserve().end());
        Recovery(editor, m_, std::move(slots), pass, time).run();
      },
      0.25);
}

} // namespace molmesh::improve
