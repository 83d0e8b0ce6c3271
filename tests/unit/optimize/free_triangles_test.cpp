// free_triangles_test.cpp — where a mesh ends: the triangles known, and surfaces that must not cross themselves.
#include "geom/intersect.hpp"
#include "geom/tet_measures.hpp"
#include "lattice_mesh.hpp"
#include "mesh/surface_crossings.hpp"
#include "optimize/crossings/free_triangles.hpp"
#include "optimize/optimize.hpp"
#include "optimize/schedule/schedule.hpp"
#include <catch2/catch.hpp>
#include <random>

using namespace molmesh;
using namespace molmesh::test;

TEST_CASE("free triangles are found where they are, and only those that are there") {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> u(0, 10), size(-1, 1);
  std::vector<Vec3d> point;
  std::map<int64_t, optimize::FreeTriangle> there;
  optimize::FreeTriangles triangles(0.7);
  const auto put = [&](optimize::FreeTriangles& s, int64_t face) {
    const Vec3d p{u(generator), u(generator), u(generator)};
    const auto v = static_cast<int32_t>(point.size());
    for (int i = 0; i < 3; ++i)
      point.push_back(p + Vec3d{size(generator), size(generator), size(generator)});
    const optimize::FreeTriangle t = optimize::free_triangle(point, {v, v + 1, v + 2}, face);
    there[face] = t;
    s.insert(t);
  };
  const auto check = [&](const optimize::FreeTriangles& s) {
    CHECK(s.alive() == there.size());
    for (int n = 0; n < 50; ++n) {
      const Vec3d p{u(generator), u(generator), u(generator)};
      const std::vector<Vec3d> corners{p, p + Vec3d{1, 0.2, 0}, p + Vec3d{0, 0.5, 1}};
      const optimize::FreeTriangle probe = optimize::free_triangle(corners, {0, 1, 2}, -1);
      std::multiset<int64_t> expected, found; // each once
      for (const auto& [face, t] : there)
        if (probe.meets(t))
          expected.insert(face);
      s.any(probe, [&](const optimize::FreeTriangle& t) {
        found.insert(t.face);
        return false;
      });
      CHECK(found == expected);
    }
  };
  for (int64_t face = 0; face < 300; ++face)
    put(triangles, face);
  for (int64_t face = 0; face < 300; face += 7) // moved
    put(triangles, face);
  for (int64_t face = 0; face < 300; face += 3) { // a little, mostly in the same cells
    for (const int32_t v : there[face].v)
      point[v] += Vec3d{1e-3 * size(generator), 1e-3 * size(generator), 0};
    there[face] = optimize::free_triangle(point, there[face].v, face);
    triangles.insert(there[face]);
  }
  check(triangles);
  for (int64_t face = 0; face < 300; face += 11) {
    triangles.erase(face);
    there.erase(face);
  }
  for (int64_t face = 0; face < 300; face += 22) // in what these left
    put(triangles, face);
  CHECK(triangles.knows(11));
  CHECK_FALSE(triangles.knows(300));
  check(triangles);
  optimize::FreeTriangles later(0.7);
  put(later, 5);
  put(later, 900);
  later.erase(6);
  there.erase(6);
  optimize::FreeTriangleChanges changes = later.changes();
  triangles.move_along(changes);
  triangles.merge(changes);
  check(triangles);
  for (int64_t face = 0; face < 1000; ++face) {
    triangles.erase(face);
    there.erase(face);
  }
  CHECK(triangles.boxes() == 0);
  check(triangles);
  for (int64_t face = 0; face < 50; ++face)
    put(triangles, face);
  check(triangles);
}

TEST_CASE("triangles of any size take few cells and are found") {
  optimize::FreeTriangles triangles(0.5);
  std::vector<Vec3d> point;
  std::vector<optimize::FreeTriangle> all;
  for (int64_t face = 0; face < 60; ++face) { // 0.5 to 250 Å
    const double size = 0.5 * std::pow(500, double(face) / 59);
    const auto v = static_cast<int32_t>(point.size());
    const Vec3d p{7. * double(face % 4), 3. * double(face % 7), 0};
    for (const Vec3d& corner : {p, p + size * Vec3d{1, 0.2, 0.1}, p + size * Vec3d{0.1, 0.9, 0.8}})
      point.push_back(corner);
    all.push_back(optimize::free_triangle(point, {v, v + 1, v + 2}, face));
    triangles.insert(all.back());
  }
  CHECK(triangles.boxes() <= 27 * all.size());
  for (const optimize::FreeTriangle& t : all) {
    std::multiset<int64_t> expected, found;
    for (const optimize::FreeTriangle& o : all)
      if (t.meets(o))
        expected.insert(o.face);
    triangles.any(t, [&](const optimize::FreeTriangle& o) {
      found.insert(o.face);
      return false;
    });
    CHECK(found == expected);
  }
}

