// passes.cpp — what a pass works on, and in which order.
#include "optimize/acceptance/faults.hpp"
#include "optimize/acceptance/surface_fit.hpp"
#include "optimize/operations/on_element.hpp"
#include "optimize/schedule/schedule.hpp"
#include "optimize/search/search_part.hpp"
#include "par/choose.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::optimize {

// A pass whose elements lie in few parts is the work of as few threads. Those inside halves of them come first
// then: few are left for the parts themselves.
constexpr double most_halved = 2;            // cells; larger parts are for the few elements of late rounds
constexpr size_t worth_halving = 4096;       // elements
constexpr double fewest_parts_in_effect = 4; // parts of equal shares come to as many

namespace {

// What is near in the mesh's order is near in space, and still in the caches.
void sort_in_mesh_order(const DynamicMesh& m, std::vector<int32_t>& list, float first_below) {
  par::sort_unique(list, 1);
  std::stable_partition(list.begin(), list.end(), [&](int32_t t) { return m.element[t].q < first_below; });
}

Acceptance acceptance_of(const Pass& pass) {
  Acceptance a(pass.guard);
  a.goal = pass.goal;
  a.worst_first = pass.worst_first;
  a.tiny_share = pass.tiny_share;
  a.least_step = pass.least_step;
  a.thorough = pass.thorough;
  return a;
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
  return par::choose(
      static_cast<int64_t>(m_.element.size()), threads_, DynamicMesh::chunk,
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
  const Acceptance accept = acceptance_of(pass);
  return for_parts(items, parts_of(items), [&](Region& r, std::vector<int32_t>& list) {
    for (int32_t sweep = 1; sweep <= sweeps && !list.empty(); ++sweep) {
      r.time = start + sweep;
      if (pass.in_mesh_order)
        sort_in_mesh_order(m_, list, pass.goal / 2);
      else
        sort_worst_first(m_, list);
      r.changed.clear();
      for (const int32_t e : list)
        if (r.looks_left() && worthwhile(e, pass.goal) && !improve_element(r, accept, e, pass.merges_and_splits))
          m_.element[e].tried = r.time;
      list.clear();
      for (const int32_t e : r.changed)
        if (worthwhile(e, pass.goal))
          list.push_back(e);
    }
  });
}

Counts Schedule::fit_surface(const Pass& pass) {
  Acceptance accept(pass.guard);
  accept.goal = pass.goal;
  accept.worst_first = pass.worst_first;
  accept.aim = Aim::fit;
  set_parts(passes_++, pass.cell * cell_);
  constexpr int32_t sweeps = 4;
  const int32_t start = time_;
  time_ += sweeps;
  PartRoom none;
  const Region look(m_, target_, nullptr, parts_, stamp_, none);
  std::vector<int32_t> items = par::choose(
      static_cast<int64_t>(m_.element.size()), threads_, DynamicMesh::chunk,
      [&](int64_t s) { return m_.labelled[s] != 0; },
      [&](int64_t t) {
        const Element& e = m_.element[t];
        bool bent = false;
        for (size_t i = 0; e.alive() && !bent && i < 4; ++i)
          bent = e.label[i] != 0 && is_bent(look, accept, static_cast<int32_t>(t), i);
        return bent;
      });
  for (const int32_t v : points_off())
    add_star(m_, v, items);
  par::sort_unique(items, threads_);
  return for_parts(items, parts_of(items), [&](Region& r, std::vector<int32_t>& list) {
    for (int32_t sweep = 1; sweep <= sweeps && !list.empty(); ++sweep) {
      r.time = start + sweep;
      par::sort_unique(list, 1);
      r.changed.clear();
      for (const int32_t e : list)
        if (r.looks_left() && m_.element[e].alive())
          fit_element(r, accept, e);
      list.swap(r.changed);
    }
  });
}

std::vector<int32_t> Schedule::surface_points() const {
  return par::choose(static_cast<int64_t>(m_.point.size()), threads_,
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
      if (has_main_target(m_, v[i]) ? probes.is_known(i) && target_->off_by(probes.distance[i]) <= 1
                                    : off(m_, target_, v[i]) <= 1)
        v[i] = -1;
  });
  std::erase(points, -1);
  return points;
}

Counts Schedule::project(float floor, const Guard& guard) {
  set_parts(projections_++, cell_);
  const std::vector<int32_t> items = surface_points();
  std::vector<int32_t> part;
  for (const int32_t v : items)
    part.push_back(parts_.owner[v]);
  const int32_t time = ++time_;
  const Acceptance accept(guard);
  return for_parts(items, part,
                   [&](Region& r, std::vector<int32_t>& list) {
                     r.time = time;
                     project_to_surface(r, accept, list, floor);
                   },
                   {.slots_per_item = 0}); // nothing new comes
}

// A body thinner than the grid is off with most of its points: trials at each would take minutes, and bring some
// back.
bool Schedule::is_hopeless(size_t points_off) const {
  constexpr size_t few = 64, share = 4;
  return points_off > few && share * points_off > surface_points().size();
}

// One vertex for each place to search at; empty where there is none, or too many.
std::vector<int32_t> Schedule::places_to_search(const Strategy& s) {
  if (s.scope == Scope::points) {
    std::vector<int32_t> points = points_off();
    return is_hopeless(points.size()) ? std::vector<int32_t>{} : points;
  }
  const std::vector<int32_t> low = low_elements(FaultCount::share * s.goal, true);
  std::vector<int32_t> points;
  for (const int32_t t : low)
    points.push_back(m_.element[t].v[0]);
  par::sort_unique(points, 1);
  return low.size() > s.most_elements ? std::vector<int32_t>{} : points;
}

Counts Schedule::search(const Strategy& s) {
  constexpr size_t room_for_shells = 3072; // elements, shrink_cavity
  const int32_t time = ++time_;
  const std::vector<int32_t> points = places_to_search(s);
  if (points.empty() || looks_.done >= looks_.allowed)
    return {};
  watch_crossings(everywhere); // points leave the surface meanwhile
  set_parts_around(points, passes_++, s.part_size * cell_);
  const std::vector<int32_t> items = elements_of_parts();
  std::vector<std::vector<int32_t>> places(static_cast<size_t>(parts_.count())); // of each part
  for (const int32_t v : points)
    if (const int32_t part = parts_.owner[v]; part >= 0)
      places[part].push_back(v);
  std::vector<uint8_t> failed(places.size());
  failed_searches_.begin(s);
  const Counts counts = for_parts(items, parts_of(items),
                                  [&](Region& r, std::vector<int32_t>& list) {
                                    const auto part = static_cast<size_t>(r.part());
                                    int32_t touched = 0;
                                    for (const int32_t t : list)
                                      for (const int32_t v : m_.element[t].v)
                                        touched = std::max(touched, m_.touched[v]);
                                    if (failed_searches_.knows(places[part], s, touched))
                                      return;
                                    std::vector<int32_t> slots = list;
                                    slots.insert(slots.end(), r.room.element.begin(), r.room.element.end());
                                    r.time = time;
                                    search_part(r, slots, s);
                                    failed[part] = r.counts.total() == 0 && r.looks_left();
                                  },
                                  {.slots_per_item = 0.25,
                                   .slots = s.scope == Scope::points ? room_for_shells : PartShares{}.slots,
                                   .weight = [&](int32_t part) { return places[part].size(); }});
  for (size_t part = 0; part < places.size(); ++part)
    if (failed[part])
      failed_searches_.note(places[part], s, time);
  return counts;
}

} // namespace molmesh::optimize
