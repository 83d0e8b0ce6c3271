// extract.cpp — back to a plain mesh: what is alive, in slot order.
#include "optimize/mesh/dynamic_mesh.hpp"
#include "par/pages.hpp"
#include <algorithm>

namespace molmesh::optimize {
namespace {

void number_neighbors(const DynamicMesh& m, const LargeArray<int32_t>& alive, int threads,
                      LargeArray<int32_t>& across) {
  const auto tets = static_cast<int64_t>(alive.size());
  LargeArray<int32_t> id;
  par::resize_pages(id, m.element.size(), threads);
  par::for_n(tets, threads, [&](int64_t t) { id[alive[t]] = static_cast<int32_t>(t); });
  par::resize_pages(across, 4 * alive.size(), threads);
  par::for_n(tets, threads, [&](int64_t t) {
    for (size_t f = 0; f < 4; ++f) {
      const int32_t n = m.element[alive[t]].n[f];
      across[4 * size_t(t) + f] = n < 0 ? -1 : id[n];
    }
  });
}

// 4 element + face, ascending: what has a triangle.
std::vector<int64_t> labelled_faces(const DynamicMesh& m, int threads) {
  std::vector<std::vector<int64_t>> part(m.labelled.size());
  par::for_n(static_cast<int64_t>(part.size()), threads, 16, [&](int64_t s) {
    if (m.labelled[s])
      m.for_chunk(s, [&](int64_t t) {
        const Element& e = m.element[t];
        for (int64_t f = 0; f < 4 && e.alive(); ++f)
          if (m.counts_here(e, size_t(f)))
            part[s].push_back(4 * t + f);
      });
  });
  std::vector<int64_t> all;
  for (const auto& p : part)
    all.insert(all.end(), p.begin(), p.end());
  return all;
}

} // namespace

TetMesh extract(const DynamicMesh& m, int threads, LargeArray<int32_t>* across, TetMesh out) {
  out.part.clear();
  out.cell_array.clear();
  out.named_text.clear();
  const auto slots = static_cast<int64_t>(m.element.size());
  const auto used =
      par::select(static_cast<int64_t>(m.point.size()), threads, [&](int64_t v) { return m.incident[v] >= 0; });
  LargeArray<int32_t> id;
  par::resize_pages(id, m.point.size(), threads);
  par::resize_pages(out.point, used.size(), threads);
  par::for_n(static_cast<int64_t>(used.size()), threads, [&](int64_t k) {
    const auto v = size_t(used[k]);
    id[v] = static_cast<int32_t>(k);
    out.point[k] = m.point[v];
  });
  const auto alive = par::select(slots, threads, [&](int64_t e) { return m.element[e].alive(); });
  par::resize_pages(out.tet, alive.size(), threads);
  par::resize_pages(out.region, alive.size(), threads);
  par::for_n(static_cast<int64_t>(alive.size()), threads, [&](int64_t t) {
    const Element& e = m.element[alive[t]];
    for (size_t i = 0; i < 4; ++i)
      out.tet[t][i] = id[e.v[i]];
    out.region[t] = e.region;
  });
  if (across)
    number_neighbors(m, alive, threads, *across);
  const auto faces = labelled_faces(m, threads);
  par::resize_pages(out.tri, faces.size(), threads);
  par::resize_pages(out.boundary, faces.size(), threads);
  par::for_n(static_cast<int64_t>(faces.size()), threads, [&](int64_t t) {
    const Element& e = m.element[faces[t] / 4];
    const size_t face = size_t(faces[t] % 4);
    Tri v = outward_triangle(e.v, face);
    const Label& label = m.labels[e.label[face]];
    if (label.reversed)
      std::swap(v[1], v[2]);
    for (size_t i = 0; i < 3; ++i)
      out.tri[t][i] = id[v[i]];
    out.boundary[t] = label.name;
  });
  return out;
}

} // namespace molmesh::optimize