TEST_CASE("triangles that run the same way and lie side by side do not cross") {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> u(0, 2), height(-0.2, 0.2);
  int parted = 0, crossing = 0;
  for (int n = 0; n < 20000; ++n) {
    std::vector<Vec3d> point;
    for (int k = 0; k < 6; ++k)
      point.push_back({u(generator), u(generator), height(generator)});
    std::array<int32_t, 3> v{0, 1, 2}, w{3, 4, 5};
    if (n % 2)
      w[0] = v[n / 2 % 3];
    const auto a = optimize::free_triangle(point, v, 0), b = optimize::free_triangle(point, w, 1);
    if (!a.runs_alike(b, n % 2))
      continue;
    const bool beside = optimize::side_by_side(point, a, b, optimize::Apart(v, w));
    const bool cross = triangles_cross(point, v, w);
    CHECK_FALSE((beside && cross));
    parted += beside;
    crossing += cross;
  }
  CHECK(parted > 1000);
  CHECK(crossing > 1000);
  // As they came out of 4V6X inside: normals 32 degrees from each other.
  const std::vector<Vec3d> point{{32.7405, 1.3404, -30.2465}, {32.6452, 1.3946, -30.2737},
                                 {32.6660, 1.2442, -30.2188}, {32.6788, 1.3481, -30.2564},
                                 {32.5362, 1.4793, -30.2835}, {32.6264, 1.3770, -30.2697}};
  const auto a = optimize::free_triangle(point, {0, 1, 2}, 0), b = optimize::free_triangle(point, {3, 4, 5}, 1);
  CHECK(a.runs_alike(b, false));
  CHECK(triangles_cross(point, a.v, b.v));
  CHECK_FALSE(optimize::side_by_side(point, a, b, optimize::Apart(a.v, b.v)));
}

namespace {

const Vec3d centre[] = {{3.1, 4.6, 4.4}, {6.6, 4.55, 4.45}};

// Spheres that overlap: either is the target of the points nearer to its centre.
struct Overlapping : Target {
  bool project(Vec3d& p, double reach) const override {
    double distance;
    Vec3d normal;
    probe(p, distance, normal);
    p += -distance * normal;
    return std::abs(distance) <= reach;
  }
  bool probe(Vec3d p, double& distance, Vec3d& normal) const override {
    const Vec3d c = norm2(p - centre[0]) < norm2(p - centre[1]) ? centre[0] : centre[1];
    distance = norm(p - c) - 1.9;
    normal = (p - c) / norm(p - c);
    return true;
  }
  double spacing() const override { return 0.5; }
};

} // namespace

TEST_CASE("surfaces that face each other nearby are watched, those with elements between them are not") {
  struct Case {
    double inner, outer; // radii of a ball and of the room that it is in
    double apart;        // that is looked within, in spacings
    bool shell, watched; // what is meshed: between the two, or the ball and what is around the room
  };
  const Case c = GENERATE(Case{2, 2.2, 0.5, false, true}, Case{2, 3.6, 0.5, false, false},
                          Case{2, 3.6, 3.5, false, true}, Case{3.3, 4.3, 2.3, true, false});
  CAPTURE(c.inner, c.outer, c.apart, c.shell);
  const Vec3d middle{5.03, 5.01, 4.98};
  const Field field = [&](Vec3d p) {
    const double r = norm(p - middle), in = c.inner - r, out = r - c.outer;
    return std::exp(c.shell ? -std::max(in, out) : std::max(in, out));
  };
  const TetMesh mesh = lattice_mesh(field, {0, 0, 0}, 0.5, 20, 1);
  optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  const Isosurface surface(lattice_grid(field, {0, 0, 0}, 0.5, 20), 1);
  optimize::Schedule schedule(m, &surface, 100, 1);
  CHECK(schedule.ends_in_surface());
  schedule.watch_crossings(c.apart);
  int64_t watched = 0, on_surface = 0;
  for (const optimize::Vertex& v : m.vertex) {
    watched += v.watched;
    on_surface += v.kind == optimize::Kind::surface;
  }
  REQUIRE(on_surface > 100);
  CHECK((c.watched ? 2 * watched > on_surface : watched == 0));
  schedule.watch_crossings(optimize::Schedule::everywhere);
  CHECK(std::count_if(m.vertex.begin(), m.vertex.end(), [](const optimize::Vertex& v) { return v.watched; }) >=
        on_surface);
}

