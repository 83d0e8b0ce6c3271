// chunks_test.cpp — what is known of chunks of elements holds after every kind of pass.
#include "isosurface/isosurface.hpp"
#include "lattice_mesh.hpp"
#include "recovery_pass.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <numeric>

using namespace molmesh;
using namespace molmesh::test;

namespace {

struct Seen {
  int64_t labelled = 0, bare = 0; ///< elements with a label; chunks said to have none
};

// Chunks hold what they say.
Seen check(const optimize::DynamicMesh& m) {
  REQUIRE(m.labelled.size() == size_t(optimize::DynamicMesh::chunks(m.element.size())));
  Seen seen;
  for (size_t s = 0; s < m.labelled.size(); ++s) {
    float worst = 2;
    bool label = false;
    m.for_chunk(int64_t(s), [&](int64_t t) {
      const optimize::Element& e = m.element[t];
      if (!e.alive())
        return;
      worst = std::min(worst, e.q);
      const bool any = e.label != std::array<uint8_t, 4>{};
      label |= any;
      seen.labelled += any;
    });
    CHECK((m.dirty[s] || m.worst[s] == worst));
    CHECK((m.labelled[s] || !label));
    seen.bare += !m.labelled[s];
  }
  return seen;
}

// Elements with labels last: there are chunks without, next to them in space.
TetMesh labelled_last(const TetMesh& mesh) {
  const optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  std::vector<size_t> order(mesh.tet.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_partition(order.begin(), order.end(),
                        [&](size_t t) { return m.element[t].label == std::array<uint8_t, 4>{}; });
  TetMesh out = mesh;
  for (size_t t = 0; t < order.size(); ++t) {
    out.tet[t] = mesh.tet[order[t]];
    out.region[t] = mesh.region[order[t]];
  }
  return out;
}

/// By a map of all faces.
LargeArray<int32_t> neighbors(const TetMesh& m) {
  std::map<std::array<int32_t, 3>, std::vector<size_t>> at;
  LargeArray<int32_t> across(4 * m.tet.size());
  for (size_t f = 0; f < across.size(); ++f) {
    std::array<int32_t, 3> face = optimize::outward_triangle(m.tet[f / 4], f % 4);
    std::sort(face.begin(), face.end());
    at[face].push_back(f);
  }
  for (const auto& [face, sides] : at)
    for (size_t i = 0; i < sides.size(); ++i)
      across[sides[i]] = sides.size() == 2 ? static_cast<int32_t>(sides[1 - i] / 4) : -1;
  return across;
}

} // namespace

TEST_CASE("chunks of elements know of their labels and their worst", "[slow]") {
  constexpr double h = 0.5;
  const BlockGrid grid = lattice_grid(three_atoms, {0, 0, 0}, h, 24);
  const TetMesh mesh = labelled_last(lattice_mesh(three_atoms, {0, 0, 0}, h, 24, GENERATE(0, 1, 2)));
  optimize::DynamicMesh m = optimize::build(mesh, 180, 2);
  const Isosurface surface(grid, 1);
  optimize::Schedule schedule(m, &surface, 32 * h, 2);
  const int64_t bare = check(m).bare;
  CHECK(bare > 0);
  const optimize::Pass pass = recovery_pass(0.5);
  CHECK(schedule.project(1, pass.guard).total() > 0);
  check(m);
  CHECK(schedule.run(pass).total() > 0);
  check(m);
  optimize::Pass straight = pass;
  straight.goal *= 0.01f;
  straight.guard = {20, 0.1, 0.5, 0};
  CHECK(schedule.fit_surface(straight).total() > 0);
  check(m);
  schedule.search(recovery(0.5));
  CHECK(schedule.worst() > 0);
  const Seen seen = check(m);
  CHECK(seen.labelled > 0);
  CHECK(seen.bare < bare); // some have come to hold labels
  const bool any_free =
      std::any_of(m.element.begin(), m.element.end(), [](const optimize::Element& e) { return !e.alive(); });
  CHECK(any_free);
  const TetMesh plain = optimize::extract(m);
  LargeArray<int32_t> across;
  const TetMesh out = optimize::extract(std::move(m), 2, across, {});
  CHECK((out.tet == plain.tet));
  CHECK((across == neighbors(out)));
}

TEST_CASE("extraction takes memory that is lent, and nothing of what was in it") {
  constexpr double h = 0.5;
  const TetMesh mesh = lattice_mesh(three_atoms, {0, 0, 0}, h, 12);
  optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  const TetMesh fresh = optimize::extract(m);
  TetMesh lent = mesh;
  const bool large = GENERATE(false, true);
  lent.tet = LargeArray<Tet>(large ? 2 * mesh.tet.size() : 1);
  lent.region = std::vector<int32_t>(lent.tet.size(), 7);
  lent.point = std::vector<Vec3d>(large ? 2 * mesh.point.size() : 1);
  lent.tri.clear();
  lent.part.assign(5, 1);
  lent.cell_array.push_back({"chain", {1}, {}});
  lent.source = "source";
  const Tet* const memory = lent.tet.data();
  LargeArray<int32_t> across;
  const TetMesh out = optimize::extract(std::move(m), 2, across, std::move(lent));
  CHECK((across == neighbors(out)));
  CHECK((out.tet.data() == memory) == large);
  CHECK((out.tet == fresh.tet));
  CHECK((out.region == fresh.region));
  CHECK((out.tri == fresh.tri));
  CHECK((out.boundary == fresh.boundary));
  CHECK(out.point.size() == fresh.point.size());
  CHECK(out.part.empty());
  CHECK(out.cell_array.empty());
  CHECK(out.source == "source");
}
