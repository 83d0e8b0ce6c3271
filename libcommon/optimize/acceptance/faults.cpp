// faults.cpp — a part's bad elements, bent triangles and points off the target, kept up to date.
#include "optimize/acceptance/faults.hpp"
#include <algorithm>

namespace molmesh::optimize {

// Whether v is a corner of an element of the part; `element` was one.
bool FaultCount::in_part(int32_t v, int32_t element) const {
  const auto at_it = [&](int32_t t) { return m_.element[t].alive() && m_.element[t].find(v) >= 0; };
  return m_.incident[v] >= 0 && (at_it(element) || std::any_of(slots_.begin(), slots_.end(), at_it));
}

// A point or triangle changes where one of its elements is written.
void FaultCount::find_misfits() {
  const bool some = editor_.log.since(seen_, written_);
  seen_ = editor_.log.now();
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
    if (t < 0 || !m_.element[t].alive())
      continue;
    const Element& e = m_.element[t];
    for (size_t f = 0; f < 4; ++f) {
      if (editor_.bent(t, f))
        bent_.push_back(4 * int64_t{t} + int64_t(f));
      if (follows_target(m_.vertex[e.v[f]].kind) && surface_points_(e.v[f]) == met.size())
        met.push_back({e.v[f], t});
    }
  }
  std::erase_if(off_, [&](const PointOff& p) {
    return surface_points_.knows(p.v) || !in_part(p.v, p.element) || !(editor_.off(p.v) > 1);
  });
  for (const PointOff& p : met)
    if (editor_.off(p.v) > 1)
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
    f.worst = std::min(f.worst, m_.element[t].q);
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
