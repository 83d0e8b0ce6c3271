// recover_test.cpp — points that were pushed off the isosurface come back or leave it; what fails leaves no trace.
#include "lattice_mesh.hpp"
#include "optimize/acceptance/faults.hpp"
#include "optimize/operations/operations.hpp"
#include "optimize/optimize.hpp"
#include "optimize/schedule/schedule.hpp"
#include "push_off.hpp"
#include "recovery_pass.hpp"
#include "surface_shape.hpp"
#include <algorithm>
#include <catch2/catch.hpp>

using namespace molmesh;
using namespace molmesh::test;

namespace {

constexpr double h = 0.5;
constexpr int n = 22;

struct Case {
  BlockGrid grid = lattice_grid(three_atoms, {0, 0, 0}, h, n);
  Isosurface surface{grid, 1};
  TetMesh mesh;
  optimize::DynamicMesh m;
  explicit Case(int keep = 0) : mesh(lattice_mesh(three_atoms, {0, 0, 0}, h, n, keep)) {
    optimize::improve(mesh, &grid, {});
    m = optimize::build(mesh, 180, 1);
  }
  std::vector<int32_t> star(int32_t v) const {
    std::vector<int32_t> all;
    for (size_t e = 0; e < m.element.size(); ++e)
      if (m.element[e].find(v) >= 0)
        all.push_back(static_cast<int32_t>(e));
    return all;
  }
};

} // namespace

TEST_CASE("points pushed off the isosurface are recovered, no element is the worse for it") {
  Case c;
  REQUIRE(push_off(c.m, c.surface) > 10);
  const optimize::Fidelity before = optimize::measure_fidelity(c.m, c.surface, 1);
  REQUIRE(before.points_off > 10);
  optimize::Schedule schedule(c.m, &c.surface, 32 * h, 1);
  const optimize::Strategy strategy = recovery(0.5);
  const float worst = schedule.worst();
  const int64_t below = schedule.below(optimize::FaultCount::share * strategy.goal);
  for (int k = 0; k < 4; ++k)
    schedule.search(strategy);
  const optimize::Fidelity after = optimize::measure_fidelity(c.m, c.surface, 1);
  CHECK(after.points_off == 0);
  CHECK(after.turned <= before.turned);
  CHECK(schedule.worst() >= worst);
  CHECK(schedule.below(optimize::FaultCount::share * strategy.goal) <= below);
  CHECK(surface_shape(optimize::extract(c.m)).euler() == 2);
  CHECK_NOTHROW(optimize::build(optimize::extract(c.m), 180, 1));
}

TEST_CASE("points where the isosurface is not known count as off, and come back") {
  Case c;
  const auto is_known = [&](size_t v) {
    double distance;
    Vec3d normal;
    return c.surface.probe(c.m.point[v], distance, normal);
  };
  int lost = 0;
  for (size_t v = 0; v < c.m.point.size() && lost < 8; ++v) {
    double distance;
    Vec3d normal;
    const Vec3d from = c.m.point[v];
    if (c.m.vertex[v].kind != optimize::Kind::surface || !c.surface.probe(from, distance, normal))
      continue;
    const std::vector<int32_t> star = c.star(static_cast<int32_t>(v));
    for (double step = 0.3; step < 1.5 && is_known(v); step += 0.05)
      c.m.point[v] = from + step * h * normal;
    const bool positive =
        std::all_of(star.begin(), star.end(), [&](int32_t e) { return c.m.quality(c.m.element[e].v) > 1e-4f; });
    if (is_known(v) || !positive)
      c.m.point[v] = from;
    else
      ++lost;
    for (const int32_t e : star) {
      c.m.element[e].q = c.m.quality(c.m.element[e].v);
      c.m.note_change(e);
    }
  }
  REQUIRE(lost > 2);
  REQUIRE(optimize::measure_fidelity(c.m, c.surface, 1).points_off == lost);
  optimize::Schedule schedule(c.m, &c.surface, 32 * h, 1);
  for (int k = 0; k < 4; ++k)
    schedule.search(recovery(0.5));
  CHECK(optimize::measure_fidelity(c.m, c.surface, 1).points_off == 0);
}

