// density_test.cpp — the device's search, run by the host: I1 to I3 and I5, slabs, determinism.
#include "cuda/density/neighboring_search.hpp"
#include "cuda/par/host.hpp"
#include "density/density.hpp"
#include "unit/density/completeness.hpp"
#include "unit/refusal.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;
using test::check_equal;

namespace {

struct Run {
  BlockGrid grid;
  int64_t slabs = 0, most_used = 0;
  density::Counts counts;
};

Run on_backend(const Hierarchy& h, const density::Options& o, int threads = 1,
               int64_t budget = std::numeric_limits<int64_t>::max()) {
  cuda::HostBackend backend(threads, {budget});
  Run run;
  const auto find = [&](const density::Field& f, const GridFrame& frame, const density::SearchOptions& s,
                        density::SearchCounts& c) {
    cuda::Search<cuda::HostBackend> search(backend, f, frame, s);
    Band band = search.run(c);
    run.slabs = search.slabs();
    return band;
  };
  run.grid = to_block_grid(density::compute(h, o, run.counts, find), 1);
  run.most_used = backend.most_used().own;
  return run;
}

/// Long along x, so that thin slabs are a small part.
Hierarchy long_chains() {
  Hierarchy h = test::random_chains(3, 60, 8, {0.4, 1}, 3);
  for (Atom& a : h.atom)
    a.center.x *= 4;
  return h;
}

BlockGrid on_host(const Hierarchy& h, const density::Options& o) {
  density::Counts counts;
  return to_block_grid(density::compute(h, o, counts), 1);
}

/// The same active points but where G is within ε of a limit, values within ε (I5).
void check_same(const BlockGrid& a, const BlockGrid& b) {
  REQUIRE(a.frame.points == b.frame.points);
  const BlockIndex ia(a), ib(b);
  const double eps = a.info.tolerance;
  int64_t differ = 0, other_value = 0, other_side = 0, active = 0;
  for (const auto& [x, ix, y, iy] : {std::tie(a, ia, b, ib), std::tie(b, ib, a, ia)}) {
    for (size_t k = 0; k < x.corner.size(); ++k)
      for (int s = 0; s < 512; ++s) {
        const Vec3i p = x.corner[k] + within_block(s);
        const float v = value_at(x, ix, p), w = value_at(y, iy, p);
        const bool here = is_active(x, ix, p), there = is_active(y, iy, p);
        active += here;
        differ += here != there;
        if (here && there)
          other_value += std::abs(v - w) > 2 * eps * std::max(1.f, v);
        else if (!here && !there)
          other_side += v != w;
      }
    for (const Vec3i& c : x.inside)
      other_side += value_at(y, iy, c) != x.info.inside_value && !is_active(y, iy, c);
  }
  CHECK(active > 0);
  CHECK(other_value == 0);
  CHECK(other_side == 0);
  CHECK(differ * 10000 <= active); // limits that G meets within ε; check_complete looks at each
}

} // namespace

TEST_CASE("device density: values are within the tolerance for exponents from 0.02 to 4 and any depth", "[slow]") {
  const std::vector<std::vector<double>> settings = {
      {},        {1},       {0.3, 1}, {0.5, 1},      {0.05, 0.5}, {0.02, 1},     {0.02, 0.02}, {2, 1},
      {1, 0.02}, {4, 0.25}, {0.3, 4}, {0.8, 0.5, 1}, {2, 1, 1},   {0.5, 2, 0.5}, {1, 1, 0.3},  {0.3, 0.8, 2.5}};
  for (const std::vector<double>& exponents : settings)
    for (const double tolerance : {1e-3, 1e-4, 1e-6}) {
      const Hierarchy h = test::random_chains(3, 12, 6, exponents, 17);
      density::Options o;
      o.spacing = 0.9;
      o.tolerance = tolerance;
      const BlockGrid g = on_backend(h, o).grid;
      std::string text;
      for (const double p : exponents)
        text += std::to_string(p) + " ";
      INFO("exponents, innermost first: " << text << "tolerance " << tolerance);
      REQUIRE(!g.corner.empty());
      CHECK(test::worst_error(h, g, 100) <= 1);
    }
}

TEST_CASE("device density: sums of very many terms are within the tolerance") {
  for (const Hierarchy& h : test::crowds(30000))
    CHECK(test::worst_error(h, on_backend(h, test::around_a_crowd(4.1e-5)).grid, 40) <= 1);
}

TEST_CASE("device density: an atom's term may matter where its factors without the peak underflow") {
  Hierarchy h; // large atoms, small powers: of κd² up to 150
  h.level.push_back({"bead", {}});
  for (int64_t i = 0; i < 400; ++i) {
    h.atom.push_back({{0, 0, 0}, 8.8});
    h.level[0].group.push_back({"b", 0.2, i, i + 1});
  }
  density::Options o;
  o.spacing = 2;
  CHECK(test::worst_error(h, on_backend(h, o).grid, 200) <= 1);
}

TEST_CASE("device density: no band cell is missed, no point is on the wrong side, and the host finds the same") {
  for (const std::vector<double>& exponents :
       {std::vector<double>{0.3, 1}, {0.5, 1}, {0.1, 0.5}, {1, 2}, {}, {0.4, 0.7, 1}}) {
    density::Options o;
    o.spacing = 1.1;
    const Hierarchy h = test::random_chains(2, 15, 6, exponents, 23);
    const BlockGrid g = on_backend(h, o).grid;
    test::check_complete(h, g);
    check_same(g, on_host(h, o));
  }
}

