// dynamic_mesh.cpp — adjacency by buckets of faces, labels, kinds of vertices; and back to a plain mesh.
#include "improve/dynamic_mesh.hpp"
#include "error.hpp"
#include "geom/predicates.hpp" // exact sign of the volumes that come in
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace molmesh::improve {
namespace {

struct Face {
  int32_t middle, high; // its vertices but the lowest, which is the bucket
  int32_t slot;         // 4 element + face
  bool odd;             // sorting its outward order took an odd permutation
};

struct Sorted {
  std::array<int32_t, 3> v;
  bool odd;
};
Sorted sorted(int32_t a, int32_t b, int32_t c) {
  bool odd = false;
  if (a > b)
    std::swap(a, b), odd = !odd;
  if (b > c)
    std::swap(b, c), odd = !odd;
  if (a > b)
    std::swap(a, b), odd = !odd;
  return {{a, b, c}, odd};
}

struct Buckets {
  std::vector<int64_t> begin; // [vertices + 1]
  std::vector<Face> face;
};

Buckets bucket_faces(const LargeArray<Tet>& tets, size_t vertices) {
  Buckets b;
  b.begin.assign(vertices + 1, 0);
  const auto each = [&](auto&& f) {
    for (size_t t = 0; t < tets.size(); ++t)
      for (size_t i = 0; i < 4; ++i) {
        const auto& o = outward_face[i];
        const Sorted s = sorted(tets[t][size_t(o[0])], tets[t][size_t(o[1])], tets[t][size_t(o[2])]);
        f(s, static_cast<int32_t>(4 * t + i));
      }
  };
  each([&](const Sorted& s, int32_t) { ++b.begin[size_t(s.v[0])]; });
  par::exclusive_scan(b.begin);
  b.face.resize(4 * tets.size());
  std::vector<int64_t> next = b.begin;
  each([&](const Sorted& s, int32_t slot) {
    b.face[size_t(next[size_t(s.v[0])]++)] = {s.v[1], s.v[2], slot, s.odd};
  });
  return b;
}

std::string name(const char* what, int64_t i) {
  return std::string(what) + " " + std::to_string(i);
}

void link(DynamicMesh& m, const Buckets& b, int threads) {
  par::for_n(static_cast<int64_t>(m.point.size()), threads, [&](int64_t v) {
    const auto first = b.face.begin() + b.begin[size_t(v)], last = b.face.begin() + b.begin[size_t(v) + 1];
    for (auto f = first; f != last; ++f) {
      int others = 0;
      for (auto g = first; g != last; ++g) {
        if (g == f || g->middle != f->middle || g->high != f->high)
          continue;
        if (++others == 2)
          fail_input(name("tetrahedron", f->slot / 4) + " has a face shared by three, expected two at most");
        if (g->odd == f->odd)
          fail_input(name("tetrahedron", f->slot / 4) + " overlaps " + name("tetrahedron", g->slot / 4) +
                     ", expected one on each side of a face");
        m.element[size_t(f->slot / 4)].n[size_t(f->slot % 4)] = g->slot / 4;
      }
    }
  });
}

void set_labels(DynamicMesh& m, const Buckets& b, const TetMesh& mesh) {
  m.labels.assign(1, {});
  std::map<int32_t, uint8_t> index;
  std::vector<std::array<double, 3>> plane(1);
  for (size_t t = 0; t < mesh.tri.size(); ++t) {
    const auto [entry, fresh] = index.try_emplace(mesh.boundary[t], static_cast<uint8_t>(m.labels.size()));
    if (fresh) {
      if (m.labels.size() == 256)
        fail_input("more than 255 different boundary labels");
      m.labels.push_back({mesh.boundary[t], -1});
    }
    const Sorted s = sorted(mesh.tri[t][0], mesh.tri[t][1], mesh.tri[t][2]);
    int found = 0;
    for (int64_t f = b.begin[size_t(s.v[0])]; f < b.begin[size_t(s.v[0]) + 1]; ++f) {
      const Face& face = b.face[size_t(f)];
      if (face.middle != s.v[1] || face.high != s.v[2])
        continue;
      uint8_t& label = m.element[size_t(face.slot / 4)].label[size_t(face.slot % 4)];
      if (label != 0)
        fail_input(name("triangle", int64_t(t)) + " is a duplicate");
      label = entry->second;
      ++found;
      const int32_t other = m.element[size_t(face.slot / 4)].n[size_t(face.slot % 4)];
      if (fresh && (other < 0 || m.element[size_t(other)].region > m.element[size_t(face.slot / 4)].region))
        m.labels.back().reversed = face.odd != s.odd;
    }
    if (!found)
      fail_input(name("triangle", int64_t(t)) + " is no face of a tetrahedron");
  }
  for (size_t e = 0; e < m.element.size(); ++e)
    for (size_t i = 0; i < 4; ++i) {
      const Element& el = m.element[e];
      const bool border = el.n[i] < 0 || m.element[size_t(el.n[i])].region != el.region;
      if (border != (el.label[i] != 0))
        fail_input(name("tetrahedron", int64_t(e)) +
                   (border ? " has a face between regions or on the outside without a triangle"
                           : " has a triangle inside its region"));
    }
}

// A label is flat when all its triangles lie in one plane normal to an axis, up to rounding.
void find_flat_labels(DynamicMesh& m, const TetMesh& mesh) {
  std::vector<Vec3d> low(m.labels.size(), Vec3d{1e300, 1e300, 1e300}),
      high(m.labels.size(), Vec3d{-1e300, -1e300, -1e300});
  std::map<int32_t, size_t> index;
  for (size_t l = 1; l < m.labels.size(); ++l)
    index[m.labels[l].name] = l;
  for (size_t t = 0; t < mesh.tri.size(); ++t) {
    const size_t l = index[mesh.boundary[t]];
    for (const int32_t v : mesh.tri[t])
      for (int a = 0; a < 3; ++a) {
        low[l][a] = std::min(low[l][a], mesh.point[size_t(v)][a]);
        high[l][a] = std::max(high[l][a], mesh.point[size_t(v)][a]);
      }
  }
  for (size_t l = 1; l < m.labels.size(); ++l)
    for (int a = 0; a < 3; ++a)
      if (high[l][a] - low[l][a] <= 1e-12 * std::max(std::abs(low[l][a]), std::abs(high[l][a])))
        m.labels[l].axis = a;
}

// Sliding needs planes of distinct axes, surface one curved label that is a 2-manifold without sharp edges here.
void set_kinds(DynamicMesh& m, const TetMesh& mesh, double sharp) {
  std::vector<std::array<uint8_t, 3>> seen(m.point.size(), {0, 0, 0});
  std::vector<uint8_t> many(m.point.size(), 0);
  struct Edge {
    int32_t a, b;
    uint8_t label;
    int32_t tri;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.tri.size());
  std::map<int32_t, uint8_t> index;
  for (size_t l = 1; l < m.labels.size(); ++l)
    index[m.labels[l].name] = static_cast<uint8_t>(l);
  for (size_t t = 0; t < mesh.tri.size(); ++t) {
    const uint8_t label = index[mesh.boundary[t]];
    for (size_t i = 0; i < 3; ++i) {
      const int32_t v = mesh.tri[t][i], w = mesh.tri[t][(i + 1) % 3];
      auto& s = seen[size_t(v)];
      size_t k = 0;
      while (k < 3 && s[k] != 0 && s[k] != label)
        ++k;
      if (k == 3)
        many[size_t(v)] = 1;
      else
        s[k] = label;
      edges.push_back({std::min(v, w), std::max(v, w), label, static_cast<int32_t>(t)});
    }
  }
  for (size_t v = 0; v < m.point.size(); ++v) {
    Vertex& x = m.vertex[v];
    const auto& s = seen[v];
    if (s[0] == 0)
      continue;
    x = {Kind::fixed, 0, s[0]};
    if (many[v])
      continue;
    if (s[1] == 0 && m.labels[s[0]].curved())
      x.kind = Kind::surface;
    bool flat = true;
    int frozen = 0, planes = 0;
    for (const uint8_t l : s) {
      if (l == 0)
        continue;
      flat = flat && !m.labels[l].curved();
      if (flat)
        frozen |= 1 << m.labels[l].axis, ++planes;
    }
    const int bits = (frozen & 1) + (frozen >> 1 & 1) + (frozen >> 2 & 1);
    if (flat && bits == planes && bits < 3)
      x.kind = Kind::sliding, x.frozen = static_cast<uint8_t>(frozen);
  }
  const auto normal = [&](int32_t t) {
    const Tri& f = mesh.tri[size_t(t)];
    const Vec3d p = mesh.point[size_t(f[0])];
    const Vec3d n = cross(mesh.point[size_t(f[1])] - p, mesh.point[size_t(f[2])] - p);
    return n / std::max(norm(n), 1e-300);
  };
  const double limit = std::cos(sharp * 3.14159265358979323846 / 180);
  std::sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) {
    return x.a != y.a ? x.a < y.a : x.b != y.b ? x.b < y.b : x.tri < y.tri;
  });
  for (size_t i = 0, j; i < edges.size(); i = j) {
    for (j = i; j < edges.size() && edges[j].a == edges[i].a && edges[j].b == edges[i].b;)
      ++j;
    bool keep = j - i != 2;
    if (!keep && edges[i].label == edges[i + 1].label && m.labels[edges[i].label].curved())
      keep = dot(normal(edges[i].tri), normal(edges[i + 1].tri)) < limit;
    if (keep)
      m.vertex[size_t(edges[i].a)].kind = m.vertex[size_t(edges[i].b)].kind = Kind::fixed;
  }
}

} // namespace

