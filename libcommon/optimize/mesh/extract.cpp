// extract.cpp — back to a plain mesh: what is alive, in slot order.
#include "base/give_back_memory.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include "par/pages.hpp"
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <utility>

namespace molmesh::optimize {
namespace {

/// The mesh's elements are gone then: what they knew of their neighbors takes the place of the first of them while
/// room is made for it, since both and the result at once are the most that a program holds.
void number_neighbors(DynamicMesh& m, const LargeArray<int32_t>& alive, int threads, LargeArray<int32_t>& across) {
  const auto tets = static_cast<int64_t>(alive.size());
  {
    LargeArray<int32_t> id;
    par::resize_pages(id, m.element.size(), threads);
    par::for_n(tets, threads, [&](int64_t t) { id[alive[t]] = static_cast<int32_t>(t); });
    par::for_n(tets, threads, [&](int64_t t) {
      for (int32_t& n : m.element[alive[t]].n)
        n = n < 0 ? -1 : id[n];
    });
  }
  using Four = std::array<int32_t, 4>;
  auto* const packed = reinterpret_cast<std::byte*>(m.element.data());
  for (int64_t t = 0; t < tets; ++t) { // never beyond the element that is read
    const Four n = m.element[alive[t]].n;
    std::memcpy(packed + static_cast<size_t>(t) * sizeof n, &n, sizeof n);
  }
  const size_t bytes = alive.size() * sizeof(Four);
  give_back_pages(packed + bytes, m.element.size() * sizeof(Element) - bytes);
  par::resize_pages(across, 4 * alive.size(), threads);
  if (bytes > 0)
    std::memcpy(across.data(), packed, bytes);
  m.element = {};
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

namespace {

/// alive: is set to the elements that are.
TetMesh extract(const DynamicMesh& m, int threads, TetMesh out, LargeArray<int32_t>& alive) {
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
  alive = par::select(slots, threads, [&](int64_t e) { return m.element[e].alive(); });
  par::resize_pages(out.tet, alive.size(), threads);
  par::resize_pages(out.region, alive.size(), threads);
  par::for_n(static_cast<int64_t>(alive.size()), threads, [&](int64_t t) {
    const Element& e = m.element[alive[t]];
    for (size_t i = 0; i < 4; ++i)
      out.tet[t][i] = id[e.v[i]];
    out.region[t] = e.region;
  });
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

} // namespace

TetMesh extract(const DynamicMesh& mesh, int threads) {
  LargeArray<int32_t> alive;
  return extract(mesh, threads, {}, alive);
}

TetMesh extract(DynamicMesh&& mesh, int threads, LargeArray<int32_t>& across, TetMesh out) {
  LargeArray<int32_t> alive;
  out = extract(mesh, threads, std::move(out), alive);
  number_neighbors(mesh, alive, threads, across);
  return out;
}

} // namespace molmesh::optimize
