// mend.hpp — a part after a trial: its triangles made to fit, its elements brought over the goal.
#pragma once
#include "optimize/acceptance/faults.hpp"
#include "optimize/acceptance/low_elements.hpp"
#include "optimize/schedule/schedule.hpp"
#include "par/helpers.hpp"
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

/// Works on the elements in `slots`, all that elements of the part may be in.
class Mending {
public:
  /// helpers: threads for shake(), or null.
  Mending(Editor& editor, DynamicMesh& m, const std::vector<int32_t>& slots, const Pass& pass,
          par::Helpers* helpers)
      : editor_(editor), m_(m), slots_(slots), pass_(pass), helpers_(helpers),
        below_goal_(m, slots, editor.log, pass.goal) {
    editor.log.keep();
  }

  float floor = 0.01f; ///< share of the goal: what an operation that sets out may leave for the mending
  bool loose = false;  ///< Editor::loose, while mending
  bool bend = false;   ///< Editor::bold, while mending

  /// From now on operations may flatten elements down to the floor.
  void set_out();
  /// What has changed since is made to fit the target.
  void flatten();
  /// Given up where deficit() is over `hopeless` after the first round, over half of it after the second, and so
  /// on.
  void mend(int rounds = 6, double hopeless = 1e30);
  /// Bent triangles are made to fit where no element falls under the goal.
  void straighten();
  /// Of what mending has left below the goal: operations that set out are tried on the worst elements and those
  /// next to them, each with mending after. What lowers the deficit stays, where no more points are off and no more
  /// triangles bent than `before` allows; all else is put back. trials: how many more, counted down.
  void shake(FaultCount& faults, const Faults& before, int64_t bent_for_a_point, int& trials);
  /// As shake(), but any of these operations, and what raises the deficit by a little stays too, less and less the
  /// fewer trials are left (threshold accepting). Where it ends may be worse than where it began.
  void wander(FaultCount& faults, const Faults& before, int64_t bent_for_a_point, int& trials);

  std::vector<int32_t> elements() const;
  /// 0 where no element is far enough below the goal to count as a fault; more for every one, and for worse ones.
  double deficit();

private:
  std::vector<int32_t> below(float goal, const std::vector<int32_t>& of) const; ///< of elements, in their order
  std::vector<int32_t> bad();                                                   ///< in the order of the slots
  std::vector<int32_t> worst();
  static constexpr int operations = 34;
  bool operate(int32_t t, int k); ///< k: 0 … operations - 1
  struct Trial;
  struct Aim;
  enum class Outcome : uint8_t { none, idle, worse, better };
  Outcome attempt(const Trial& trial, FaultCount& faults, Aim& aim);
  bool follows_mending() const;
  size_t first_telling(const std::vector<Trial>& all, size_t from, FaultCount& faults, const Aim& aim,
                       const Snapshot& here, int& trials);

  Editor& editor_;
  DynamicMesh& m_;
  const std::vector<int32_t>& slots_;
  const Pass& pass_;
  par::Helpers* helpers_;
  LowElements below_goal_;
};

} // namespace molmesh::optimize
