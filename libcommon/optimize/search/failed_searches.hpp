// failed_searches.hpp — points off the target that a search could do nothing for, and when.
#pragma once
#include "optimize/search/strategy.hpp"
#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace molmesh::optimize {

/// Unlike FailedAttempts this asks whether anything has changed since, not whether all is as it was: the parts of
/// two passes lie differently around the same points, so the states of their vertices are never the same twice.
class FailedSearches {
public:
  /// Forgets all when it was for another scope, goal, guard or size of parts.
  void begin(const Strategy& s) {
    if (s.scope != of_.scope || s.goal != of_.goal || s.goal_share != of_.goal_share ||
        s.part_size != of_.part_size || !(s.guard == of_.guard))
      when_.clear();
    of_ = s;
  }
  /// Of the points off in a part, ascending, `touched` being when anything there last changed: whether this
  /// strategy has failed since.
  bool knows(const std::vector<int32_t>& points, const Strategy& s, int32_t touched) const {
    const auto at = when_.find(points);
    return at != when_.end() && std::any_of(at->second.begin(), at->second.end(), [&](const auto& tried) {
             return touched < tried.second && tried.first == s;
           });
  }
  void note(const std::vector<int32_t>& points, const Strategy& s, int32_t time) {
    when_[points].emplace_back(s, time);
  }

private:
  Strategy of_;
  std::map<std::vector<int32_t>, std::vector<std::pair<Strategy, int32_t>>> when_;
};

} // namespace molmesh::optimize
