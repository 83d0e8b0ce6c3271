// validity_test.cpp — every rule of I6 is kept by valid meshes and broken by one made to break it.
#include "mesh/validity.hpp"
#include "meshes.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <set>

using namespace molmesh;
using namespace molmesh::testing;

namespace {

/// A ball-like region of cubes in a box, with a cavity of one cube.
TetMesh body() {
  return cubes(7, [](Vec3i c) -> int32_t {
    if (c == Vec3i{3, 3, 3})
      return Region::cavity;
    return norm2(to_double(c) - Vec3d{3, 3, 3}) <= 4 ? Region::molecule : Region::outside;
  });
}

std::set<std::string> rules(const Validity& v) {
  std::set<std::string> s;
  for (const Fault& f : v.faults)
    s.insert(f.rule);
  return s;
}
std::set<std::string> rules(const TetMesh& m) {
  const Validity v = check_validity(m, 2);
  for (const Fault& f : v.faults) {
    CHECK(f.count > 0);
    CHECK_FALSE(f.example.empty());
  }
  return rules(v);
}
int64_t count(const TetMesh& m, const char* rule) {
  for (const Fault& f : check_validity(m, 1).faults)
    if (f.rule == rule)
      return f.count;
  return 0;
}

} // namespace

TEST_CASE("a box of cubes is valid, with the right sizes") {
  const Validity v = check_validity(cubes(3, all_molecule, 0.5, {-7, 2, 1}), 2);
  REQUIRE(rules(v).empty());
  REQUIRE(v.region.size() == 1);
  CHECK(v.region[0].tets == 162);
  CHECK(v.volume == Approx(1.5 * 1.5 * 1.5).epsilon(1e-15));
  const SurfaceSummary& b = v.region[0].boundary;
  CHECK(b.area == Approx(6 * 2.25));
  CHECK(b.volume == Approx(v.volume));
  CHECK(b.euler == 2);
  CHECK(b.components == 1);
  CHECK(b.triangles == 6 * 9 * 2);
  CHECK(v.surface.triangles == 0);
  CHECK(v.low == Vec3d{-7, 2, 1});
  CHECK(v.high == Vec3d{-5.5, 3.5, 2.5});
}

TEST_CASE("regions, cavities and parts of them are valid") {
  const TetMesh m = body();
  const Validity v = check_validity(m, 2);
  REQUIRE(rules(v).empty());
  REQUIRE(v.region.size() == 3);
  CHECK(v.region[0].boundary.components == 2);
  CHECK(v.region[0].boundary.euler == 4);
  CHECK(v.region[1].boundary.components == 2);
  CHECK(v.region[2].boundary.euler == 2);
  CHECK(v.region[2].volume == Approx(1));
  CHECK(v.surface.components == 2);
  CHECK(v.surface.euler == 4);
  CHECK(v.surface.volume == Approx(v.region[0].volume)); // the cavity counts negative
  CHECK(v.volume == Approx(343));
  for (int32_t region : {1, 2, 3})
    CHECK(rules(extract(m, [&](int32_t r) { return r == region; })).empty());
}

TEST_CASE("a ring has Euler number 0") {
  const TetMesh m = cubes(5, [](Vec3i c) -> int32_t {
    const bool ring = c.z == 2 && c.x >= 1 && c.x <= 3 && c.y >= 1 && c.y <= 3 && !(c.x == 2 && c.y == 2);
    return ring ? Region::molecule : Region::outside;
  });
  const Validity v = check_validity(m, 1);
  REQUIRE(v.valid());
  CHECK(v.surface.euler == 0);
  CHECK(v.surface.components == 1);
}

TEST_CASE("the same report at any number of threads") {
  std::mt19937_64 random(1);
  TetMesh m = cubes(14, [&](Vec3i) { return int32_t(random() % 3 + 1); });
  for (int i = 0; i < 50; ++i)
    std::swap(m.tet[random() % m.tet.size()][0], m.tet[random() % m.tet.size()][1]);
  const Validity one = check_validity(m, 1);
  CHECK_FALSE(one.valid());
  for (int threads : {2, 5}) {
    const Validity v = check_validity(m, threads);
    REQUIRE(v.faults.size() == one.faults.size());
    for (size_t i = 0; i < v.faults.size(); ++i) {
      CHECK(v.faults[i].rule == one.faults[i].rule);
      CHECK(v.faults[i].count == one.faults[i].count);
      CHECK(v.faults[i].example == one.faults[i].example);
    }
    CHECK(v.volume == one.volume);
    CHECK(v.surface.area == one.surface.area);
  }
}

