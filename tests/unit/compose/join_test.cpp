// join_test.cpp — joined densities against the density of the joined atoms.
#include "compose/join.hpp"
#include "density/tail.hpp"
#include "unit/density/completeness.hpp"
#include "unit/refusal.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

using namespace molmesh;
using compose::Combine;
using compose::Placed;
using test::check_equal;
using test::exact_density;

namespace {

struct Piece {
  BlockGrid grid;
  Tail tail;
};

Piece make(const Hierarchy& h, double spacing, double lower = 0.9, double upper = 1.1) {
  density::Options o;
  o.spacing = spacing;
  o.band_lower = lower;
  o.band_upper = upper;
  Piece p{test::compute(h, o), {}};
  p.tail = density::tail(h, o.decay, o.isovalue, p.grid.frame);
  return p;
}

/// The frame of all, with a cell more on each side.
GridFrame frame_of(std::span<const Placed> placed) {
  GridFrame f = placed[0].grid->frame;
  Vec3i lo = f.lower + placed[0].shift, hi = lo;
  for (const Placed& p : placed)
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::min(lo[a], p.grid->frame.lower[a] + p.shift[a] - 1);
      hi[a] = std::max(hi[a], p.grid->frame.lower[a] + p.shift[a] + p.grid->frame.points[a] + 1);
    }
  f.lower = lo;
  f.points = hi - lo;
  return f;
}

BlockGrid join(const std::vector<Placed>& placed, Combine combine, double lower = 0.9, double upper = 1.1,
               int threads = 1, compose::Counts* counts = nullptr) {
  FieldInfo info = placed[0].grid->info;
  info.band_lower = lower;
  info.band_upper = upper;
  compose::Options o;
  o.combine = combine;
  o.threads = threads;
  compose::Counts own;
  return compose::join(frame_of(placed), info, placed, o, counts ? *counts : own);
}

/// Two copies of the atoms, the second `by` away: one group more outermost.
Hierarchy twice(const Hierarchy& h, Vec3d by) {
  Hierarchy two = h;
  const auto n = static_cast<int64_t>(h.atom.size());
  for (Atom a : h.atom) {
    a.center += by;
    two.atom.push_back(a);
  }
  for (size_t l = 0; l < h.level.size(); ++l) {
    const int64_t shift = l + 1 < h.level.size() ? static_cast<int64_t>(h.level[l + 1].group.size()) : n;
    for (Group g : h.level[l].group) {
      g.begin += shift;
      g.end += shift;
      g.name += "'";
      two.level[l].group.push_back(g);
    }
  }
  return two;
}

/// Every point of the whole by brute force: values, sides, and crossed cells (I1 to I3).
template <class Exact>
void check_against(const BlockGrid& g, Exact&& exact_at, bool of_bands = false) {
  const BlockIndex index(g);
  const FieldInfo& info = g.info;
  const Vec3i n = g.frame.points;
  std::vector<double> exact;
  std::vector<uint8_t> active;
  for (int x = 0; x < n.x; ++x)
    for (int y = 0; y < n.y; ++y)
      for (int z = 0; z < n.z; ++z) {
        const Vec3i p = g.frame.lower + Vec3i{x, y, z};
        exact.push_back(exact_at(g.frame.position(p)));
        active.push_back(is_active(g, index, p));
      }
  const auto at = [&](int x, int y, int z) {
    return (size_t(x) * size_t(n.y) + size_t(y)) * size_t(n.z) + size_t(z);
  };
  int64_t wrong_value = 0, wrong_side = 0, missing = 0;
  for (int x = 0; x < n.x; ++x)
    for (int y = 0; y < n.y; ++y)
      for (int z = 0; z < n.z; ++z) {
        const double e = exact[at(x, y, z)], v = value_at(g, index, g.frame.lower + Vec3i{x, y, z});
        if (active[at(x, y, z)]) {
          const double off = (v - e) / std::max(1.0, e);
          // Beyond the band a union or difference may know one of several values alone.
          const bool low = of_bands && e < info.band_lower, high = of_bands && e > info.band_upper;
          wrong_value += (!high && off > info.tolerance) || (!low && off < -info.tolerance) ||
                         (high && v < info.band_upper) || (low && v > info.band_lower);
        } else
          wrong_side += std::abs(e - info.isovalue) > info.tolerance && (v > info.isovalue) != (e > info.isovalue);
        if (x + 1 == n.x || y + 1 == n.y || z + 1 == n.z)
          continue;
        double lo = 1e300, hi = 0;
        bool all = true;
        for (int c = 0; c < 8; ++c) {
          const size_t q = at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
          lo = std::min(lo, exact[q]);
          hi = std::max(hi, exact[q]);
          all = all && active[q];
        }
        missing += !all && lo < info.isovalue - info.tolerance && hi > info.isovalue + info.tolerance;
      }
  CHECK(wrong_value == 0);
  CHECK(wrong_side == 0);
  CHECK(missing == 0);
}

