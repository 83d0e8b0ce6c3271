// mesh_code_test.cpp — the code of a mesh is read back by the rules of HTML.md, step by step.
#include "../mesh/meshes.hpp"
#include "formats/html/mesh_code.hpp"
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

using namespace molmesh;
using namespace molmesh::formats;

namespace {

struct Reader {
  std::string bytes;
  size_t at = 0;
  uint64_t next() {
    uint64_t v = 0;
    for (int shift = 0;; shift += 7) {
      const auto b = static_cast<unsigned char>(bytes.at(at++));
      v |= uint64_t{b & 127u} << shift;
      if (b < 128)
        return v;
    }
  }
  int64_t next_signed() {
    const uint64_t v = next();
    return v % 2 ? -int64_t(v / 2) - 1 : int64_t(v / 2);
  }
};

struct Read {
  std::vector<Vec3d> point;
  std::vector<Tet> tet;
  std::vector<int32_t> body;
  std::vector<std::array<int64_t, 2>> triangle;                ///< face, body on the other side or -1
  std::map<std::string, std::vector<int64_t>> tets, triangles; ///< labels
};

/// Lists instead of rings, and no arithmetic on indices: slow and plain.
Read read_back(const MeshCode& code) {
  std::map<std::string, Reader> s;
  for (const CodeStream& c : code.stream)
    s[c.name].bytes = c.bytes;
  Read r;
  std::vector<std::array<int64_t, 3>> grid;
  std::vector<std::vector<int32_t>> recent; // newest first, 16 at most
  std::vector<int64_t> parent;
  std::array<int64_t, 3> last{};
  const auto corner = [&](const int32_t* near) -> int32_t {
    const auto sign = static_cast<unsigned char>(s["corners"].bytes.at(s["corners"].at++));
    if (sign == 49)
      return int32_t(grid.size()) - int32_t(s["far"].next());
    if (sign > 0)
      return recent.at(size_t(near[(sign - 1) % 3])).at(size_t((sign - 1) / 3));
    std::array<int64_t, 3> predicted = last;
    for (size_t k = 0; near && k < 3; ++k) {
      const int64_t sum = 2 * (grid[near[0]][k] + grid[near[1]][k] + grid[near[2]][k]);
      predicted[k] = int64_t(std::floor(double(sum) / 3)) - grid[near[3]][k];
    }
    for (size_t k = 0; k < 3; ++k) {
      const std::string axis(1, "xyz"[k]);
      const uint64_t low = static_cast<unsigned char>(s["low_" + axis].bytes.at(s["low_" + axis].at++));
      const uint64_t z = s["high_" + axis].next() * 256 + low;
      predicted[k] += z % 2 ? -int64_t(z / 2) - 1 : int64_t(z / 2);
    }
    last = predicted;
    grid.push_back(last);
    recent.push_back({});
    r.point.push_back({code.origin.x + code.quantum * double(last[0]),
                       code.origin.y + code.quantum * double(last[1]),
                       code.origin.z + code.quantum * double(last[2])});
    return int32_t(grid.size()) - 1;
  };
  const auto join = [&](int32_t a, int32_t b) {
    for (int turn = 0; turn < 2; ++turn, std::swap(a, b)) {
      auto& list = recent[size_t(a)];
      if (std::find(list.begin(), list.end(), b) != list.end())
        continue;
      list.insert(list.begin(), b);
      if (list.size() > 16)
        list.pop_back();
    }
  };
  for (int64_t next = 0; next < code.tets; ++next) {
    if (next == int64_t(r.tet.size())) {
      Tet t{};
      for (int32_t& v : t)
        v = corner(nullptr);
      for (int e = 0; e < 6; ++e)
        join(t[size_t(tet_edge(e, 0))], t[size_t(tet_edge(e, 1))]);
      r.tet.push_back(t);
      parent.push_back(-1);
    }
    const auto mask = static_cast<unsigned char>(s["faces"].bytes.at(size_t(next)));
    for (int f = 0; f < 4; ++f)
      if (mask >> f & 1) {
        const Tet c = r.tet[size_t(next)];
        const int32_t near[4] = {c[size_t(tet_face(f, 0))], c[size_t(tet_face(f, 1))], c[size_t(tet_face(f, 2))],
                                 c[size_t(f)]};
        const int32_t v = corner(near);
        for (size_t k = 0; k < 3; ++k)
          join(v, near[k]);
        r.tet.push_back({near[0], near[1], near[2], v});
        parent.push_back(next);
      }
  }
  for (size_t b = 0; b < code.body_tets.size(); ++b)
    r.body.insert(r.body.end(), size_t(code.body_tets[b]), int32_t(b));
  Reader &faces = s["triangles"], &others = s["others"];
  for (int64_t face = 0; faces.at < faces.bytes.size();) {
    face += int64_t(faces.next());
    r.triangle.push_back({face, int64_t(others.next()) - 1});
  }
  for (const CodeStream& c : code.stream) {
    if (c.name.rfind("tets ", 0) == 0) {
      auto& values = r.tets[c.name.substr(5)];
      for (size_t k = 0; k < r.tet.size(); ++k)
        values.push_back(s[c.name].next_signed() + (parent[k] >= 0 ? values[size_t(parent[k])] : 0));
    }
    if (c.name.rfind("triangles ", 0) == 0) {
      const std::string label = c.name.substr(10);
      for (const auto& t : r.triangle)
        r.triangles[label].push_back(s[c.name].next_signed() +
                                     (r.tets.count(label) > 0 ? r.tets[label][size_t(t[0] / 4)] : 0));
    }
  }
  for (const auto& [name, reader] : s)
    if (name == "corners" || name == "far" || name.rfind("low", 0) == 0 || name.rfind("high", 0) == 0) {
      INFO(name);
      CHECK(reader.at == reader.bytes.size());
    }
  return r;
}

TetMesh mesh_with_bodies() {
  TetMesh m = testing::cubes(6,
                             [](Vec3i c) {
                               if (c == Vec3i{2, 2, 2})
                                 return 3;
                               return c.x >= 1 && c.x <= 3 && c.y >= 1 && c.y <= 3 && c.z >= 1 && c.z <= 3 ? 1
                                      : c == Vec3i{5, 5, 5}                                                ? 1
                                                                                                           : 2;
                             },
                             0.7, {-3, 11, 0.25});
  for (size_t i = 0; i < m.point.size(); ++i) // no two alike
    m.point[i] +=
        Vec3d{0.1 * std::sin(double(7 * i)), 0.1 * std::cos(double(5 * i)), 0.1 * std::sin(double(3 * i))};
  return m;
}

void compare(const TetMesh& m, const std::vector<uint8_t>& keep) {
  const TriangleSides sides = triangle_sides(m, 1);
  const MeshBodies bodies = find_bodies(m, sides.across);
  CellLabel label{"chain", {"A", "B", "C", "D"}, {}, {}},
      only{"boundary", {"a", "b", "c", "d", "e", "f", "g"}, {}, {}}, part{"part", {}, {}, {}};
  for (size_t t = 0; t < m.tet.size(); ++t) {
    label.tet.push_back(m.region[t] == 2 ? -1 : int32_t(t / 50 % 4));
    part.tet.push_back(int32_t(t / 300));
  }
  for (size_t i = 0; i < m.tri.size(); ++i) {
    label.tri.push_back(int32_t(i % 5) - 1);
    only.tri.push_back(m.boundary[i] - 1);
  }
  const MeshCode code = encode_mesh(m, sides, bodies, keep, {only, part, label});
  const Read r = read_back(code);

  const auto kept = int64_t(keep.empty() ? m.tet.size() : size_t(std::count(keep.begin(), keep.end(), 1)));
  CHECK(code.tets == kept);
  CHECK(int64_t(r.tet.size()) == kept);
  CHECK(int64_t(r.point.size()) == code.points);
  CHECK(code.quantum <= 0.7 / 128);
  const auto key = [](std::vector<Vec3d> p) {
    std::sort(p.begin(), p.end());
    std::vector<int64_t> k;
    for (const Vec3d& v : p)
      for (int axis = 0; axis < 3; ++axis)
        k.push_back(std::llround(v[axis] * 20));
    return k;
  };
  std::set<int32_t> points;
  for (size_t t = 0; t < m.tet.size(); ++t) {
    const bool is_kept = keep.empty() || keep[t];
    REQUIRE((code.place[t] >= 0) == is_kept);
    if (!is_kept)
      continue;
    const size_t at = size_t(code.place[t]);
    points.insert(m.tet[t].begin(), m.tet[t].end());
    // The same corners, in an even permutation, within half a quantum.
    Vec3d own[4], read[4];
    for (size_t i = 0; i < 4; ++i)
      own[i] = m.point[m.tet[t][i]], read[i] = r.point[r.tet[at][i]];
    for (const Vec3d& p : own) {
      double nearest = 1e9;
      for (const Vec3d& q : read)
        nearest = std::min(nearest, std::max({std::fabs(p.x - q.x), std::fabs(p.y - q.y), std::fabs(p.z - q.z)}));
      CHECK(nearest <= code.quantum * 0.5000001);
    }
    CHECK(tet_volume(read[0], read[1], read[2], read[3]) > 0);
    CHECK(r.body[at] == bodies.of[t]);
    CHECK(r.tets.at("chain")[at] == label.tet[t]);
    CHECK(r.tets.at("part")[at] == part.tet[t]);
  }
  CHECK(int64_t(points.size()) == code.points);

  REQUIRE(r.triangle.size() == m.tri.size());
  std::map<std::vector<int64_t>, size_t> read_triangles;
  for (size_t i = 0; i < r.triangle.size(); ++i) {
    const Tet& t = r.tet[size_t(r.triangle[i][0] / 4)];
    const int f = int(r.triangle[i][0] % 4);
    read_triangles[key({r.point[t[size_t(tet_face(f, 0))]], r.point[t[size_t(tet_face(f, 1))]],
                        r.point[t[size_t(tet_face(f, 2))]]})] = i;
  }
  CHECK(read_triangles.size() == m.tri.size());
  size_t found = 0;
  for (size_t i = 0; i < m.tri.size(); ++i) {
    // By the rounded points of the mesh itself, so that keys are the same.
    std::vector<Vec3d> p;
    for (const int32_t v : m.tri[i]) {
      const Vec3d q = (m.point[v] - code.origin) / code.quantum;
      p.push_back(code.origin + code.quantum * Vec3d{double(std::llround(q.x)), double(std::llround(q.y)),
                                                     double(std::llround(q.z))});
    }
    const auto at = read_triangles.find(key(p));
    REQUIRE(at != read_triangles.end());
    ++found;
    CHECK(r.triangles.at("chain")[at->second] == label.tri[i]);
    CHECK(r.triangles.at("boundary")[at->second] == only.tri[i]);
    std::multiset<int64_t> beside{r.body[size_t(r.triangle[at->second][0] / 4)], r.triangle[at->second][1]},
        expected;
    for (const int32_t f : sides.face[i])
      expected.insert(f < 0 ? -1 : bodies.of[f / 4]);
    CHECK(beside == expected);
  }
  CHECK(found == m.tri.size());
  const MeshCode again = encode_mesh(m, sides, bodies, keep, {only, part, label});
  for (size_t i = 0; i < code.stream.size(); ++i)
    CHECK(code.stream[i].bytes == again.stream[i].bytes);
}

} // namespace

TEST_CASE("the code of a mesh gives back its tetrahedra, triangles, bodies and labels") {
  compare(mesh_with_bodies(), {});
}

TEST_CASE("the code of parts of a mesh gives back those parts") {
  const TetMesh m = mesh_with_bodies();
  const TriangleSides sides = triangle_sides(m, 1);
  std::vector<uint8_t> keep(m.tet.size(), 0);
  for (const auto& side : sides.face)
    for (const int32_t f : side)
      if (f >= 0)
        keep[f / 4] = 1;
  CHECK(std::count(keep.begin(), keep.end(), 0) > 100);
  compare(m, keep);
  for (size_t t = 0; t < keep.size(); t += 3)
    keep[t] = 1;
  compare(m, keep);
}
