// vain.hpp — points off the target that a recovery could do nothing for, and when.
#pragma once
#include "optimize/schedule/pass.hpp"
#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace molmesh::optimize {

class Vain {
public:
  /// Forgets all when it was for another goal, guard or size of parts.
  void begin(const Pass& pass);
  /// Of the points off in a part, ascending, `touched` being when anything there last changed: whether a pass of
  /// that order and effort has failed since. Of the efforts above 1, 3 does all that 2 does first.
  bool knows(const std::vector<int32_t>& points, const Pass& pass, int32_t touched) const;
  void note(const std::vector<int32_t>& points, const Pass& pass, int32_t time);

private:
  static constexpr int efforts = 6;
  using Times = std::array<std::array<int32_t, efforts>, 2>; ///< 0: never

  Pass of_;
  std::map<std::vector<int32_t>, Times> when_;
};

} // namespace molmesh::optimize
