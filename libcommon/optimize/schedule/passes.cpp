// passes.cpp — what a pass works on, and the order of operations on one element.
#include "optimize/schedule/choose.hpp"
#include "optimize/schedule/element_pass.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::optimize {

// A pass whose elements lie in few parts is the work of as few threads. Those inside halves of them come first
// then: few are left for the parts themselves.
constexpr double most_halved = 2;            // cells; larger parts are for the few elements of late rounds
constexpr size_t worth_halving = 4096;       // elements
constexpr double fewest_parts_in_effect = 4; // parts of equal shares come to as many

bool improve_element(Editor& editor, const DynamicMesh& m, int32_t t, const Pass& pass) {
  const auto element = [&]() -> const Element& { return m.element[t]; };
  if (pass.yield < 1)
    for (const auto& [i, j] : edges)
      if (editor.is_tiny(t, i, j) && (editor.contract(t, i, j) || editor.contract(t, j, i)))
        return true;
  for (const auto& [i, j] : edges)
    if (editor.remove_edge(t, i, j))
      return true;
  for (int f = 0; f < 4; ++f)
    if (editor.swap_face(t, f))
      return true;
  const float q = element().q;
  bool done = false;
  for (size_t i = 0; i < 4; ++i) {
    done |= editor.smooth(element().v[i]);
    if (element().q >= pass.goal)
      return true;
  }
  if (element().q > 1.05f * q)
    return true;
  for (const auto& [i, j] : edges)
    if (editor.contract(t, i, j) || editor.contract(t, j, i))
      return true;
  if (pass.effort >= 1) {
    for (const auto& [i, j] : edges)
      if (editor.merge(t, i, j))
        return true;
    for (const auto& [i, j] : edges)
      if (editor.split(t, i, j))
        return true;
  }
  return done;
}

void straighten_element(Editor& editor, const DynamicMesh& m, int32_t t) {
  const auto vertex = [&](int i) { return m.element[t].v[i]; };
  for (int f = 0; f < 4; ++f) {
    if (!editor.bent(t, size_t(f)))
      continue;
    const auto any_edge = [&](auto&& operation) {
      return std::any_of(std::begin(edges), std::end(edges),
                         [&](const auto& e) { return e[0] != f && e[1] != f && operation(e[0], e[1]); });
    };
    if (any_edge([&](int i, int j) { return editor.remove_edge(t, i, j); }))
      return;
    for (int i = 0; i < 4; ++i)
      if (i != f)
        editor.smooth(vertex(i));
    if (!editor.bent(t, size_t(f)))
      return;
    if (any_edge([&](int i, int j) {
          return editor.contract(t, i, j) || editor.contract(t, j, i) || editor.merge(t, i, j);
        }) ||
        any_edge([&](int i, int j) { return editor.split(t, i, j); }))
      return;
  }
  for (int i = 0; i < 4; ++i)
    if (editor.off(vertex(i)) > 1)
      editor.smooth(vertex(i));
}