TEST_CASE("one pass has room around every point, wherever the lattice of the parts lies") {
  Case c;
  optimize::Schedule schedule(c.m, &c.surface, 32 * h, 1);
  const optimize::Strategy strategy =
      recovery(0.3); // a fifth of the molecule's surface is near a side of a lattice of such cells
  int pushed = 0;
  for (size_t v = 0; v < c.m.point.size() && pushed < 60; ++v) {
    double distance;
    Vec3d normal;
    if (c.m.incident[v] < 0 || c.m.vertex[v].kind != optimize::Kind::surface || v % 7 != 0 ||
        !c.surface.probe(c.m.point[v], distance, normal))
      continue;
    c.m.point[v] += 0.05 * h * normal;
    for (const int32_t e : c.star(static_cast<int32_t>(v))) {
      c.m.element[e].q = c.m.quality(c.m.element[e].v);
      c.m.note_change(e);
    }
    REQUIRE(optimize::measure_fidelity(c.m, c.surface, 1).points_off == 1);
    ++pushed;
    schedule.search(strategy);
    REQUIRE(optimize::measure_fidelity(c.m, c.surface, 1).points_off == 0);
  }
  CHECK(pushed > 20);
}

TEST_CASE("boxes of cells are parts that do not overlap") {
  optimize::Parts parts;
  parts.n = {10, 10, 10};
  parts.low = {-1, -1, -1};
  parts.cell = 0.5;
  CHECK(parts.count() == 1000);
  CHECK(parts.at({-0.9, -0.9, -0.4}) == 1);
  REQUIRE(parts.add_box({0, 0, 0}, 1));           // cells 1 to 3
  CHECK_FALSE(parts.add_box({1.3, 0.1, 0.1}, 1)); // 3 to 5
  REQUIRE(parts.add_box({1.6, 0.1, 0.1}, 1));     // 4 to 6
  REQUIRE(parts.add_box({9, 9, 9}, 2));           // 7 to 9, and all beyond
  CHECK(parts.count() == 3);
  CHECK(parts.at({0.9, -0.4, 0.9}) == 0);
  CHECK(parts.at({1.1, 0.1, 0.1}) == 1);
  CHECK(parts.at({2.6, 0.1, 0.1}) == -1);
  CHECK(parts.at({-0.9, 0.1, 0.1}) == -1);
  CHECK(parts.at({100, 100, 100}) == 2);
}