TEST_CASE("each rule is broken by a mesh made to break it") {
  using Rules = std::set<std::string>;
  TetMesh m = body();
  SECTION("index") {
    m.tet[5][2] = 100'000;
    CHECK(rules(m) == Rules{"index"});
  }
  SECTION("index of a triangle") {
    m.tri[5][2] = -1;
    CHECK(rules(m) == Rules{"index"});
  }
  SECTION("volume: inverted") {
    std::swap(m.tet[0][1], m.tet[0][2]);
    const Rules r = rules(m);
    CHECK(r.count("volume"));
    CHECK(r.count("folded_face"));
  }
  SECTION("volume: a point moved through a face") {
    m.point[m.tet[200][0]] += Vec3d{1.4, 0, 0};
    CHECK(rules(m).count("volume"));
  }
  SECTION("volume: flat to the last bit only") {
    TetMesh one;
    one.point = {{0.1, 0.1, 0.1}, {1.1, 0.1, 0.1}, {0.1, 1.1, 0.1}, {0.3, 0.3, 0.1}};
    one.tet = {{0, 1, 2, 3}};
    one.region = {1};
    rebuild_triangles(one);
    CHECK(rules(one) == Rules{"volume"});
    one.point[3].z = std::nextafter(0.1, 1);
    CHECK(rules(one).empty());
  }
  SECTION("duplicate point") {
    m.point.push_back(m.point[77]);
    CHECK(rules(m) == Rules{"duplicate_point", "unused_point"});
    CHECK(count(m, "duplicate_point") == 1);
  }
  SECTION("duplicate point: zeros of either sign") {
    TetMesh two = cubes(1, all_molecule);
    two.point.push_back({-0.0, 0, -0.0});
    CHECK(count(two, "duplicate_point") == 1);
  }
  SECTION("unused point") {
    m.point.push_back({3.01, 2, 1});
    CHECK(rules(m) == Rules{"unused_point"});
  }
  SECTION("duplicate tetrahedron, twice and three times") {
    for (int copies = 1; copies <= 2; ++copies) {
      const Tet t = m.tet[100];
      m.tet.push_back({t[1], t[2], t[0], t[3]});
      m.region.push_back(m.region[100]);
      const Rules r = rules(m);
      CHECK(r.count("duplicate_tet"));
      CHECK(r.count("crowded_face"));
      CHECK(count(m, "duplicate_tet") == copies);
    }
    TetMesh alone;
    alone.point = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    alone.tet = {{0, 1, 2, 3}, {1, 2, 0, 3}};
    alone.region = {1, 1};
    CHECK(rules(alone).count("duplicate_tet"));
  }
  SECTION("folded face") {
    TetMesh fold;
    fold.point = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.1, 2}};
    fold.tet = {{0, 1, 2, 3}, {0, 1, 2, 4}};
    fold.region = {1, 1};
    rebuild_triangles(fold);
    CHECK(rules(fold).count("folded_face"));
    CHECK_FALSE(rules(fold).count("volume"));
  }
  SECTION("missing triangle") {
    m.tri.pop_back();
    m.boundary.pop_back();
    CHECK(rules(m) == Rules{"missing_triangle"});
  }
  SECTION("stray triangle") {
    m.tri.push_back({m.tet[0][0], m.tet[0][1], m.tet[0][3]});
    m.tri.push_back({0, 1, 200});
    m.boundary.insert(m.boundary.end(), {1, 1});
    const Rules r = rules(m);
    CHECK(r.count("stray_triangle"));
  }
  SECTION("duplicate triangle") {
    m.tri.push_back({m.tri[3][1], m.tri[3][2], m.tri[3][0]});
    m.boundary.push_back(m.boundary[3]);
    CHECK(rules(m) == Rules{"duplicate_triangle"});
  }
  SECTION("triangle orientation") {
    for (size_t t : {size_t{0}, m.tri.size() / 2})
      std::swap(m.tri[t][0], m.tri[t][1]);
    CHECK(rules(m) == Rules{"triangle_orientation"});
    CHECK(count(m, "triangle_orientation") == 2);
  }
  SECTION("triangle order does not matter, nor where a triangle starts") {
    std::reverse(m.tri.begin(), m.tri.end());
    std::reverse(m.boundary.begin(), m.boundary.end());
    for (Tri& t : m.tri)
      std::rotate(t.begin(), t.begin() + 1, t.end());
    CHECK(rules(m).empty());
  }
  SECTION("an exterior whose surface points out of it") {
    m = extract(m, [](int32_t r) { return r == Region::outside; });
    CHECK(rules(m).empty());
    for (size_t t = 0; t < m.tri.size(); ++t)
      if (m.boundary[t] == Boundary::surface)
        std::swap(m.tri[t][0], m.tri[t][1]);
    CHECK(rules(m) == Rules{"triangle_orientation"});
  }
  SECTION("crowded_edge: two cubes that share an edge") {
    m = cubes(4, [](Vec3i c) -> int32_t {
      return c == Vec3i{1, 1, 1} || c == Vec3i{2, 2, 1} ? Region::molecule : Region::outside;
    });
    CHECK(rules(m) == Rules{"crowded_edge", "pinched_point"}); // its ends
    CHECK(count(m, "crowded_edge") == 2);                      // seen from both regions
  }
  SECTION("pinched point: two cubes that share a corner") {
    m = cubes(4, [](Vec3i c) -> int32_t {
      return c == Vec3i{1, 1, 1} || c == Vec3i{2, 2, 2} ? Region::molecule : Region::outside;
    });
    CHECK(rules(m) == Rules{"pinched_point"});
    CHECK(count(m, "pinched_point") == 2);
  }
  SECTION("crowded_face, and the open edges round it") {
    const auto inner = static_cast<size_t>(std::find(m.region.begin(), m.region.end(), 1) - m.region.begin());
    m.point.push_back({3.1, 3.2, 3.3});
    m.tet.push_back({m.tet[inner][0], m.tet[inner][1], m.tet[inner][2], int32_t(m.point.size() - 1)});
    m.region.push_back(1);
    const Rules r = rules(m);
    CHECK(r.count("crowded_face"));
    CHECK(r.count("open_edge"));
  }
  SECTION("box label inside") {
    const auto t = std::find(m.boundary.begin(), m.boundary.end(), 1) - m.boundary.begin();
    m.boundary[t] = Boundary::box_y1;
    CHECK(rules(m).count("box_label"));
  }
  SECTION("surface label on the wall") {
    const auto t = std::find(m.boundary.begin(), m.boundary.end(), Boundary::box_z1) - m.boundary.begin();
    m.boundary[t] = Boundary::surface;
    CHECK(rules(m).count("box_label"));
  }
  SECTION("box plane") {
    for (Vec3d& p : m.point)
      if (p == Vec3d{7, 3, 3})
        p.x = std::nextafter(7.0, 0);
    CHECK(rules(m) == Rules{"box_plane"});
  }
  SECTION("box plane: a wrong side") {
    const auto t = std::find(m.boundary.begin(), m.boundary.end(), Boundary::box_z1) - m.boundary.begin();
    m.boundary[t] = Boundary::box_z0;
    CHECK(rules(m).count("box_plane"));
  }
}