TEST_CASE("surfaces further apart are watched when they are off the target, which brings them together") {
  const Vec3d middle{5.03, 5.01, 4.98};
  const auto between = [&](double inner, double outer) -> Field {
    return [=](Vec3d p) { return std::exp(std::max(inner - norm(p - middle), norm(p - middle) - outer)); };
  };
  const TetMesh mesh = lattice_mesh(between(2, 3.6), {0, 0, 0}, 0.5, 20, 1);
  for (const double off : {0., 0.6}) {
    const Isosurface surface(lattice_grid(between(2 + off, 3.6 - off), {0, 0, 0}, 0.5, 20), 1);
    optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
    optimize::Schedule schedule(m, &surface, 100, 1);
    schedule.watch_crossings(0.5);
    const auto watched =
        std::count_if(m.vertex.begin(), m.vertex.end(), [](const optimize::Vertex& v) { return v.watched; });
    const auto on_surface = std::count_if(m.vertex.begin(), m.vertex.end(), [](const optimize::Vertex& v) {
      return v.kind == optimize::Kind::surface;
    });
    CAPTURE(off, watched, on_surface);
    CHECK((off > 0 ? watched > 0.9 * double(on_surface) : watched == 0));
  }
}

TEST_CASE("two surfaces that are drawn through each other stop before they cross") {
  const Field balls = [](Vec3d p) {
    return std::exp(-0.8 * (std::min(norm2(p - centre[0]), norm2(p - centre[1])) - 1.6 * 1.6));
  };
  const TetMesh mesh = lattice_mesh(balls, {0, 0, 0}, 0.5, 20, 1);
  REQUIRE(find_crossings(mesh.point, mesh.tri, 1).pairs == 0);
  optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  const Overlapping target;
  optimize::Schedule schedule(m, &target, 100, 1);
  CHECK(schedule.project(1, {180, 1e3, 2, 0}).moves > 50);
  // Parts in which some did cross are put back and projected anew: nothing of the first time is left.
  for (const optimize::Element& e : m.element)
    if (e.alive())
      CHECK(e.q == Approx(m.quality(e.v)).epsilon(1e-5).margin(1e-7));
  const TetMesh moved = optimize::extract(m);
  CHECK(find_crossings(moved.point, moved.tri, 1).pairs == 0);
  double volume[2] = {};
  for (const TetMesh* x : {&mesh, &moved})
    for (const Tet& t : x->tet)
      volume[x == &moved] += tet_volume(x->point[t[0]], x->point[t[1]], x->point[t[2]], x->point[t[3]]);
  CHECK(volume[1] > 1.2 * volume[0]);
}

TEST_CASE("where surfaces cross, only points nearby are projected anew") {
  struct Counting : Overlapping {
    Vec3d apart{5.1, 8.3, 8.2}; // centre of a ball that meets none of these
    mutable int64_t asked_there = 0, asked = 0;
    bool is_there(Vec3d p) const { return norm(p - apart) < 1.6; }
    bool project(Vec3d& p, double reach) const override {
      ++(is_there(p) ? asked_there : asked);
      return Overlapping::project(p, reach);
    }
    bool probe(Vec3d p, double& distance, Vec3d& normal) const override {
      if (!is_there(p))
        return Overlapping::probe(p, distance, normal);
      distance = norm(p - apart) - 1.25;
      normal = (p - apart) / norm(p - apart);
      return true;
    }
  };
  const Counting target;
  const Field balls = [&](Vec3d p) {
    return std::exp(-0.8 * std::min(std::min(norm2(p - centre[0]), norm2(p - centre[1])) - 1.6 * 1.6,
                                    norm2(p - target.apart) - 1.1 * 1.1));
  };
  const TetMesh mesh = lattice_mesh(balls, {0, 0, 0}, 0.5, 20, 1);
  optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
  int64_t there = 0, points = 0;
  for (size_t v = 0; v < m.point.size(); ++v)
    if (m.vertex[v].kind == optimize::Kind::surface)
      ++(target.is_there(m.point[v]) ? there : points);
  REQUIRE(there > 50);
  optimize::Schedule schedule(m, &target, 100, 1);
  schedule.watch_crossings(optimize::Schedule::everywhere);
  schedule.project(1, {180, 1e3, 2, 0});
  CHECK(target.asked_there > 0.9 * double(there));
  CHECK(target.asked_there <= there);
  CHECK(target.asked > points); // some cross
  CHECK(double(target.asked) < 1.5 * double(points));
}

