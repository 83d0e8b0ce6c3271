// recover.cpp — points off the target come back, or leave the surface, where the elements around can be mended
// after.
#include "optimize/search/recover.hpp"
#include "optimize/acceptance/faults.hpp"
#include "optimize/search/mend.hpp"
#include <algorithm>
#include <optional>
#include <utility>

namespace molmesh::optimize {
namespace {

constexpr size_t most_points = 64; // more were let go here and there: that is what the rounds are for
constexpr size_t most_states = 4;
constexpr int most_trials = 300, most_bent_trials = 2000; // of Mending::shake
constexpr int most_steps = 3000;                          // of Mending::wander
constexpr double hopeless = 3; // of Mending::mend: of 357 that came right 353 lacked less after a round

// How far a trial goes. Bold ones come second, for the points that are left.
struct Daring {
  float floor;      ///< share of the goal: what a step towards the target may leave for the mending
  bool loose;       ///< Editor::loose, while mending
  int64_t for_bent; ///< triangles that may be bent for a point that comes back
  bool straighten;  ///< bent triangles once more, when elements are mended
  bool bend;        ///< triangles may bend, while mending
};
constexpr Daring careful{0.01f, false, 0, false, false}, bold{1e-5f, true, 2, false, false},
    in_necks{1e-5f, true, 2, true, false}, bending{1e-5f, true, 8, true, true},
    yielding{1e-5f, true, 8, true, false};

// Where the isosurface grazes a wall the mesh has no room for it: long searches there are nearly always in vain.
bool at_wall(std::vector<int32_t> points, const DynamicMesh& m, double spacing) {
  std::erase_if(points, [&](int32_t v) { return m.vertex[v].kind != Kind::surface; });
  return points.empty() ||
         std::any_of(points.begin(), points.end(), [&](int32_t v) { return !m.walls.clear(m.point[v], spacing); });
}

class Recovery {
public:
  Recovery(Editor& editor, DynamicMesh& m, std::vector<int32_t> slots, const Pass& pass, int32_t time,
           par::Helpers& helpers)
      : editor_(editor), m_(m), slots_(std::move(slots)), pass_(pass), time_(time),
        faults_(editor, m_, slots_, pass.goal), mending_(editor, m_, slots_, pass, &helpers) {}

  /// shaken: all up to the necks has been in vain.
  void run(bool shaken) {
    if (shaken) {
      editor_.worst_first = !pass_.worst_first; // as mending leaves it
      if (faults_.points_off().size() <= most_points)
        try_necks(in_necks);
      return;
    }
    // Where the mesh ends in it, a surface that bends freely could turn inside out unseen.
    const bool bends = pass_.effort > 3 && editor_.alone();
    // A guard wider than that lets it bend so far.
    const bool yields = pass_.guard.angle > Guard::widest_unbent;
    const Daring& second = bends ? bending : yields ? yielding : bold;
    for (const Daring& daring : {careful, second}) {
      if (pass_.effort > 1 && !daring.loose)
        continue; // in vain the time before
      dare(daring);
      const std::vector<int32_t> points = faults_.points_off();
      if (points.empty() || points.size() > most_points)
        return;
      if (points.size() > 1)
        all_back(points);
      for (const int32_t v : faults_.points_off())
        if (is_off(v))
          bring_back(v);
      here_.reset();
    }
    if (pass_.effort > 1)
      try_harder();
    if (pass_.effort > 2)
      try_necks(bends || yields ? second : in_necks);
  }

private:
  void try_necks(const Daring& daring) {
    follow_necks(daring);
    try_harder();
  }
  void dare(const Daring& daring) {
    daring_ = daring;
    mending_.floor = daring.floor;
    mending_.loose = daring.loose;
    mending_.bend = daring.bend;
  }
  bool is_off(int32_t v) const { return m_.incident[v] >= 0 && editor_.off(v) > 1; }

  // True when the operation leaves the part better, once it is mended; nothing has changed otherwise.
  template <class Operation>
  bool attempt(const Snapshot& snapshot, const Faults& before, Operation&& operation) {
    editor_.time = time_;
    mending_.set_out();
    editor_.bold = true;
    editor_.changed.clear();
    if (operation()) {
      mending_.set_out();
      mending_.flatten();
      mending_.mend(6, pass_.effort > 1 ? 1e30 : hopeless);
      if (daring_.straighten && mending_.deficit() == 0)
        mending_.straighten();
      if (faults_.better_than(before, daring_.for_bent)) {
        nearly_.clear();
        return true;
      }
      if (pass_.effort > 1)
        remember(before);
    }
    editor_.restore(snapshot);
    return false;
  }