DynamicMesh build(const TetMesh& mesh, double sharp, int threads) {
  DynamicMesh m;
  m.point = mesh.point;
  m.vertex.resize(m.point.size());
  m.incident.assign(m.point.size(), -1);
  m.touched.assign(m.point.size(), 0);
  m.element.resize(mesh.tet.size());
  for (size_t e = 0; e < mesh.tet.size(); ++e) {
    m.element[e].v = mesh.tet[e];
    m.element[e].region = mesh.region[e];
    for (const int32_t v : mesh.tet[e])
      m.incident[size_t(v)] = static_cast<int32_t>(e);
  }
  par::for_n(static_cast<int64_t>(mesh.tet.size()), threads, [&](int64_t e) {
    Element& el = m.element[size_t(e)];
    el.q = m.quality(el.v);
    const auto p = [&](size_t i) { return m.point[size_t(el.v[i])]; };
    if (el.q < 1e-6f && orient3d(p(0), p(1), p(2), p(3)) <= 0)
      fail_input(name("tetrahedron", e) + " has no positive volume");
    el.q = std::max(el.q, 0.f);
  });
  const Buckets b = bucket_faces(mesh.tet, m.point.size());
  link(m, b, threads);
  set_labels(m, b, mesh);
  find_flat_labels(m, mesh);
  set_kinds(m, mesh, sharp);
  return m;
}

TetMesh extract(const DynamicMesh& m) {
  TetMesh out;
  std::vector<int32_t> id(m.point.size(), -1);
  for (size_t v = 0; v < m.point.size(); ++v)
    if (m.incident[v] >= 0) {
      id[v] = static_cast<int32_t>(out.point.size());
      out.point.push_back(m.point[v]);
    }
  for (const Element& e : m.element) {
    if (!e.alive())
      continue;
    out.tet.push_back({id[size_t(e.v[0])], id[size_t(e.v[1])], id[size_t(e.v[2])], id[size_t(e.v[3])]});
    out.region.push_back(e.region);
    for (size_t i = 0; i < 4; ++i) {
      if (e.label[i] == 0 || (e.n[i] >= 0 && m.element[size_t(e.n[i])].region < e.region))
        continue;
      const auto& o = outward_face[i];
      Tri t{id[size_t(e.v[size_t(o[0])])], id[size_t(e.v[size_t(o[1])])], id[size_t(e.v[size_t(o[2])])]};
      if (m.labels[e.label[i]].reversed)
        std::swap(t[1], t[2]);
      out.tri.push_back(t);
      out.boundary.push_back(m.labels[e.label[i]].name);
    }
  }
  return out;
}

} // namespace molmesh::improve
