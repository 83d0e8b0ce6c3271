// wander.cpp — a walk among operations that may leave a part a little worse, out of where shaking ends.
#include "optimize/search/mend.hpp"

namespace molmesh::optimize {

void Mending::wander(FaultCount& faults, const Faults& before, int64_t bent_for_a_point, int& trials) {
  constexpr double first_rise = 0.15; // of the deficit, in one step
  constexpr int idle_for_a_trial = 20;
  uint64_t state = 1; // the same walk every time
  const auto random = [&](size_t n) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<size_t>((state >> 33) % n);
  };
  const int64_t off = faults().off;
  const int all = trials;
  double current = deficit();
  Snapshot here = editor_.save(elements());
  std::vector<int32_t> list = worst();
  for (int idle = idle_for_a_trial * trials; current > 0 && trials > 0 && idle > 0 && !list.empty();) {
    const int32_t t = list[random(list.size())];
    if (!operate(t, static_cast<int>(random(operations)))) {
      --idle;
      continue;
    }
    const double rise = first_rise * trials-- / all;
    set_out();
    flatten();
    mend(2);
    const double now = deficit();
    const Faults f = faults();
    if (now > (1 + rise) * current || f.off > off || !f.fewer_than(before, bent_for_a_point)) {
      editor_.restore(here);
      continue;
    }
    current = now;
    here = editor_.save(elements());
    list = worst();
  }
}

} // namespace molmesh::optimize
