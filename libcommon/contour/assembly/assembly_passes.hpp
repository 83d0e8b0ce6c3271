// assembly_passes.hpp — the mesh of the wanted regions, pass by pass, over a launcher.
#pragma once
#include "contour/assembly/assembly_items.hpp"
#include "contour/options.hpp"
#include "par/passes.hpp"

namespace molmesh::contour {

inline Wanted wanted(Options::Meshed meshed) {
  return {meshed == Options::interior   ? uint8_t{1 << molecule}
          : meshed == Options::exterior ? uint8_t{1 << outside}
                                        : uint8_t{1 << molecule | 1 << outside | 1 << cavity}};
}

/// Numbers points in the order of their first use; returns the numbers.
template <par::Launcher Launcher, class Mesh>
auto number_points(Launcher& m, const Tet* tet, int64_t tets, const ElementsView& e, Mesh& mesh) {
  auto first = m.filled(e.positions, ~uint32_t{0});
  m.for_n("first elements", tets, FirstElements{tet, first.data()}, {double(tets) * 16 + double(e.positions) * 4});
  const auto used = par::gather<int32_t>(m, "first uses", tets, FirstUses{tet, first.data()});
  first = {};
  auto number = m.template array<int32_t>(e.positions);
  m.for_n("number points", used.n, NumberPoints{used.data(), e.position, number.data(), mesh.points(used.n)},
          {double(used.n) * 56});
  return number;
}

/// Mesh: makes room and says where: tets(n), regions(n), points(n), tris(n), boundaries(n); it may have a faster
/// number_points(tet, tets, elements), and a renumber_tets(renumber) that calls renumber(begin, end) run by run.
template <par::Launcher Launcher, class Mesh>
void assemble(Launcher& m, const ElementsView& e, const uint8_t* region, int64_t complex_vertices, Wanted wanted,
              Mesh& mesh) {
  Tet* tet = nullptr;
  int64_t tets = 0;
  par::place_by(m, "order elements", e.tets, complex_vertices, TetKey{e.tet, region, wanted}, [&](int64_t slots) {
    tets = slots;
    tet = mesh.tets(slots);
    return PlaceTets{e.tet, region, tet, mesh.regions(slots)};
  });
  const auto number = [&] {
    if constexpr (requires { mesh.number_points(tet, tets, e); })
      return mesh.number_points(tet, tets, e);
    else
      return number_points(m, tet, tets, e, mesh);
  }();
  const auto renumber = [&](int64_t begin, int64_t end) {
    m.for_n("renumber", end - begin, Renumber{number.data(), tet + begin}, {double(end - begin) * 36});
  };
  if constexpr (requires { mesh.renumber_tets(renumber); })
    mesh.renumber_tets(renumber);
  else
    renumber(0, tets);
  const auto kept = par::gather<int64_t>(m, "triangles", e.tris, GatherTriangles{e, region, wanted});
  m.for_n("place triangles", kept.n,
          PlaceTriangles{e, kept.data(), number.data(), mesh.tris(kept.n), mesh.boundaries(kept.n)},
          {double(kept.n) * 40});
}

} // namespace molmesh::contour