TEST_CASE("two surfaces in different parts that move towards each other in one pass do not cross") {
  const Field balls = [](Vec3d p) {
    return std::exp(-0.8 * (std::min(norm2(p - centre[0]), norm2(p - centre[1])) - 1.6 * 1.6));
  };
  const TetMesh mesh = lattice_mesh(balls, {0, 0, 0}, 0.5, 20, 1);
  const Overlapping target;
  Vec3d low{9, 9, 9}; // of the parts
  for (const Vec3d& p : mesh.point)
    for (int a = 0; a < 3; ++a)
      low[a] = std::min(low[a], p[a]);
  const double middle = (centre[0].x + centre[1].x) / 2;
  TetMesh first;
  for (const int threads : {1, 3}) {
    optimize::DynamicMesh m = optimize::build(mesh, 180, threads);
    optimize::Schedule schedule(m, &target, middle - low.x, threads);
    CHECK(schedule.project(1, {180, 1e3, 2, 0}).moves > 50);
    const TetMesh moved = optimize::extract(m);
    CHECK(find_crossings(moved.point, moved.tri, 1).pairs == 0);
    double near[2] = {9, 9}; // of either ball to the plane between the parts
    for (const Vec3d& p : moved.point)
      near[p.x > middle] = std::min(near[p.x > middle], std::abs(p.x - middle));
    CHECK(near[0] < 0.1);
    CHECK(near[1] < 0.1);
    if (threads == 1)
      first = moved;
    CHECK(moved.point == first.point);
  }
}

namespace {

// Draws the one vertex that begins there.
struct Draw : Target {
  Vec3d from, to;
  bool project(Vec3d& p, double) const override {
    const bool it = p == from;
    p = to;
    return it;
  }
  bool probe(Vec3d p, double& distance, Vec3d& normal) const override {
    distance = norm(p - to);
    normal = (p - to) / distance;
    return true;
  }
  double spacing() const override { return 0.5; }
};

} // namespace

TEST_CASE("a hole of four triangles is not turned inside out or closed, though none of them crosses another") {
  const Field ball = [](Vec3d p) { return std::exp(-0.8 * (norm2(p - Vec3d{4.9, 5.05, 5.1}) - 2.4 * 2.4)); };
  TetMesh full = lattice_mesh(ball, {0, 0, 0}, 0.5, 20, 1);
  const BlockGrid grid = lattice_grid(ball, {0, 0, 0}, 0.5, 20);
  optimize::improve(full, &grid, {}); // of a lattice, elements in a row block the way
  const optimize::DynamicMesh inner = optimize::build(full, 180, 1);
  const auto is_inner = [&](const Tet& t) {
    return std::all_of(t.begin(), t.end(),
                       [&](int32_t w) { return inner.vertex[w].kind == optimize::Kind::interior; });
  };
  const auto shared = [](const Tet& a, const Tet& b) {
    return std::count_if(a.begin(), a.end(),
                         [&](int32_t w) { return std::find(b.begin(), b.end(), w) != b.end(); });
  };
  const bool beside_another = GENERATE(false, true); // at one edge, which then has four triangles
  const double way = GENERATE(1.02, 0.99);           // to a little beyond the face on the other side, or before it
  int moved = 0;
  size_t tried = 0;
  for (size_t t = 0; t < full.tet.size() && tried < 100; ++t) {
    const Tet v = full.tet[t];
    std::vector<size_t> holes{t};
    for (size_t u = 0; beside_another && u < full.tet.size() && holes.size() < 2; ++u)
      if (shared(v, full.tet[u]) == 2 && is_inner(full.tet[u]))
        holes.push_back(u);
    if (!is_inner(v) || holes.size() < (beside_another ? 2 : 1))
      continue;
    ++tried;
    TetMesh mesh = full;
    size_t mover = tried % 4; // not on that edge: such vertices stay
    for (const size_t hole : holes) {
      const Tet w = full.tet[hole];
      while (hole != t && std::find(w.begin(), w.end(), v[mover]) != w.end())
        mover = (mover + 1) % 4;
      for (size_t f = 0; f < 4; ++f) {
        const auto out = optimize::outward_triangle(w, f);
        mesh.tri.push_back({out[0], out[2], out[1]});
        mesh.boundary.push_back(Boundary::surface);
      }
    }
    std::sort(holes.rbegin(), holes.rend());
    for (const size_t hole : holes) {
      mesh.tet.erase(mesh.tet.begin() + std::ptrdiff_t(hole));
      mesh.region.pop_back();
    }
    optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
    const auto p = [&](size_t k) { return m.point[v[k]]; };
    Draw target;
    target.from = p(mover);
    target.to = target.from + way * 4. / 3 * ((p(0) + p(1) + p(2) + p(3)) / 4. - target.from);
    optimize::Schedule schedule(m, &target, 100, 1);
    moved += schedule.project(1e-4f, {180, 1e3, 9, 0}).moves == 1;
    CHECK(tet_volume(p(0), p(1), p(2), p(3)) > 0);
    const Dihedrals angle = dihedrals(p(0), p(1), p(2), p(3));
    CHECK(*std::min_element(std::begin(angle.degree), std::end(angle.degree)) > 5.9);
  }
  CHECK(moved > 10);
}

