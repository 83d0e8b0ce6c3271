// part_copy_test.cpp — what an operation does to the copy of a part it does to the part.
#include "isosurface/isosurface.hpp"
#include "lattice_mesh.hpp"
#include "optimize/operations/on_element.hpp"
#include "optimize/optimize.hpp"
#include "recovery_pass.hpp"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

namespace {

constexpr double h = 0.5;
constexpr int n = 22;

} // namespace

TEST_CASE("a part and its copy change alike") {
  const BlockGrid grid = lattice_grid(three_atoms, {0, 0, 0}, h, n);
  const TetMesh mesh = lattice_mesh(three_atoms, {0, 0, 0}, h, n);
  Isosurface surface(grid, 1);
  optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  const size_t elements = m.element.size(), vertices = m.point.size();
  m.resize(elements + 200, vertices + 50);
  optimize::Parts parts; // one half of the mesh
  parts.owner.resize(m.point.size(), 0);
  for (size_t v = 0; v < vertices; ++v)
    parts.owner[v] = m.point[v].x < 5 ? 0 : -1;
  optimize::PartRoom room;
  std::vector<int32_t> slots;
  for (size_t t = 0; t < elements; ++t)
    if (parts.owns(0, m.element[t].v))
      slots.push_back(static_cast<int32_t>(t));
  for (size_t k = 0; k < 200; ++k) // not in order
    room.element.push_back(static_cast<int32_t>(elements + 7 * k % 200));
  for (size_t k = 0; k < 50; ++k)
    room.vertex.push_back(static_cast<int32_t>(vertices + 7 * k % 50));
  slots.insert(slots.end(), room.element.begin(), room.element.end());
  std::vector<uint32_t> stamp(m.element.size());
  const optimize::Pass pass = recovery_pass(1);
  optimize::Region region(m, &surface, nullptr, parts, stamp, room);
  REQUIRE(region.is_alone());

  optimize::PartCopy copy = region.copy(slots);
  REQUIRE(copy.slots.size() == slots.size());
  REQUIRE(copy.mesh.element.size() < elements);
  std::vector<uint32_t> stamp_of_copy(copy.mesh.element.size());
  optimize::Region like(region, copy, stamp_of_copy);
  const auto alike = [&] {
    for (size_t k = 0; k < slots.size(); ++k) {
      const optimize::Element &e = m.element[slots[k]], &c = copy.mesh.element[copy.slots[k]];
      if (e.alive() != c.alive() || e.q != c.q || e.label != c.label || e.region != c.region)
        return false;
      for (size_t i = 0; i < 4 && e.alive(); ++i)
        if (m.point[e.v[i]] != copy.mesh.point[c.v[i]] || (e.n[i] < 0 ? -1 : copy.number(e.n[i])) != c.n[i])
          return false;
    }
    return true;
  };
  CHECK(alike());
  optimize::Acceptance accept(pass.guard);
  accept.goal = pass.goal;
  for (size_t k = 0; k < slots.size(); ++k) {
    if (!m.element[slots[k]].alive() || m.element[slots[k]].q >= pass.goal)
      continue;
    const bool done = optimize::improve_element(region, accept, slots[k], true);
    CHECK(optimize::improve_element(like, accept, copy.slots[k], true) == done);
  }
  CHECK(region.counts.moves > 20);
  CHECK(region.counts.splits + region.counts.contractions > 0);
  CHECK(region.counts.edge_removals > 0);
  CHECK(like.counts.total() == region.counts.total());
  CHECK(alike());
  for (size_t t = 0; t < elements; ++t) // what is beyond the part keeps its vertices
    if (!std::binary_search(slots.begin(), slots.end() - 200, static_cast<int32_t>(t)))
      REQUIRE(m.element[t].v == mesh.tet[t]);
}
