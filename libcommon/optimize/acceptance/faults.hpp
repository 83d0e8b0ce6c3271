// faults.hpp — what is wrong in a part: points off the target, bent triangles, elements below the goal.
#pragma once
#include "optimize/acceptance/acceptance.hpp"
#include "optimize/operations/region.hpp"
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace molmesh::optimize {

/// Lists the elements of a part below a goal, and keeps the list up to date while operations go on.
class LowElements {
public:
  /// slots: every slot that may hold an element of the part. log: the region's, which must be kept.
  LowElements(const DynamicMesh& m, const std::vector<int32_t>& slots, const ChangeLog& log, float goal);
  /// Of the same part, below another goal.
  LowElements(const LowElements& other, float goal);
  /// The list, in the order of the slots.
  const std::vector<int32_t>& operator()();

private:
  const DynamicMesh& m_;
  const std::vector<int32_t>& slots_;
  const ChangeLog& log_;
  const float goal_;
  /// Slots, ascending, and where in `slots_`: a table of tens of thousands of them would take six times the memory.
  const std::shared_ptr<const std::vector<std::pair<int32_t, int32_t>>> place_;
  ChangeLog::Moment seen_;
  std::vector<std::pair<size_t, int32_t>> by_place_;
  std::vector<int32_t> low_, written_;
};

struct Faults {
  int64_t off = 0, bent = 0, below = 0;
  float worst = 2; ///< quality of those below
  /// Fewer points are off than before, and at most so many more triangles are bent for each point that came back.
  bool fewer_than(const Faults& before, int64_t bent_for_a_point) const {
    return off < before.off && bent <= before.bent + bent_for_a_point * (before.off - off);
  }
};

/// Counts the faults of a part. slots: every slot that may hold an element of it.
class FaultCount {
public:
  static constexpr float share = 0.937f; ///< of the goal: an element below it is a fault (139.99° by default)

  /// accept: its guard and goal say what a fault is. Keeps the region's log, and looks only at what was written.
  FaultCount(Region& r, const std::vector<int32_t>& slots, const Acceptance& accept)
      : r_(r), slots_(slots), accept_(accept), low_(r.mesh, slots, r.log, share * accept.goal) {
    r.log.keep();
  }
  Faults operator()();
  /// Faults::fewer_than holds, no more elements are below the goal, and the worst of these is no worse.
  bool better_than(const Faults& before, int64_t bent_for_a_point);
  std::vector<int32_t> points_off(); ///< ascending
  const LowElements& low_elements() const { return low_; }

private:
  void count_bad(Faults& f);
  void count_misfits(Faults& f);
  void find_misfits();
  bool in_part(int32_t v, int32_t element) const;

  const Region& r_;
  const std::vector<int32_t>& slots_;
  const Acceptance accept_;
  LowElements low_;
  ChangeLog::Moment seen_; ///< by find_misfits()
  std::vector<int32_t> written_;
  SmallNumbers surface_points_;
  struct PointOff {
    int32_t v, element; ///< of the part, at it when this was found
  };
  std::vector<PointOff> off_; ///< ascending
  std::vector<int64_t> bent_; ///< 4 element + face, in no order
};

} // namespace molmesh::optimize