TEST_CASE("a hole between two tips is not turned inside out, though none of its triangles crosses another") {
  const Field ball = [](Vec3d p) { return std::exp(-0.8 * (norm2(p - Vec3d{4.9, 5.05, 5.1}) - 2.4 * 2.4)); };
  TetMesh full = lattice_mesh(ball, {0, 0, 0}, 0.5, 20, 1);
  const BlockGrid grid = lattice_grid(ball, {0, 0, 0}, 0.5, 20);
  optimize::improve(full, &grid, {});
  const optimize::DynamicMesh inner = optimize::build(full, 180, 1);
  const auto place = [](const Tet& t, int32_t v) { return size_t(std::find(t.begin(), t.end(), v) - t.begin()); };
  const double way = GENERATE(1.6, 0.6); // to beyond the other tip, or before it
  int moved = 0, tried = 0;
  for (size_t t = 0; t < full.tet.size() && tried < 200; ++t) {
    const int32_t tip = full.tet[t][t % 4], other = full.tet[t][(t + 1) % 4];
    std::vector<size_t> hole; // the ring of the edge between them: two triangles of each element
    for (size_t u = 0; u < full.tet.size(); ++u)
      if (place(full.tet[u], tip) < 4 && place(full.tet[u], other) < 4)
        hole.push_back(u);
    const bool is_inner = std::all_of(hole.begin(), hole.end(), [&](size_t u) {
      return std::all_of(full.tet[u].begin(), full.tet[u].end(),
                         [&](int32_t w) { return inner.vertex[w].kind == optimize::Kind::interior; });
    });
    if (!is_inner || hole.size() > 5)
      continue;
    TetMesh mesh = full;
    const Vec3d middle = 0.5 * (full.point[tip] + full.point[other]),
                half = 0.12 * (full.point[tip] - full.point[other]);
    mesh.point[tip] = middle + half; // a flat hole
    mesh.point[other] = middle - half;
    for (const size_t u : hole)
      for (const int32_t v : {tip, other}) {
        const auto out = optimize::outward_triangle(full.tet[u], place(full.tet[u], v));
        mesh.tri.push_back({out[0], out[2], out[1]});
        mesh.boundary.push_back(Boundary::surface);
      }
    std::sort(hole.rbegin(), hole.rend());
    for (const size_t u : hole) {
      mesh.tet.erase(mesh.tet.begin() + std::ptrdiff_t(u));
      mesh.region.pop_back();
    }
    if (std::any_of(mesh.tet.begin(), mesh.tet.end(), [&](const Tet& e) {
          return tet_volume(mesh.point[e[0]], mesh.point[e[1]], mesh.point[e[2]], mesh.point[e[3]]) <= 0;
        }))
      continue;
    ++tried;
    optimize::DynamicMesh m = optimize::build(mesh, 180, 1);
    Draw target;
    target.from = m.point[tip];
    target.to = middle + (1 - 2 * way) * half;
    optimize::Schedule schedule(m, &target, 100, 1);
    moved += schedule.project(1e-6f, {180, 1e3, 9, 0}).moves == 1;
    double volume = 0;
    for (const size_t u : hole)
      volume += tet_volume(m.point[full.tet[u][0]], m.point[full.tet[u][1]], m.point[full.tet[u][2]],
                           m.point[full.tet[u][3]]);
    CAPTURE(hole.size());
    CHECK(volume > 0);
  }
  CHECK(tried > 50);
  CHECK(moved > (way < 1 ? 10 : -1));
}