void sort_worst_first(const DynamicMesh& m, std::vector<int32_t>& list) {
  std::sort(list.begin(), list.end(), [&](int32_t a, int32_t b) {
    const float qa = m.element[a].q, qb = m.element[b].q;
    return qa != qb ? qa < qb : a < b;
  });
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

namespace {

// What is near in the mesh's order is near in space, and still in the caches.
void sort_in_mesh_order(const DynamicMesh& m, std::vector<int32_t>& list, float first_below) {
  par::sort_unique(list, 1);
  std::stable_partition(list.begin(), list.end(), [&](int32_t t) { return m.element[t].q < first_below; });
}

// The elements at a surface vertex: all of them hang together by their faces.
void add_star(const DynamicMesh& m, int32_t v, std::vector<int32_t>& list) {
  const auto first = static_cast<std::ptrdiff_t>(list.size());
  list.push_back(m.incident[v]);
  for (size_t i = size_t(first); i < list.size(); ++i)
    for (size_t f = 0; f < 4; ++f) {
      const Element& e = m.element[list[i]];
      if (e.v[f] != v && e.n[f] >= 0 && std::find(list.begin() + first, list.end(), e.n[f]) == list.end())
        list.push_back(e.n[f]);
    }
}

} // namespace

bool Schedule::worthwhile(int32_t t, float goal) const {
  const Element& e = m_.element[t];
  if (e.q >= goal || !e.alive())
    return false;
  const auto& v = e.v;
  return e.tried <= since_ ||
         std::max({m_.touched[v[0]], m_.touched[v[1]], m_.touched[v[2]], m_.touched[v[3]]}) >= e.tried;
}

Counts Schedule::run(const Pass& pass) {
  last_.cell = pass.cell; // parts of another size alone are no reason to try again
  if (pass != last_)
    since_ = time_; // what failed before may work now
  last_ = pass;
  const int shift = passes_++;
  const double cell = pass.cell * cell_;
  Counts counts;
  std::vector<int32_t> items = low_elements(pass.goal);
  if (pass.cell <= most_halved && in_few_parts(items, shift, cell)) {
    counts = work_off(items, pass, shift, cell / 2);
    items = low_elements(pass.goal);
  }
  return counts += work_off(items, pass, shift, cell);
}

std::vector<int32_t> Schedule::low_elements(float goal, bool tried_too) {
  find_worst();
  return choose(
      static_cast<int64_t>(m_.element.size()), threads_, DynamicMesh::stretch,
      [&](int64_t s) { return m_.worst[s] < goal; },
      [&](int64_t e) {
        const Element& el = m_.element[e];
        return tried_too ? el.alive() && el.q < goal : worthwhile(static_cast<int32_t>(e), goal);
      });
}

bool Schedule::in_few_parts(const std::vector<int32_t>& items, int shift, double cell) {
  if (items.size() < worth_halving)
    return false;
  set_lattice(shift, cell, bounds());
  std::vector<double> share(static_cast<size_t>(parts_.count()));
  for (const int32_t t : items)
    share[parts_.at(m_.point[m_.element[t].v[0]])] += 1 / double(items.size());
  double squares = 0;
  for (const double s : share)
    squares += s * s;
  return squares * fewest_parts_in_effect > 1;
}

// In the lattice's parts, and what comes of them.
Counts Schedule::work_off(const std::vector<int32_t>& items, const Pass& pass, int shift, double cell) {
  constexpr int32_t sweeps = 4;
  const int32_t start = time_;
  time_ += sweeps;
  if (items.empty())
    return {};
  set_parts(shift, cell);
  return for_parts(items, parts_of(items), pass.guard, [&](Editor& editor, std::vector<int32_t>& list) {
    editor.goal = pass.goal;
    editor.worst_first = pass.worst_first;
    editor.yield = pass.yield;
    editor.least_step = pass.least_step;
    for (int32_t sweep = 1; sweep <= sweeps && !list.empty(); ++sweep) {
      editor.time = start + sweep;
      if (pass.in_mesh_order)
        sort_in_mesh_order(m_, list, pass.goal / 2);
      else
        sort_worst_first(m_, list);
      editor.changed.clear();
      for (const int32_t e : list)
        if (worthwhile(e, pass.goal) && !improve_element(editor, m_, e, pass))
          m_.element[e].tried = editor.time;
      list.clear();
      for (const int32_t e : editor.changed)
        if (worthwhile(e, pass.goal))
          list.push_back(e);
    }
  });
}

Counts Schedule::straighten(const Pass& pass) {
  set_parts(passes_++, pass.cell * cell_);
  constexpr int32_t sweeps = 4;
  const int32_t start = time_;
  time_ += sweeps;
  PartRoom none;
  const Editor look(m_, target_, nullptr, parts_, stamp_, none, pass.guard);
  std::vector<int32_t> items = choose(
      static_cast<int64_t>(m_.element.size()), threads_, DynamicMesh::stretch,
      [&](int64_t s) { return m_.labelled[s] != 0; },
      [&](int64_t t) {
        const Element& e = m_.element[t];
        bool bent = false;
        for (size_t i = 0; e.alive() && !bent && i < 4; ++i)
          bent = e.label[i] != 0 && look.bent(static_cast<int32_t>(t), i);
        return bent;
      });
  for (const int32_t v : points_off())
    add_star(m_, v, items);
  par::sort_unique(items, threads_);
  return for_parts(items, parts_of(items), pass.guard, [&](Editor& editor, std::vector<int32_t>& list) {
    editor.goal = pass.goal;
    editor.worst_first = pass.worst_first;
    editor.straighten = true;
    for (int32_t sweep = 1; sweep <= sweeps && !list.empty(); ++sweep) {
      editor.time = start + sweep;
      par::sort_unique(list, 1);
      editor.changed.clear();
      for (const int32_t e : list)
        if (m_.element[e].alive())
          straighten_element(editor, m_, e);
      list.swap(editor.changed);
    }
  });
}

std::vector<int32_t> Schedule::surface_points() const {
  return choose(static_cast<int64_t>(m_.point.size()), threads_,
                [&](int64_t v) { return m_.incident[v] >= 0 && follows_target(m_.vertex[v].kind); });
}

std::vector<int32_t> Schedule::points_off() const {
  if (!target_)
    return {};
  std::vector<int32_t> points = surface_points();
  par::for_n((static_cast<int64_t>(points.size()) + 7) / 8, threads_, 256, [&](int64_t group) {
    int32_t* const v = points.data() + 8 * group;
    const size_t n = std::min<size_t>(8, points.size() - 8 * size_t(group));
    const EightProbes probes = probe_some(*target_, m_.point, v, n);
    for (size_t i = 0; i < n; ++i)
      if (probes.is_known(i) && target_->off_by(probes.distance[i]) <= 1)
        v[i] = -1;
  });
  std::erase(points, -1);
  return points;
}

Counts Schedule::settle(float floor, const Guard& guard) {
  set_parts(settles_++, cell_);
  const std::vector<int32_t> items = surface_points();
  std::vector<int32_t> part;
  for (const int32_t v : items)
    part.push_back(parts_.owner[v]);
  const int32_t time = ++time_;
  return for_parts(items, part, guard,
                   [&](Editor& editor, std::vector<int32_t>& list) {
                     editor.time = time;
                     editor.settle(list, floor);
                   },
                   {.slots_per_item = 0}); // nothing new comes
}

} // namespace molmesh::optimize
