// coarsening.cpp — vertices go, part by part, until edges are as long as sizes want them.
#include "optimize/mesh/target_size.hpp"
#include "optimize/operations/vertex_removal.hpp"
#include "optimize/schedule/schedule.hpp"
#include "par/choose.hpp"
#include "par/par.hpp"

namespace molmesh::optimize {

Counts Schedule::coarsen(const Pass& pass, const std::vector<float>& size) {
  constexpr int32_t sweeps = 3;
  const int32_t start = time_;
  time_ += sweeps;
  set_parts(passes_++, pass.cell * cell_);
  const auto may_go = [&](int64_t v) {
    const Vertex& vertex = m_.vertex[v];
    return vertex.kind != Kind::fixed && (!follows_target(vertex.kind) ||
                                          (may_coarsen(m_, target_, vertex.label) &&
                                           (vertex.kind != Kind::line || may_coarsen(m_, target_, vertex.second))));
  };
  const std::vector<int32_t> items = par::choose(static_cast<int64_t>(size.size()), threads_,
                                                 [&](int64_t v) { return m_.incident[v] >= 0 && may_go(v); });
  std::vector<int32_t> part;
  for (const int32_t v : items)
    part.push_back(parts_.owner[v]);
  Acceptance accept(pass.guard);
  accept.goal = pass.goal;
  accept.aim = Aim::size;
  return for_parts(items, part,
                   [&](Region& r, std::vector<int32_t>& list) {
                     VertexRemoval remove(r, accept, size);
                     for (int32_t sweep = 1; sweep <= sweeps && !list.empty(); ++sweep) {
                       r.time = start + sweep;
                       r.changed.clear();
                       for (const int32_t v : list)
                         if (m_.incident[v] >= 0 && may_go(v))
                           remove(v);
                       list.clear();
                       for (const int32_t t : r.changed)
                         if (m_.element[t].alive())
                           for (const int32_t v : m_.element[t].v)
                             list.push_back(v);
                       par::sort_unique(list, 1);
                     }
                   },
                   {.slots_per_item = 0, .slots = 0}); // nothing new comes
}

} // namespace molmesh::optimize