  // Puts a state by that lacks some elements' quality alone.
  void remember(const Faults& before) {
    const Faults now = faults_();
    if (!now.fewer_than(before, daring_.for_bent))
      return;
    const double lacks = mending_.deficit() + 0.3 * double(now.off);
    const auto at = std::find_if(nearly_.begin(), nearly_.end(), [&](const auto& n) { return lacks <= n.first; });
    if (at != nearly_.end() && at->first == lacks)
      return; // the same, by another way
    if (at == nearly_.end() && nearly_.size() >= most_states)
      return;
    nearly_.emplace(at, lacks, editor_.save(mending_.elements()));
    if (nearly_.size() > most_states)
      nearly_.pop_back();
  }

  // The states put by since the part last changed, best first.
  void try_harder() {
    if (nearly_.empty())
      return;
    const Snapshot snapshot = editor_.save(mending_.elements());
    const Faults before = faults_();
    const bool long_search = pass_.effort > 3 && !at_wall(faults_.points_off(), m_, editor_.spacing());
    int trials = long_search ? most_bent_trials : most_trials,
        steps = long_search && pass_.effort > 4 ? most_steps : 0;
    for (const auto& [lacks, state] : std::exchange(nearly_, {})) {
      editor_.restore(state);
      mending_.shake(faults_, before, daring_.for_bent, trials);
      if (steps > 0 && !faults_.better_than(before, daring_.for_bent))
        mending_.wander(faults_, before, daring_.for_bent, steps);
      if (faults_.better_than(before, daring_.for_bent))
        return;
    }
    editor_.restore(snapshot);
  }

  // A cavity smaller than the grid is off with all its points.
  void all_back(const std::vector<int32_t>& points) {
    attempt(editor_.save(mending_.elements()), faults_(), [&] {
      if (daring_.loose)
        return step_by_step(points, 0.1f);
      bool done = false;
      for (int sweep = 0; sweep < 4; ++sweep)
        for (const int32_t v : points)
          if (is_off(v))
            done |= editor_.smooth(v);
      return done;
    });
  }

  // A part of the way at a time; what is around is mended in between. floor: share of the goal.
  bool step_by_step(const std::vector<int32_t>& points, float floor) {
    bool done = false;
    for (int step = 0; step < 12; ++step) {
      bool moved = false;
      for (const int32_t v : points)
        moved |= is_off(v) && editor_.approach(v, floor * pass_.goal);
      if (!moved)
        break;
      done = true;
      mending_.mend();
    }
    return done;
  }

  // Edges of the surface at v flip until it can leave.
  bool cut_off(int32_t v) {
    if (m_.vertex[v].kind != Kind::surface)
      return false;
    for (int flips = 0; flips < 8; ++flips) {
      bool flipped = false;
      for (size_t k = 0; k < slots_.size() && !flipped; ++k) {
        const Element e = m_.element[slots_[k]];
        const int i = e.alive() ? e.find(v) : -1;
        for (int j = 0; i >= 0 && j < 4 && !flipped; ++j)
          flipped = j != i && follows_target(m_.vertex[e.v[j]].kind) && editor_.remove_edge(slots_[k], i, j);
      }
      if (!flipped)
        return false;
      if (editor_.hand_over(v))
        return true;
    }
    return false;
  }

  // Where the target is narrow: this leaves elements as small as the neck, so it comes last.
  void follow_necks(const Daring& daring) {
    dare(daring);
    const double same = 0.1 * editor_.spacing();
    std::vector<Vec3d> met;
    for (const int32_t v : faults_.points_off()) {
      Neck neck;
      if (!is_off(v) || !editor_.find_neck(v, neck) ||
          std::any_of(met.begin(), met.end(), [&](Vec3d at) { return norm(at - neck.at) < same; }))
        continue;
      met.push_back(neck.at);
      const Snapshot snapshot = editor_.save(mending_.elements());
      const Faults before = faults_();
      for (const double ratio : {0.5, 0.35, 0.65})
        if (attempt(snapshot, before, [&] {
              return editor_.follow_neck(v, neck, ratio) && (step_by_step(faults_.points_off(), 0.1f), true);
            }))
          break;
    }
  }

