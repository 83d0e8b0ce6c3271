// faults.hpp — what is wrong in a part: points off the target, bent triangles, elements below the goal.
#pragma once
#include "optimize/acceptance/low_elements.hpp"
#include "optimize/mesh/vertex_numbers.hpp"
#include "optimize/operations/editor.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

struct Faults {
  int64_t off = 0, bent = 0, below = 0;
  float worst = 2; ///< quality of those below
  /// Fewer points are off than before, and no more triangles bent, or so many at most for a point.
  bool fewer_than(const Faults& before, int64_t bent_for_a_point) const {
    return off < before.off && bent <= before.bent + bent_for_a_point * (before.off - off);
  }
};

/// Counts them. slots: all that elements of the part may be in.
class FaultCount {
public:
  static constexpr float share = 0.937f; ///< of the goal, 139.99°: elements under it are faults

  /// Keeps the editor's log, and by it looks at what has been written alone.
  FaultCount(Editor& editor, const DynamicMesh& m, const std::vector<int32_t>& slots, float goal)
      : editor_(editor), m_(m), slots_(slots), low_(m, slots, editor.log, share * goal) {
    editor.log.keep();
  }
  Faults operator()();
  /// Faults::fewer_than, no more elements are below the goal, and the worst of such is no worse.
  bool better_than(const Faults& before, int64_t bent_for_a_point);
  std::vector<int32_t> points_off(); ///< ascending

private:
  void count_bad(Faults& f);
  void count_misfits(Faults& f);
  void find_misfits();
  bool in_part(int32_t v, int32_t element) const;

  const Editor& editor_;
  const DynamicMesh& m_;
  const std::vector<int32_t>& slots_;
  LowElements low_;
  ChangeLog::Moment seen_; ///< by find_misfits()
  std::vector<int32_t> written_;
  VertexNumbers surface_points_;
  struct PointOff {
    int32_t v, element; ///< of the part, at it when this was found
  };
  std::vector<PointOff> off_; ///< ascending
  std::vector<int64_t> bent_; ///< 4 element + face, in no order
};

} // namespace molmesh::optimize
