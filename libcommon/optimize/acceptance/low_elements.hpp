// low_elements.hpp — the elements of a part below a goal, as operations go on.
#pragma once
#include "optimize/mesh/change_log.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include <cstdint>
#include <utility>
#include <vector>

namespace molmesh::optimize {

class LowElements {
public:
  /// slots: all that elements of the part may be in. log: of its editor, kept.
  LowElements(const DynamicMesh& m, const std::vector<int32_t>& slots, const ChangeLog& log, float goal);
  /// In the order of the slots.
  const std::vector<int32_t>& operator()();

private:
  size_t place(int32_t element) const; ///< among the slots

  const DynamicMesh& m_;
  const std::vector<int32_t>& slots_;
  const ChangeLog& log_;
  const float goal_;
  size_t ascending_ = 0; ///< so many slots, from the first on
  ChangeLog::Moment seen_;
  std::vector<std::pair<size_t, int32_t>> by_place_;
  std::vector<int32_t> low_, written_;
};

} // namespace molmesh::optimize
