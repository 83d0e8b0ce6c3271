// schedule.cpp — which parts there are, what they reserve, and the work of one part after the other.
#include "optimize/schedule/schedule.hpp"
#include "optimize/crossings/facing_triangles.hpp"
#include "par/choose.hpp"
#include "par/pages.hpp"
#include <algorithm>
#include <atomic>
#include <cmath>

namespace molmesh::optimize {

constexpr double looks_of_pass = 0.25; // of those left: what helps little is given up then

Schedule::Schedule(DynamicMesh& mesh, const Target* target, double cell, int threads, bool is_target)
    : m_(mesh), target_(target), cell_(cell), threads_(threads), free_triangles_(1) {
  const auto with_room = [&](auto& v, size_t n) { par::reserve_pages(v, n, n / 4, threads_); };
  with_room(stamp_, m_.element.size());
  with_room(parts_.owner, m_.point.size());
  watch_crossings(guarded, is_target);
}

int64_t Schedule::parts_at_surface(double cell) {
  set_lattice(0, cell * cell_, bounds());
  std::vector<uint8_t> met(static_cast<size_t>(parts_.count()));
  par::for_n(static_cast<int64_t>(m_.point.size()), threads_, [&](int64_t v) {
    if (m_.incident[v] >= 0 && m_.vertex[v].kind == Kind::surface)
      std::atomic_ref(met[parts_.at(m_.point[v])]).store(1, std::memory_order_relaxed);
  });
  return std::count(met.begin(), met.end(), uint8_t{1});
}

void Schedule::watch_crossings(double apart, bool is_target) {
  if (!target_ || watching_everywhere_)
    return;
  free_triangles() = FreeTriangles(1); // two at a time are too much memory
  std::vector<FreeTriangle> triangle = find_free_triangles(m_, threads_);
  watching_everywhere_ =
      apart == everywhere || std::any_of(triangle.begin(), triangle.end(), [&](const FreeTriangle& t) {
        return std::any_of(t.v.begin(), t.v.end(), [&](int32_t v) { return m_.vertex[v].kind == Kind::trace; });
      });
  ends_in_surface_ = !triangle.empty();
  const std::vector<uint8_t> watched = watching_everywhere_ ? std::vector<uint8_t>(triangle.size(), 1)
                                                            : facing(m_.point, triangle, *target_,
                                                                     {.apart = apart * target_->spacing(),
                                                                      .kept = guarded / 2 * target_->spacing(),
                                                                      .none_is_off = is_target},
                                                                     threads_);
  for (Vertex& v : m_.vertex)
    v.watched = false;
  for (size_t t = 0; t < triangle.size(); ++t)
    if (watched[t])
      for (const int32_t v : triangle[t].v)
        m_.vertex[v].watched = true;
  free_triangles() = FreeTriangles(cell_for(triangle));
  std::erase_if(triangle, [&](const FreeTriangle& t) { return !m_.watched(t.v); });
  free_triangles_.reserve(triangle.size(), threads_);
  add([this, all = FreeTriangleChanges{std::move(triangle), {}}] { free_triangles_.merge(all); });
}

FreeTriangles& Schedule::free_triangles() {
  if (adding_.valid())
    adding_.get();
  return free_triangles_;
}

void Schedule::add(std::function<void()> work) {
  free_triangles();
  if (threads_ > 1)
    adding_ = std::async(std::launch::async, std::move(work));
  else
    work();
}

void Schedule::find_worst() {
  par::for_n(static_cast<int64_t>(m_.dirty.size()), threads_, 16, [&](int64_t s) {
    if (!m_.dirty[s])
      return;
    m_.dirty[s] = 0;
    float worst = 2;
    m_.for_chunk(s, [&](int64_t e) {
      if (const Element& el = m_.element[e]; el.alive())
        worst = std::min(worst, el.q);
    });
    m_.worst[s] = worst;
  });
}

float Schedule::worst() {
  find_worst();
  return m_.worst.empty() ? 2 : *std::min_element(m_.worst.begin(), m_.worst.end());
}

int64_t Schedule::below(float goal) const {
  return par::reduce(
      static_cast<int64_t>(m_.dirty.size()), threads_, int64_t{0},
      [&](int64_t s) {
        int64_t n = 0;
        if (m_.dirty[s] || m_.worst[s] < goal)
          m_.for_chunk(s, [&](int64_t e) { n += m_.element[e].alive() && m_.element[e].q < goal; });
        return n;
      },
      [](int64_t a, int64_t b) { return a + b; }, 16);
}

PointBox Schedule::bounds() const {
  return par::reduce(
      static_cast<int64_t>(m_.point.size()), threads_, PointBox{},
      [&](int64_t v) {
        return m_.incident[v] >= 0 ? PointBox{m_.point[v], m_.point[v]} : PointBox{};
      },
      [](PointBox a, const PointBox& b) {
        a.add(b);
        return a;
      });
}

double Schedule::cell_of_all(double cell) const {
  const double most = cell * cell_ / 4;
  const PointBox box = bounds();
  const double extent = std::max({box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z});
  if (extent <= most)
    return 0;
  const bool any_longer = par::reduce(
      static_cast<int64_t>(m_.element.size()), threads_, false,
      [&](int64_t e) {
        const Element& el = m_.element[e];
        return el.alive() && std::any_of(std::begin(edges), std::end(edges), [&](const auto& ij) {
                 return norm(m_.point[el.v[ij[0]]] - m_.point[el.v[ij[1]]]) > most;
               });
      },
      [](bool a, bool b) { return a || b; });
  return any_longer ? 16 * extent / cell_ : 0;
}

void Schedule::set_lattice(int shift, double cell, const PointBox& box) {
  const double most = std::clamp(16. * double(m_.point.size()), 1e6, 1e8); // memory as the points
  parts_.set_lattice(box, cell, shift, most);
}

void Schedule::set_parts(int shift, double cell) {
  set_lattice(shift, cell, bounds());
  find_owners();
}

void Schedule::find_owners() {
  parts_.owner.resize(m_.point.size());
  par::for_n(static_cast<int64_t>(m_.point.size()), threads_,
             [&](int64_t v) { parts_.owner[v] = m_.incident[v] >= 0 ? parts_.at(m_.point[v]) : -1; });
}

void Schedule::set_parts_around(const std::vector<int32_t>& points, int shift, double size) {
  constexpr int32_t reach = 2; // cells: the point stays two fifths of the size from the cube's sides
  const double cell = size / (2 * reach + 1);
  set_lattice(shift, cell, bounds());
  if (parts_.cell > cell) { // too many for the whole mesh, as in a far box: round the points alone
    PointBox around;
    for (const int32_t v : points)
      around.add({m_.point[v], m_.point[v]});
    for (double now = 0, next = cell; next > now; next = parts_.cell) {
      now = next;
      const double beyond = (reach + 2) * now; // so that no point beyond the outermost cells is in a box
      set_lattice(shift, now,
                  {around.low - Vec3d{beyond, beyond, beyond}, around.high + Vec3d{beyond, beyond, beyond}});
    }
  }
  for (size_t i = 0; i < points.size(); ++i)
    parts_.add_box(m_.point[points[shift % 2 == 0 ? i : points.size() - 1 - i]], reach);
  find_owners();
}

int32_t Schedule::part_of(const Element& e) const {
  const int32_t p = parts_.owner[e.v[0]];
  return p >= 0 && parts_.owns(p, e.v) ? p : -1;
}

std::vector<int32_t> Schedule::elements_of_parts() const {
  return par::choose(static_cast<int64_t>(m_.element.size()), threads_, [&](int64_t t) {
    const Element& e = m_.element[t];
    return e.alive() && part_of(e) >= 0;
  });
}

std::vector<int32_t> Schedule::parts_of(const std::vector<int32_t>& elements) const {
  std::vector<int32_t> part(elements.size());
  par::for_n(static_cast<int64_t>(part.size()), threads_,
             [&](int64_t i) { part[i] = part_of(m_.element[elements[i]]); });
  return part;
}

// Items of one part, in order, go to one region with slots of its own.
Counts Schedule::for_parts(const std::vector<int32_t>& items, const std::vector<int32_t>& part_of_item,
                           const Work& work, const PartShares& shares) {
  struct Job {
    PartRoom room;
    std::vector<int32_t> items;
    size_t weight = 0;
    Counts counts;
    Looks looks;
    FreeTriangleChanges changes;
    uint32_t clock = 0;
  };
  std::vector<int32_t> job_of(static_cast<size_t>(parts_.count()), -1);
  std::vector<Job> jobs;
  for (size_t i = 0; i < items.size(); ++i) {
    if (part_of_item[i] < 0)
      continue;
    int32_t& j = job_of[part_of_item[i]];
    if (j < 0) {
      j = static_cast<int32_t>(jobs.size());
      jobs.push_back({});
      jobs.back().room.part = part_of_item[i];
    }
    jobs[j].items.push_back(items[i]);
  }
  for (Job& job : jobs) {
    const auto elements = shares.slots + static_cast<size_t>(shares.slots_per_item * double(job.items.size())),
               vertices = 16 + elements / 4;
    const auto reserve = [](std::vector<int32_t>& pool, std::vector<int32_t>& room, size_t count, size_t& size) {
      while (room.size() < count && !pool.empty())
        room.push_back(pool.back()), pool.pop_back();
      while (room.size() < count)
        room.push_back(static_cast<int32_t>(size++));
    };
    size_t element_size = m_.element.size(), vertex_size = m_.point.size();
    reserve(free_element_, job.room.element, elements, element_size);
    reserve(free_vertex_, job.room.vertex, vertices, vertex_size);
    require_slots(static_cast<int64_t>(element_size), static_cast<int64_t>(vertex_size));
    m_.resize(element_size, vertex_size);
    parts_.owner.resize(vertex_size);
    for (const int32_t v : job.room.vertex)
      parts_.owner[v] = job.room.part;
  }
  if (last_stamp_ > UINT32_MAX / 2) {
    stamp_.clear();
    last_stamp_ = 0;
    std::fill(m_.state.begin(), m_.state.end(), 0);
  }
  stamp_.resize(m_.element.size(), 0);
  std::vector<Job*> largest_first; // else threads wait for one that came last
  size_t weights = 1;
  for (Job& job : jobs) {
    job.weight = shares.weight ? shares.weight(job.room.part) : job.items.size();
    weights += job.weight;
    largest_first.push_back(&job);
  }
  for (Job& job : jobs) { // half of them by their weights
    const double share = (double(job.weight) / double(weights) + 1 / double(jobs.size())) / 2;
    job.looks.allowed = static_cast<int64_t>(double(looks_.allowed - looks_.done) * looks_of_pass * share);
    if (double(looks_.may_earn) * share < 1e15)
      job.looks.may_earn = static_cast<int64_t>(double(looks_.may_earn) * share);
  }
  std::stable_sort(largest_first.begin(), largest_first.end(),
                   [](const Job* a, const Job* b) { return a->weight > b->weight; });
  FreeTriangles& free_now = free_triangles();
  std::atomic<size_t> next{0};
  par::for_n(jobs.empty() ? 0 : threads_, threads_, 1, [&](int64_t) {
    for (size_t j; (j = next++) < jobs.size();) {
      Job& job = *largest_first[j];
      Region r(m_, target_, ends_in_surface_ ? &free_now : nullptr, parts_, stamp_, job.room, last_stamp_);
      r.looks = job.looks;
      work(r, job.items);
      job.looks = r.looks;
      job.counts = r.counts;
      job.changes = r.crossings.take_changes();
      job.clock = r.clock();
    }
  });
  par::for_n(static_cast<int64_t>(jobs.size()), threads_, 1,
             [&](int64_t j) { free_now.move_along(jobs[j].changes); });
  Counts sum;
  std::vector<FreeTriangleChanges> changes;
  for (Job& job : jobs) {
    sum += job.counts;
    looks_.done += job.looks.done;
    last_stamp_ = std::max(last_stamp_, job.clock);
    changes.push_back(std::move(job.changes));
    free_element_.insert(free_element_.end(), job.room.element.begin(), job.room.element.end());
    free_vertex_.insert(free_vertex_.end(), job.room.vertex.begin(), job.room.vertex.end());
  }
  if (ends_in_surface_)
    add([this, changes = std::move(changes)] {
      for (const FreeTriangleChanges& of_part : changes)
        free_triangles_.merge(of_part);
    });
  const int64_t earn = std::min(sum.total(), looks_.may_earn);
  looks_.allowed += Looks::earned * earn;
  looks_.may_earn -= earn;
  return sum;
}

} // namespace molmesh::optimize
