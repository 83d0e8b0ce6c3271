// faults.cpp — faults are found once among all slots, then among those written.
#include "optimize/acceptance/faults.hpp"
#include "optimize/acceptance/surface_fit.hpp"
#include <algorithm>

namespace molmesh::optimize {

namespace {

using Places = std::vector<std::pair<int32_t, int32_t>>;

std::shared_ptr<const Places> places_of(const std::vector<int32_t>& slots) {
  const auto places = std::make_shared<Places>();
  places->reserve(slots.size());
  for (const int32_t slot : slots)
    places->emplace_back(slot, static_cast<int32_t>(places->size()));
  std::sort(places->begin(), places->end());
  return places;
}

} // namespace

LowElements::LowElements(const DynamicMesh& m, const std::vector<int32_t>& slots, const ChangeLog& log, float goal)
    : m_(m), slots_(slots), log_(log), goal_(goal), place_(places_of(slots)) {}

LowElements::LowElements(const LowElements& other, float goal)
    : m_(other.m_), slots_(other.slots_), log_(other.log_), goal_(goal), place_(other.place_) {}

const std::vector<int32_t>& LowElements::operator()() {
  const auto is_low = [&](int32_t t) { return m_.element[t].alive() && m_.element[t].q < goal_; };
  const auto place = [&](int32_t t) {
    return std::lower_bound(place_->begin(), place_->end(), std::pair{t, 0})->second;
  };
  const bool some = log_.since(seen_, written_);
  seen_ = log_.now();
  if (some && written_.empty())
    return low_;
  if (some) {
    std::erase_if(by_place_,
                  [&](const auto& at) { return std::binary_search(written_.begin(), written_.end(), at.second); });
    for (const int32_t t : written_)
      if (t >= 0 && is_low(t))
        by_place_.emplace_back(size_t(place(t)), t);
    std::sort(by_place_.begin(), by_place_.end());
  } else {
    by_place_.clear();
    for (size_t k = 0; k < slots_.size(); ++k)
      if (is_low(slots_[k]))
        by_place_.emplace_back(k, slots_[k]);
  }
  low_.clear();
  for (const auto& at : by_place_)
    low_.push_back(at.second);
  return low_;
}

// Whether v is a corner of an element of the part; `element` was one.
bool FaultCount::in_part(int32_t v, int32_t element) const {
  const auto at_it = [&](int32_t t) { return r_.mesh.element[t].alive() && r_.mesh.element[t].find(v) >= 0; };
  return r_.mesh.incident[v] >= 0 && (at_it(element) || std::any_of(slots_.begin(), slots_.end(), at_it));
}

// A point or triangle changes where one of its elements is written.
void FaultCount::find_misfits() {
  const bool some = r_.log.since(seen_, written_);
  seen_ = r_.log.now();
  if (some && written_.empty())
    return;
  if (!some) {
    off_.clear();
    bent_.clear();
  }
  std::erase_if(bent_, [&](int64_t face) {
    return std::binary_search(written_.begin(), written_.end(), static_cast<int32_t>(face / 4));
  });
  surface_points_.clear();
  std::vector<PointOff> met;
  for (const int32_t t : some ? written_ : slots_) {
    if (t < 0 || !r_.mesh.element[t].alive())
      continue;
    const Element& e = r_.mesh.element[t];
    for (size_t f = 0; f < 4; ++f) {
      if (is_bent(r_, accept_, t, f))
        bent_.push_back(4 * int64_t{t} + int64_t(f));
      if (follows_target(r_.mesh.vertex[e.v[f]].kind) && surface_points_(e.v[f]) == met.size())
        met.push_back({e.v[f], t});
    }
  }
  std::erase_if(off_, [&](const PointOff& p) {
    return surface_points_.knows(p.v) || !in_part(p.v, p.element) || !(off(r_, p.v) > 1);
  });
  for (const PointOff& p : met)
    if (off(r_, p.v) > 1)
      off_.push_back(p);
  std::sort(off_.begin(), off_.end(), [](const PointOff& a, const PointOff& b) { return a.v < b.v; });
}

std::vector<int32_t> FaultCount::points_off() {
  find_misfits();
  std::vector<int32_t> off;
  for (const PointOff& p : off_)
    off.push_back(p.v);
  return off;
}

void FaultCount::count_bad(Faults& f) {
  const std::vector<int32_t>& low = low_();
  f.below = static_cast<int64_t>(low.size());
  for (const int32_t t : low)
    f.worst = std::min(f.worst, r_.mesh.element[t].q);
}

void FaultCount::count_misfits(Faults& f) {
  find_misfits();
  f.off = static_cast<int64_t>(off_.size());
  f.bent = static_cast<int64_t>(bent_.size());
}

Faults FaultCount::operator()() {
  Faults f;
  count_bad(f);
  count_misfits(f);
  return f;
}

bool FaultCount::better_than(const Faults& before, int64_t bent_for_a_point) {
  Faults now;
  count_bad(now);
  if (now.below > before.below || (now.below > 0 && now.worst < before.worst))
    return false;
  count_misfits(now);
  return now.fewer_than(before, bent_for_a_point);
}

} // namespace molmesh::optimize
