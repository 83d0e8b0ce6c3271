// faults.cpp — sums over a part's elements and surface points.
#include "improve/faults.hpp"
#include <algorithm>

namespace molmesh::improve {

std::vector<int32_t> FaultCount::points_off() {
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

void FaultCount::count_bad(Faults& f) const {
  for (const int32_t t : slots_)
    if (const Element& e = m_.element[size_t(t)]; e.alive()) {
      f.worst = std::min(f.worst, e.q);
      f.below += e.q < share * goal_;
    }
}

void FaultCount::count_misfits(Faults& f) {
  f.off = static_cast<int64_t>(points_off().size());
  for (const int32_t t : slots_)
    for (size_t i = 0; i < 4 && m_.element[size_t(t)].alive(); ++i)
      f.bent += editor_.bent(t, i);
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

} // namespace molmesh::improve