  void bring_back(int32_t v) {
    if (!here_)
      here_.emplace(editor_.save(mending_.elements()));
    if (try_all(v, *here_))
      here_.reset();
  }

  // True when the part has changed: then it is better.
  bool try_all(int32_t v, const Snapshot& snapshot) {
    const Faults before = faults_();
    if (attempt(snapshot, before, [&] { return editor_.smooth(v); }) ||
        attempt(snapshot, before, [&] { return editor_.hand_over(v); }) ||
        attempt(snapshot, before, [&] { return cut_off(v); }))
      return true;
    if (daring_.loose)
      for (const float floor : {0.1f, 0.01f})
        if (attempt(snapshot, before, [&] { return step_by_step({v}, floor); }))
          return true;
    for (const double ratio : {0.5, 0.35, 0.65})
      if (attempt(snapshot, before, [&] { return editor_.nest(v, ratio); }))
        return true;
    std::vector<std::array<int32_t, 3>> edges; // neighbour on the surface, element, 4 i + j
    for (const auto& [t, e] : snapshot.element)
      if (const int i = e.find(v); i >= 0)
        for (int j = 0; j < 4; ++j)
          if (j != i && follows_target(m_.vertex[e.v[j]].kind))
            edges.push_back({e.v[j], t, 4 * i + j});
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end(), [](const auto& a, const auto& b) { return a[0] == b[0]; }),
                edges.end());
    for (const auto& [w, t, ij] : edges)
      if (attempt(snapshot, before, [&, e = t, k = ij] { return editor_.contract(e, k / 4, k % 4); }) ||
          attempt(snapshot, before, [&, e = t, k = ij] { return editor_.merge(e, k / 4, k % 4); }) ||
          attempt(snapshot, before, [&, e = t, k = ij] { return editor_.remove_edge(e, k / 4, k % 4); }))
        return true;
    return false;
  }

  Editor& editor_;
  DynamicMesh& m_;
  const std::vector<int32_t> slots_; ///< all that elements of this part may be in
  const Pass& pass_;
  const int32_t time_;
  FaultCount faults_;
  Mending mending_;
  Daring daring_ = careful;
  std::optional<Snapshot> here_;                    ///< of bring_back(): nothing has changed since
  std::vector<std::pair<double, Snapshot>> nearly_; ///< what it lacks, state; ascending
};

// The points come back to a lower goal, and all that is below the goal is mended after: elements that had nowhere
// to go while these points were off often have then.
void detour(Editor& editor, DynamicMesh& m, const std::vector<int32_t>& slots, const Pass& pass, int32_t time,
            par::Helpers& helpers) {
  FaultCount faults(editor, m, slots, pass.goal);
  if (at_wall(faults.points_off(), m, editor.spacing()))
    return;
  Mending mending(editor, m, slots, pass, &helpers);
  mending.floor = bending.floor;
  mending.loose = bending.loose;
  const Snapshot snapshot = editor.save(mending.elements());
  const Faults before = faults();
  Pass lower = pass;
  lower.at_first = 1;
  lower.goal *= pass.at_first;
  Recovery(editor, m, slots, lower, time, helpers).run(false);
  if (editor.counts.total() == snapshot.counts.total())
    return;
  int trials = most_bent_trials, steps = most_steps;
  mending.mend();
  mending.shake(faults, before, bending.for_bent, trials);
  if (mending.deficit() > 0)
    mending.wander(faults, before, bending.for_bent, steps);
  if (!faults.better_than(before, bending.for_bent))
    editor.restore(snapshot);
}

} // namespace

void recover_part(Editor& editor, DynamicMesh& m, std::vector<int32_t> slots, const Pass& pass, int32_t time,
                  bool shaken, par::Helpers& helpers) {
  if (pass.at_first < 1)
    detour(editor, m, slots, pass, time, helpers);
  else
    Recovery(editor, m, std::move(slots), pass, time, helpers).run(shaken);
}

} // namespace molmesh::optimize