/// At random places, some `spread` Å from atoms, that lie beyond the tail's depth: the density is within its bound.
void check_tail(const Piece& p, const Hierarchy& h, unsigned seed, double spread) {
  const BlockIndex index(p.grid);
  std::vector<Vec3d> body; // grid points that are inside or active
  const Vec3i n = p.grid.frame.points;
  for (int x = 0; x < n.x; ++x)
    for (int y = 0; y < n.y; ++y)
      for (int z = 0; z < n.z; ++z) {
        const Vec3i q = p.grid.frame.lower + Vec3i{x, y, z};
        if (is_active(p.grid, index, q) || value_at(p.grid, index, q) > 0)
          body.push_back(p.grid.frame.position(q));
      }
  std::mt19937 random(seed);
  std::normal_distribution<double> step(0, spread);
  int beyond = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3d x = h.atom[random() % h.atom.size()].center + Vec3d{step(random), step(random), step(random)};
    double nearest2 = 1e300;
    for (const Vec3d& b : body)
      nearest2 = std::min(nearest2, norm2(x - b));
    const double distance = std::sqrt(nearest2);
    if (distance < p.tail.depth)
      continue;
    CHECK(exact_density(h, p.grid.info.decay, x) <= p.tail.bound(distance) * (1 + 1e-9));
    ++beyond;
  }
  CHECK(beyond > 10);
}

} // namespace

TEST_CASE("a piece by itself is copied bit for bit, wherever it is moved to") {
  for (const std::vector<double>& exponents : {std::vector<double>{0.3, 1}, {}, {2, 0.5}}) {
    const Piece p = make(test::random_chains(2, 10, 6, exponents, 3), 0.7);
    const BlockIndex from(p.grid);
    for (const Vec3i shift : {Vec3i{0, 0, 0}, {8, -16, 800}, {3, -5, 1001}, {-1, 7, 4}})
      for (const Combine combine : {Combine::sum, Combine::max}) {
        const BlockGrid g = join({{&p.grid, shift, p.tail}}, combine);
        CHECK(g.info.tolerance == p.grid.info.tolerance);
        if (shift == Vec3i{0, 0, 0}) {
          check_equal(g, p.grid);
          continue;
        }
        const BlockIndex to(g);
        int64_t differ = 0;
        const Vec3i n = p.grid.frame.points;
        for (int x = -9; x < n.x + 9; ++x)
          for (int y = -9; y < n.y + 9; ++y)
            for (int z = -9; z < n.z + 9; ++z) {
              const Vec3i q = p.grid.frame.lower + Vec3i{x, y, z};
              differ += is_active(p.grid, from, q) != is_active(g, to, q + shift) ||
                        value_at(p.grid, from, q) != value_at(g, to, q + shift);
            }
        CHECK(differ == 0);
      }
  }
}

TEST_CASE("the sum of pieces far enough apart is the density of their atoms, and complete") {
  for (const std::vector<double>& exponents : {std::vector<double>{0.5, 1}, {}, {1, 2}, {0.45, 1}}) {
    const double h = 0.75;
    Hierarchy one = test::random_chains(2, 6, 5, exponents, 11);
    if (exponents == std::vector<double>{0.45, 1})
      one = test::with_weights(one, 3, 0.85);
    const Piece p = make(one, h);
    const Vec3i n = p.grid.frame.points;
    const Vec3i shift{n.x + 5, 2, -3};
    INFO(exponents.size() << " levels, tail " << p.tail.log << ' ' << p.tail.decay << ' ' << p.tail.radius);
    const BlockGrid g = join({{&p.grid, {0, 0, 0}, p.tail}, {&p.grid, shift, p.tail}}, Combine::sum);
    CHECK(g.info.tolerance < 1.1e-4 + 0.02);
    check_against(g, [two = twice(one, h * to_double(shift)), k = g.info.decay](Vec3d x) {
      return exact_density(two, k, x);
    });
  }
}

TEST_CASE("what a file says of a field far from its surface holds, with weights too") {
  int known = 0;
  for (const std::vector<double>& exponents : {std::vector<double>{0.38, 1}, {0.5, 0.5}, {1, 2}, {0.8, 0.5, 1}})
    for (const unsigned seed : {3u, 4u, 5u, 6u}) {
      const Hierarchy h = test::with_weights(test::random_chains(2, 6, 5, exponents, seed), seed, 0.8);
      const Piece p = make(h, 0.3 + 0.05 * seed);
      if (!p.tail.known())
        continue;
      ++known;
      check_tail(p, h, seed, 5);
    }
  CHECK(known >= 8);
}

