// assembly.cpp — count, scan, fill: elements by their first vertex, points by their first use.
#include "contour/assembly.hpp"
#include "contour/detail/at.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::contour {

using detail::at;
namespace {

/// Numbers points in the order of their first use, in tet too; returns the numbers, -1 where there is none. Runs of
/// tetrahedra side by side: a point belongs to the first run that uses it.
LargeArray<int32_t> number_points(LargeArray<Tet>& tet, const LargeArray<Vec3d>& position,
                                  std::vector<Vec3d>& point, int threads) {
  const auto n = static_cast<int64_t>(tet.size()), points = static_cast<int64_t>(position.size());
  const int64_t runs = std::max(1, threads), words = (points + 63) / 64;
  const auto bound = [&](int64_t r) { return n * r / runs; };
  std::vector<LargeArray<uint64_t>> used(at(runs)); // [points] bits; by this run and those before
  par::for_n(runs - 1, threads, 1, [&](int64_t r) {
    used[at(r)].assign(at(words), 0);
    for (int64_t t = bound(r); t < bound(r + 1); ++t)
      for (int32_t v : tet[at(t)])
        used[at(r)][at(v >> 6)] |= uint64_t{1} << (v & 63);
  });
  par::for_n(words, threads, [&](int64_t w) {
    for (int64_t r = 1; r < runs - 1; ++r)
      used[at(r)][at(w)] |= used[at(r - 1)][at(w)];
  });
  LargeArray<int32_t> number(at(points));
  par::for_n(points, threads, [&](int64_t v) { number[at(v)] = -1; });
  std::vector<LargeArray<int32_t>> own(at(runs)); // points of each run, as first used
  par::for_n(runs, threads, 1, [&](int64_t r) {
    const uint64_t* before = r > 0 ? used[at(r - 1)].data() : nullptr;
    for (int64_t t = bound(r); t < bound(r + 1); ++t)
      for (int32_t v : tet[at(t)]) {
        if ((before && before[v >> 6] >> (v & 63) & 1) || number[at(v)] >= 0)
          continue;
        number[at(v)] = static_cast<int32_t>(own[at(r)].size());
        own[at(r)].push_back(v);
      }
  });
  std::vector<int64_t> start;
  for (const auto& list : own)
    start.push_back(static_cast<int64_t>(list.size()));
  point.resize(at(par::exclusive_scan(start)));
  for (int64_t r = 0; r < runs; ++r)
    par::for_n(static_cast<int64_t>(own[at(r)].size()), threads, [&](int64_t i) {
      const int32_t v = own[at(r)][at(i)];
      number[at(v)] = static_cast<int32_t>(start[at(r)] + i);
      point[at(start[at(r)] + i)] = position[at(v)];
    });
  par::for_n(n, threads, [&](int64_t t) {
    for (int32_t& v : tet[at(t)])
      v = number[at(v)];
  });
  return number;
}

} // namespace

TetMesh assemble(const Elements& elements, const Components& parts, Options::Meshed meshed, int threads) {
  const auto wanted = [&](int32_t r) {
    return meshed == Options::both || (meshed == Options::interior ? r == molecule : r == outside);
  };
  LargeArray<uint8_t> region(parts.of_vertex.size()); // of a vertex; 0: a dual vertex
  par::for_n(static_cast<int64_t>(region.size()), threads, [&](int64_t v) {
    const int32_t part = parts.of_vertex[at(v)];
    region[at(v)] = part < 0 ? uint8_t{0} : static_cast<uint8_t>(parts.component[at(part)].region);
  });
  const bool kept[4] = {false, wanted(molecule), wanted(outside), wanted(cavity)};
  TetMesh mesh;
  par::place_by(
      static_cast<int64_t>(elements.tet.size()), static_cast<int64_t>(region.size()), threads,
      [&](int64_t t) {
        const int32_t v = elements.tet[at(t)][0];
        return kept[region[at(v)]] ? v : -1;
      },
      [&](int64_t slots) {
        mesh.tet.resize(at(slots));
        mesh.region.resize(at(slots));
      },
      [&](int64_t slot, int64_t t) {
        mesh.tet[at(slot)] = elements.tet[at(t)];
        mesh.region[at(slot)] = region[at(elements.tet[at(t)][0])];
      });
  const LargeArray<int32_t> number = number_points(mesh.tet, elements.position, mesh.point, threads);
  const LargeArray<int64_t> triangles =
      par::select<int64_t>(static_cast<int64_t>(elements.tri.size()), threads, [&](int64_t i) {
        const auto [behind, front] = elements.tri_sides[at(i)];
        const uint8_t a = region[at(behind)], b = region[at(front)];
        return elements.boundary[at(i)] == surface ? a != b && (kept[a] || kept[b]) : kept[a];
      });
  mesh.tri.resize(triangles.size());
  mesh.boundary.resize(triangles.size());
  par::for_n(static_cast<int64_t>(triangles.size()), threads, [&](int64_t i) {
    const int64_t from = triangles[at(i)];
    for (size_t c = 0; c < 3; ++c)
      mesh.tri[at(i)][c] = number[at(elements.tri[at(from)][c])];
    mesh.boundary[at(i)] = elements.boundary[at(from)];
  });
  return mesh;
}

} // namespace molmesh::contour
