// extract.cpp — back to a plain mesh: what is alive, in slot order.
#include "improve/dynamic_mesh.hpp"
#include "mesh/adjacency.hpp" // how neighbours are numbered
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::improve {
namespace {

void number_neighbors(const DynamicMesh& m, const LargeArray<int32_t>& alive, int threads,
                      std::vector<int32_t>& across) {
  const auto tets = static_cast<int64_t>(alive.size());
  std::vector<int32_t> id(m.element.size(), -1);
  par::for_n(tets, threads, [&](int64_t t) { id[size_t(alive[size_t(t)])] = static_cast<int32_t>(t); });
  across.assign(4 * alive.size(), no_face);
  par::for_n(tets, threads, [&](int64_t t) {
    const int32_t slot = alive[size_t(t)];
    for (size_t f = 0; f < 4; ++f)
      if (const int32_t n = m.element[size_t(slot)].n[f]; n >= 0) {
        const auto& back = m.element[size_t(n)].n;
        across[4 * size_t(t) + f] =
            4 * id[size_t(n)] + static_cast<int32_t>(std::find(back.begin(), back.end(), slot) - back.begin());
      }
  });
}

} // namespace

TetMesh extract(const DynamicMesh& m, int threads, std::vector<int32_t>* across) {
  TetMesh out;
  const auto slots = static_cast<int64_t>(m.element.size());
  std::vector<int32_t> id(m.point.size(), -1);
  for (size_t v = 0; v < m.point.size(); ++v)
    if (m.incident[v] >= 0)
      id[v] = static_cast<int32_t>(out.point.size()), out.point.push_back(m.point[v]);
  const auto alive = par::select(slots, threads, [&](int64_t e) { return m.element[size_t(e)].alive(); });
  out.tet.resize(alive.size());
  out.region.resize(alive.size());
  par::for_n(static_cast<int64_t>(alive.size()), threads, [&](int64_t t) {
    const Element& e = m.element[size_t(alive[size_t(t)])];
    for (size_t i = 0; i < 4; ++i)
      out.tet[size_t(t)][i] = id[size_t(e.v[i])];
    out.region[size_t(t)] = e.region;
  });
  if (across)
    number_neighbors(m, alive, threads, *across);
  const auto faces = par::select<int64_t>(4 * slots, threads, [&](int64_t f) {
    const Element& e = m.element[size_t(f / 4)];
    return e.alive() && m.counts_here(e, size_t(f % 4));
  });
  out.tri.resize(faces.size());
  out.boundary.resize(faces.size());
  par::for_n(static_cast<int64_t>(faces.size()), threads, [&](int64_t t) {
    const Element& e = m.element[size_t(faces[size_t(t)] / 4)];
    const size_t face = size_t(faces[size_t(t)] % 4);
    Tri v = outward_triangle(e.v, face);
    const Label& label = m.labels[e.label[face]];
    if (label.reversed)
      std::swap(v[1], v[2]);
    for (size_t i = 0; i < 3; ++i)
      out.tri[size_t(t)][i] = id[size_t(v[i])];
    out.boundary[size_t(t)] = label.name;
  });
  return out;
}

} // namespace molmesh::improve