TEST_CASE("what is restored is as it was saved", "[slow]") {
  Case c(GENERATE(0, 1)); // in the inside alone, edges of the surface have no full ring
  const optimize::DynamicMesh before = c.m;
  const auto size = static_cast<int32_t>(c.m.element.size()), points = static_cast<int32_t>(c.m.point.size());
  optimize::PartRoom room{0, {}, {}};
  for (int32_t k = 0; k < 1000; ++k)
    room.element.push_back(size + k), room.vertex.push_back(points + k);
  c.m.resize(size_t(size) + 1000, size_t(points) + 1000);
  // One part owns what lies below half the box, so that some elements are of neither.
  optimize::Parts parts;
  std::vector<int32_t>& owner = parts.owner;
  owner.resize(c.m.point.size());
  for (size_t v = 0; v < owner.size(); ++v)
    owner[v] = v < size_t(points) && c.m.point[v].x > h * n / 2;
  std::vector<uint32_t> stamp(c.m.element.size());
  optimize::Region region(c.m, &c.surface, nullptr, parts, stamp, room);
  std::vector<int32_t> inner;
  for (int32_t e = 0; e < size; ++e)
    if (region.owned(e))
      inner.push_back(e);
  const optimize::Snapshot snapshot = region.save(inner);
  optimize::Acceptance bold(recovery_guard); // any edge of the surface that can be flipped
  bold.aim = optimize::Aim::fit;
  bold.may_bend = true;
  bold.goal = 1e-4f;
  for (const int32_t e : inner)
    for (int i = 0; i < 3; ++i)
      for (int j = i + 1; j < 4; ++j)
        if (c.m.element[e].alive())
          optimize::remove_edge(region, bold, e, i, j);
  REQUIRE(region.counts.surface_flips > 10);
  optimize::Acceptance better(recovery_guard);
  better.goal = static_cast<float>(angle_quality(35));
  for (const int32_t e : inner)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        if (i != j && c.m.element[e].alive() && !optimize::split_edge(region, better, e, i, j) &&
            !optimize::remove_edge(region, better, e, i, j) && !optimize::contract_edge(region, better, e, i, j))
          optimize::smooth_vertex(region, better, c.m.element[e].v[i]);
  REQUIRE(region.counts.moves > 10);
  REQUIRE(region.counts.splits + region.counts.contractions > 10);
  const optimize::Snapshot changed = region.save([&] {
    std::vector<int32_t> alive;
    for (int32_t e = 0; e < size + 1000; ++e)
      if (c.m.element[e].alive() && region.owned(e))
        alive.push_back(e);
    return alive;
  }());
  const optimize::Snapshot changes = region.changes_since(snapshot);
  const optimize::DynamicMesh then = c.m;
  const int64_t operations = region.counts.total();
  const size_t free_then = room.element.size();
  for (const bool by_changes : {false, true}) {
    region.restore(snapshot);
    if (by_changes)
      region.redo(changes);
    else
      region.restore(changed);
    CHECK(region.counts.total() == operations);
    CHECK(room.element.size() == free_then);
    for (size_t v = 0; v < then.point.size(); ++v)
      REQUIRE((c.m.incident[v] == then.incident[v] && (then.incident[v] < 0 || c.m.point[v] == then.point[v])));
    for (size_t e = 0; e < then.element.size(); ++e)
      REQUIRE((c.m.element[e].v == then.element[e].v && c.m.element[e].n == then.element[e].n &&
               c.m.element[e].label == then.element[e].label && c.m.element[e].q == then.element[e].q));
  }
  const auto as_before = [&] {
    for (int32_t v = 0; v < points; ++v)
      REQUIRE((c.m.point[v] == before.point[v] && c.m.incident[v] == before.incident[v] &&
               c.m.touched[v] == before.touched[v] && c.m.state[v] == before.state[v] &&
               c.m.vertex[v].kind == before.vertex[v].kind));
    for (int32_t e = 0; e < size + 1000; ++e) {
      const optimize::Element& x = c.m.element[e];
      if (e >= size)
        REQUIRE_FALSE(x.alive());
      else
        REQUIRE((x.v == before.element[e].v && x.n == before.element[e].n && x.label == before.element[e].label &&
                 x.q == before.element[e].q));
    }
  };
  region.restore(snapshot);
  CHECK(region.counts.total() == 0);
  CHECK(room.element.size() == 1000);
  as_before();
  // Again and again, where little has been written; and faults, counted by what was written.
  std::vector<int32_t> slots = inner;
  slots.insert(slots.end(), room.element.begin(), room.element.end());
  optimize::FaultCount kept(region, slots, better);
  const auto counts_as_anew = [&] {
    optimize::FaultCount anew(region, slots, better);
    const optimize::Faults a = kept(), b = anew();
    REQUIRE((a.off == b.off && a.bent == b.bent && a.below == b.below && a.worst == b.worst));
    REQUIRE(kept.points_off() == anew.points_off());
  };
  counts_as_anew();
  int64_t done = 0;
  for (size_t k = 0; k < inner.size(); k += 1 + inner.size() / 40) {
    const optimize::Snapshot here = region.save(inner);
    for (const optimize::Acceptance& accept : {bold, better}) {
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
          if (const optimize::Element& e = c.m.element[inner[k]]; i != j && e.alive())
            optimize::remove_edge(region, accept, inner[k], i, j) ||
                optimize::split_edge(region, accept, inner[k], i, j) ||
                optimize::contract_edge(region, accept, inner[k], i, j) ||
                optimize::smooth_vertex(region, accept, e.v[i]);
      counts_as_anew();
    }
    done += region.counts.total();
    region.restore(k % 2 == 0 ? here : snapshot);
    as_before();
    counts_as_anew();
  }
  CHECK(done > 20);
}