TEST_CASE("what a file says of a field with bodies without atoms holds, and their sum is joined") {
  for (const std::vector<double>& exponents : {std::vector<double>{}, {0.5, 1}, {2, 0.5}})
    for (const unsigned seed : {3u, 4u}) {
      Hierarchy h = test::with_bodies(test::random_chains(1, 3, 5, exponents, seed));
      const double spacing = 0.8 + 0.1 * seed;
      const Piece p = make(h, spacing);
      REQUIRE(p.tail.known());
      check_tail(p, h, seed, 9);
      h.body[1].skin = 0.5 * spacing; // less than half the diagonal of a cell: it may slip through
      h.atom[static_cast<size_t>(h.body[1].atom)].radius = h.body[1].skin;
      CHECK_FALSE(density::tail(h, 1, 1, p.grid.frame).known());
    }
  const Piece rods = make(test::with_bodies(test::random_chains(1, 3, 5, {0.5, 1}, 3)), 1),
              atoms = make(test::random_chains(2, 6, 5, {0.5, 1}, 11), 1);
  const Vec3i shift{rods.grid.frame.points.x + 20, 0, 0};
  const BlockGrid sum = join({{&rods.grid, {0, 0, 0}, rods.tail}, {&atoms.grid, shift, atoms.tail}}, Combine::sum);
  CHECK(sum.info.tolerance < 1.1e-4 + 0.02);
  const std::string line = test::refusal(Status::usage, [&] {
    join({{&rods.grid, {0, 0, 0}, rods.tail}, {&atoms.grid, shift, {}, false, nullptr, {}, "map.vdb"}},
         Combine::sum);
  });
  CHECK(line.rfind("map.vdb: the file does not say how its density falls", 0) == 0);
}

TEST_CASE("pieces that meet add up where their bands know low densities, else their sum is refused") {
  const double h = 0.75;
  const Hierarchy one = test::random_chains(1, 8, 6, {0.5, 1}, 5);
  const Piece narrow = make(one, h), wide = make(one, h, 0.01, 1.1);
  const Vec3i shift{9, 1, -2};
  const std::string line = test::refusal(Status::usage, [&] {
    join({{&narrow.grid, {0, 0, 0}, narrow.tail}, {&narrow.grid, shift, narrow.tail}}, Combine::sum);
  });
  CHECK(line.find("of their sum is not in the files") != std::string::npos);
  CHECK(line.find("[combine][unknown]") != std::string::npos);

  compose::Counts counts;
  const BlockGrid g = join({{&wide.grid, {0, 0, 0}, wide.tail}, {&wide.grid, shift, wide.tail}}, Combine::sum, 0.9,
                           1.1, 1, &counts);
  CHECK(counts.shared_points > 0);
  CHECK(g.info.tolerance <= 0.0203);
  const Hierarchy two = twice(one, h * to_double(shift));
  check_against(g, [&](Vec3d x) { return exact_density(two, g.info.decay, x); });
  // Where both know the point their sum is within twice the tolerance.
  const BlockIndex index(g), of_one(wide.grid);
  double worst = 0;
  int64_t both = 0;
  for (size_t b = 0; b < g.corner.size(); ++b)
    for (int s = 0; s < 512; ++s) {
      const Vec3i p = g.corner[b] + within_block(s);
      if (!is_active(g, index, p) || !is_active(wide.grid, of_one, p) || !is_active(wide.grid, of_one, p - shift))
        continue;
      ++both;
      const double exact = exact_density(two, g.info.decay, g.frame.position(p));
      worst = std::max(worst, std::abs(value_at(g, index, p) - exact) / std::max(1.0, exact));
    }
  CHECK(both > 100);
  CHECK(worst <= 2e-4);
}

TEST_CASE("union and difference are those of the fields, and complete") {
  const double h = 0.8;
  const Hierarchy one = test::random_chains(1, 9, 6, {0.4, 1}, 29),
                  other = test::random_chains(1, 9, 6, {1, 1}, 30);
  const Piece a = make(one, h);
  Piece b = make(other, h);
  b.grid.frame.origin = a.grid.frame.origin; // another lattice: as if moved onto this one
  const Vec3i shift{4, -3, 9};
  const Vec3d moved = [&] {
    const Piece original = make(other, h);
    return original.grid.frame.origin - a.grid.frame.origin - h * to_double(shift);
  }();
  const auto field_a = [&](Vec3d x) { return exact_density(one, 1, x); };
  const auto field_b = [&](Vec3d x) { return exact_density(other, 1, x + moved); };
  const std::vector<Placed> both{{&a.grid, {0, 0, 0}, a.tail}, {&b.grid, shift, b.tail}};
  check_against(
      join(both, Combine::max), [&](Vec3d x) { return std::max(field_a(x), field_b(x)); }, true);
  const std::vector<Placed> less{{&a.grid, {0, 0, 0}, a.tail}, {&b.grid, shift, b.tail, true}};
  check_against(
      join(less, Combine::max, 1 / 1.1), [&](Vec3d x) { return std::min(field_a(x), 1 / field_b(x)); }, true);
}

TEST_CASE("any number of threads joins to the same bits") {
  const Piece p = make(test::random_chains(2, 12, 6, {0.5, 1}, 7), 0.6, 0.01);
  const std::vector<Placed> placed{
      {&p.grid, {0, 0, 0}, p.tail}, {&p.grid, {12, 3, 5}, p.tail}, {&p.grid, {-20, 1, 0}, p.tail, true}};
  for (const Combine combine : {Combine::sum, Combine::max})
    check_equal(join(placed, combine, 0.91, 1.1, 1), join(placed, combine, 0.91, 1.1, 5));
}
