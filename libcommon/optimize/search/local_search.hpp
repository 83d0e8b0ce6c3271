// local_search.hpp — trials on a part that make it worse at first: an operation, repair around it, keep or restore.
#pragma once
#include "optimize/acceptance/faults.hpp"
#include "optimize/operations/on_element.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

/// How far a trial may go.
struct Leeway {
  float floor;            ///< share of the goal: what the first step may leave for repair
  bool off_target;        ///< Acceptance::off_target, during repair
  int64_t bent_for_point; ///< triangles that may be bent for a point that comes back
  bool fits_after;        ///< bent triangles are made to fit once more, when elements are repaired
  bool may_bend;          ///< Acceptance::may_bend, during repair
};

/// Works on the elements in `slots`, all that elements of the part may be in.
class LocalSearch {
public:
  /// accept: guard and goal, and worst_first as Strategy has it.
  LocalSearch(Region& r, const std::vector<int32_t>& slots, const Acceptance& accept, const Leeway& how_far)
      : faults(r, slots, accept), leeway(how_far), r_(r), slots_(slots), accept_(accept),
        below_goal_(faults.low_elements(), accept.goal) {}

  FaultCount faults;
  Leeway leeway;

  /// Of the operation that a trial begins with: it may flatten elements down to the floor and bend the surface. The
  /// deficit is that of the second round of repair, with which most repairs end.
  Acceptance first_step() const;
  /// What has changed since Region::changed was cleared is made to fit the target, elements down to the floor.
  void fit_changed();
  void repair(int rounds = 6); ///< elements are brought over the goal
  /// Bent triangles are made to fit where no element falls under the goal.
  void fit_bent();
  /// First improvement: operations are tried on the worst elements and those next to them, each with repair after.
  /// What lowers the cost stays, where no more points are off and no more triangles bent than `before` allows; all
  /// else is put back. trials: how many more, counted down.
  void climb(const Faults& before, int& trials);
  /// Threshold accepting: any of these operations, and what raises the cost by a little stays too, less and less
  /// the fewer trials are left. Where it ends may be worse than where it began.
  void walk(const Faults& before, int& trials);

  std::vector<int32_t> elements() const; ///< those alive
  /// 0 where no element is far enough below the goal to count as a fault; more for every one, and for worse ones.
  double cost();
  bool is_better(const Faults& before) { return faults.better_than(before, leeway.bent_for_point); }

private:
  std::vector<int32_t> below(float goal, const std::vector<int32_t>& of) const; ///< of elements, in their order
  std::vector<int32_t> bad();                                                   ///< in the order of the slots
  std::vector<int32_t> worst();
  void fit_listed(const Acceptance& accept);
  static constexpr int operations = 34;
  struct Trial {
    int32_t element;
    int operation; ///< 0 … operations - 1
  };
  bool operate(const Trial& trial);
  void repair_after();
  class Checkpoint;
  struct Limit;
  enum class Outcome : uint8_t { idle, worse, better };
  Outcome attempt(const Trial& trial, Limit& limit);

  Region& r_;
  const std::vector<int32_t>& slots_;
  const Acceptance accept_;
  LowElements below_goal_;
};

} // namespace molmesh::optimize