TEST_CASE("device density: weights count as on the host") {
  for (const std::vector<double>& exponents : {std::vector<double>{0.38, 1}, {0.5, 2}, {0.8, 0.5, 1}}) {
    density::Options o;
    o.spacing = 1.1;
    const Hierarchy h = test::with_weights(test::random_chains(2, 15, 6, exponents, 23), 3);
    const BlockGrid g = on_backend(h, o).grid;
    test::check_complete(h, g);
    check_same(g, on_host(h, o));
  }
}

TEST_CASE("device density: molecules far apart and a hollow ball are all found") {
  density::Options o;
  o.spacing = 1.3;
  Hierarchy far;
  far.atom.push_back({{0, 0, 0}, 2.0});
  far.atom.push_back({{100, 3, -2}, 1.5});
  far.atom.push_back({{40, 0.2, 0.1}, 1.7});
  const BlockGrid g = on_backend(far, o).grid;
  test::check_complete(far, g);
  check_same(g, on_host(far, o));

  Hierarchy hollow;
  for (int i = 0; i < 400; ++i) { // Fibonacci sphere
    const double z = 1 - (2 * i + 1) / 400.0, t = 2.399963229728653 * i, r = std::sqrt(1 - z * z);
    hollow.atom.push_back({{12 * r * std::cos(t), 12 * r * std::sin(t), 12 * z}, 1.7});
  }
  o.spacing = 1.0;
  const BlockGrid ball = on_backend(hollow, o).grid;
  test::check_complete(hollow, ball);
  check_same(ball, on_host(hollow, o));
}

TEST_CASE("device density: slabs, threads and the full search change nothing", "[slow]") {
  const Hierarchy h = long_chains();
  density::Options o;
  o.spacing = 0.5;
  const Run one = on_backend(h, o);
  CHECK(one.slabs == 1);
  check_same(one.grid, on_host(h, o));
  for (const int64_t share : {2, 5}) {
    const int64_t budget = one.most_used / share;
    const Run many = on_backend(h, o, 2, budget);
    CHECK(many.slabs > 1);
    CHECK(many.most_used <= budget);
    check_equal(many.grid, one.grid);
    CHECK(many.grid.info.analyzed_points >= one.grid.info.analyzed_points);
  }
  check_equal(on_backend(h, o, 3).grid, one.grid);
  for (const double spacing : {0.25, 0.9}) { // clusters are listed for larger cubes of blocks, and for blocks
    density::Options other = o;
    other.spacing = spacing;
    check_same(on_backend(h, other).grid, on_host(h, other));
  }
  o.full_search = true;
  check_equal(on_backend(h, o).grid, one.grid);
}

TEST_CASE("device density: slabs are given away as they are found, each block once", "[slow]") {
  const Hierarchy h = long_chains();
  density::Options o;
  o.spacing = 0.5;
  const Run kept = on_backend(h, o);
  std::vector<Vec3i> corner;
  int64_t wrong = 0, takes = 0;
  o.take = [&](const FieldInfo& info, std::span<const BandBlocks> runs) {
    ++takes;
    wrong += info.inside_value != kept.grid.info.inside_value; // on another thread
    for (const BandBlocks& run : runs)
      for (const BandBlock& b : run) {
        const size_t n = corner.size();
        corner.push_back(b.corner);
        BlockValues room;
        const float* value = active_values(b, room);
        for (int s = 0; s < 512; ++s)
          if (b.active[s >> 6] >> (s & 63) & 1)
            wrong += n >= kept.grid.corner.size() || *value++ != kept.grid.value[512 * n + size_t(s)];
      }
  };
  const Run given_away = on_backend(h, o, 2, kept.most_used / 2);
  CHECK(given_away.slabs > 1);
  CHECK(takes > 1);
  CHECK(given_away.grid.corner.empty());
  CHECK(corner == kept.grid.corner);
  CHECK(wrong == 0);
}

TEST_CASE("device density: a budget that no slab fits in is an error in one line") {
  const Hierarchy h = test::random_chains(3, 40, 8, {0.4, 1}, 3);
  density::Options o;
  o.spacing = 0.6;
  const std::string line = test::refusal(Status::failed, [&] { on_backend(h, o, 1, 100000); });
  CHECK(line.find("not enough memory on the device") != std::string::npos);
}

TEST_CASE("the molecule's tree finds exactly the clusters within their cutoff, in order") {
  for (const std::vector<double>& exponents : {std::vector<double>{}, {0.3}, {0.3, 1}, {0.5, 0.8, 1}}) {
    const Hierarchy h = test::random_chains(4, 30, 20, exponents, 8);
    const density::Field f = density::make_field(h, 1, 1e-5);
    const std::vector<cuda::BvhNode> tree = cuda::bvh(f);
    cuda::FieldView v{};
    v.box = f.box.data();
    v.cutoff2 = f.cutoff2.data();
    v.node = tree.data();
    v.nodes = static_cast<int32_t>(tree.size());
    const density::Box all = f.bounds();
    int64_t found_any = 0;
    for (int i = 0; i < 200; ++i) {
      const double t = i / 200.0;
      const Vec3d at =
          all.lo + Vec3d{t * (all.hi.x - all.lo.x), (1 - t) * (all.hi.y - all.lo.y), t * t * (all.hi.z - all.lo.z)};
      const density::Box box{at, at + Vec3d{2, 1, 3}};
      std::vector<int32_t> expected, found;
      for (int32_t c = 0; c < f.clusters(); ++c)
        if (density::distance2(box, f.box[c]) < f.cutoff2[c])
          expected.push_back(c);
      cuda::for_near_clusters(v, box, [&](int32_t c) {
        found.push_back(c);
        return true;
      });
      CHECK(found == expected);
      found_any += !found.empty();
    }
    CHECK(found_any > 50);
  }
}
