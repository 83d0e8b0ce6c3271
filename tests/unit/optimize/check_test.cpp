// check_test.cpp — operations leave a region without a fault, and what is broken is found.
#include "isosurface/isosurface.hpp"
#include "lattice_mesh.hpp"
#include "optimize/operations/check.hpp"
#include "optimize/operations/on_element.hpp"
#include "recovery_pass.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

TEST_CASE("a region has no fault after each operation, and one where something is broken") {
  constexpr double h = 0.5;
  constexpr int n = 14;
  const Field ball = [](Vec3d p) { return std::exp(-0.3 * (norm2(p - Vec3d{3.3, 3.4, 3.5}) - 3)); };
  const Isosurface surface(lattice_grid(ball, {0, 0, 0}, h, n), 1);
  optimize::DynamicMesh m = optimize::build(lattice_mesh(ball, {0, 0, 0}, h, n), 180, 1);
  const size_t elements = m.element.size(), vertices = m.point.size();
  m.resize(elements + 100, vertices + 100);
  optimize::Parts parts; // one half of the mesh
  parts.owner.resize(m.point.size(), 0);
  for (size_t v = 0; v < vertices; ++v)
    parts.owner[v] = m.point[v].x < 3.4 ? 0 : -1;
  optimize::PartRoom room;
  for (size_t k = 0; k < 100; ++k) {
    room.element.push_back(static_cast<int32_t>(elements + k));
    room.vertex.push_back(static_cast<int32_t>(vertices + k));
  }
  std::vector<uint32_t> stamp(m.element.size());
  optimize::Region region(m, &surface, nullptr, parts, stamp, room);
  CHECK(optimize::find_fault(region).empty());
  optimize::Acceptance accept(recovery_guard);
  accept.goal = static_cast<float>(angle_quality(26));
  for (int32_t t = 0; t < static_cast<int32_t>(elements) && region.counts.total() < 60; ++t)
    if (m.element[t].alive() && m.element[t].q < accept.goal && region.owned(t) &&
        optimize::improve_element(region, accept, t, true))
      REQUIRE(optimize::find_fault(region).empty());
  CHECK(region.counts.total() >= 60);
  const TetMesh part = optimize::as_mesh(region);
  size_t owned = 0;
  int32_t last = -1;
  for (int32_t t = 0; t < static_cast<int32_t>(m.element.size()); ++t)
    if (m.element[t].alive() && region.owned(t))
      ++owned, last = t;
  CHECK(part.tet.size() == owned);
  CHECK(owned < elements);
  CHECK(part.tri.size() > 0);
  const auto breaks = [&](auto&& change) {
    const optimize::Element before = m.element[last];
    change(m.element[last]);
    CHECK_FALSE(optimize::find_fault(region).empty());
    m.element[last] = before;
  };
  breaks([](optimize::Element& e) { e.q += 0.1f; });
  breaks([](optimize::Element& e) { std::swap(e.v[0], e.v[1]); });
  breaks([](optimize::Element& e) { std::swap(e.n[0], e.n[1]); });
  breaks([](optimize::Element& e) { e.label[0] = e.label[0] == 0; });
  CHECK(optimize::find_fault(region).empty());
}
