// vain.cpp — times by points, order and effort.
#include "optimize/search/vain.hpp"
#include <algorithm>

namespace molmesh::optimize {

void Vain::begin(const Pass& pass) {
  Pass of = pass;
  of.effort = 0;
  of.worst_first = true;
  if (of != of_)
    when_.clear();
  of_ = of;
}

bool Vain::knows(const std::vector<int32_t>& points, const Pass& pass, int32_t touched) const {
  const auto at = when_.find(points);
  if (at == when_.end() || pass.effort >= efforts)
    return false;
  const auto& time = at->second[pass.worst_first];
  return touched < std::max(time[pass.effort], pass.effort == 2 ? time[3] : 0);
}

void Vain::note(const std::vector<int32_t>& points, const Pass& pass, int32_t time) {
  if (pass.effort < efforts)
    when_[points][pass.worst_first][pass.effort] = time;
}

} // namespace molmesh::optimize