TEST_CASE("box rules wait for our labels") {
  TetMesh m = body();
  for (int32_t& b : m.boundary)
    if (b == Boundary::box_x0)
      b = 12;
  for (Vec3d& p : m.point)
    if (p == Vec3d{7, 3, 3})
      p.x = 7.25;
  CHECK(rules(m).empty());
}

TEST_CASE("surfaces agree with a slow count on random regions") {
  std::mt19937_64 random(9);
  for (int n = 0; n < 20; ++n) {
    const TetMesh m = cubes(4, [&](Vec3i) { return int32_t(random() % 2 + 1); });
    const Validity v = check_validity(m, 2);
    const LargeArray<int32_t> across = face_neighbors(m, 1);
    int64_t crowded_edges = 0, pinched = 0;
    for (const RegionSummary& r : v.region) {
      std::map<std::array<int32_t, 2>, int> directed;
      std::map<int32_t, std::vector<std::array<int32_t, 2>>> link;
      int64_t triangles = 0;
      for (size_t f = 0; f < across.size(); ++f) {
        if (m.region[f / 4] != r.region)
          continue;
        if (across[f] >= 0 && m.region[static_cast<size_t>(across[f]) / 4] == r.region)
          continue;
        const Tri t = face_points(m, int64_t(f));
        ++triangles;
        for (size_t i = 0; i < 3; ++i) {
          ++directed[{t[i], t[(i + 1) % 3]}];
          link[t[i]].push_back({t[(i + 1) % 3], t[(i + 2) % 3]});
        }
      }
      std::set<std::array<int32_t, 2>> edges, bad;
      for (const auto& [e, k] : directed) {
        const std::array<int32_t, 2> key{std::min(e[0], e[1]), std::max(e[0], e[1])};
        edges.insert(key);
        if (k != 1 || directed.count({e[1], e[0]}) == 0 || directed.at({e[1], e[0]}) != 1)
          bad.insert(key);
      }
      crowded_edges += int64_t(bad.size());
      for (const auto& [p, opposite] : link) {
        // Walk the link: from edge to edge where exactly one continues across a good edge.
        std::set<size_t> seen{0};
        for (bool grown = true; grown;) {
          grown = false;
          for (size_t a = 0; a < opposite.size(); ++a)
            for (size_t b = 0; b < opposite.size(); ++b)
              for (size_t end : {0u, 1u})
                if (seen.count(a) && !seen.count(b) && opposite[a][end] == opposite[b][1 - end] &&
                    !bad.count({std::min(p, opposite[a][end]), std::max(p, opposite[a][end])})) {
                  seen.insert(b);
                  grown = true;
                }
        }
        pinched += seen.size() != opposite.size();
      }
      CHECK(r.boundary.triangles == triangles);
      CHECK(r.boundary.edges == int64_t(edges.size()));
      CHECK(r.boundary.points == int64_t(link.size()));
      CHECK(r.boundary.volume == Approx(r.volume));
    }
    const auto faults = [&](const char* rule) { return count(m, rule); };
    CHECK(faults("crowded_edge") == crowded_edges);
    CHECK(faults("pinched_point") == pinched);
  }
}
