// low_elements.cpp — found once among all slots, then among those written.
#include "optimize/acceptance/low_elements.hpp"
#include <algorithm>

namespace molmesh::optimize {

LowElements::LowElements(const DynamicMesh& m, const std::vector<int32_t>& slots, const ChangeLog& log, float goal)
    : m_(m), slots_(slots), log_(log), goal_(goal),
      ascending_(static_cast<size_t>(std::is_sorted_until(slots.begin(), slots.end()) - slots.begin())) {}

size_t LowElements::place(int32_t element) const {
  const auto end = slots_.begin() + static_cast<std::ptrdiff_t>(ascending_);
  const auto at = std::lower_bound(slots_.begin(), end, element);
  return static_cast<size_t>((at != end && *at == element ? at : std::find(end, slots_.end(), element)) -
                             slots_.begin());
}

const std::vector<int32_t>& LowElements::operator()() {
  const auto is_low = [&](int32_t t) { return m_.element[t].alive() && m_.element[t].q < goal_; };
  const bool some = log_.since(seen_, written_);
  seen_ = log_.now();
  if (some && written_.empty())
    return low_;
  if (some) {
    std::erase_if(by_place_,
                  [&](const auto& at) { return std::binary_search(written_.begin(), written_.end(), at.second); });
    for (const int32_t t : written_)
      if (t >= 0 && is_low(t))
        by_place_.emplace_back(place(t), t);
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

} // namespace molmesh::optimize
