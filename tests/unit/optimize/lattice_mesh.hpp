// lattice_mesh.hpp — a dual-contouring mesh of a field on a cubic lattice, slow and plain: what tetsmooth gets in
// practice. Both regions in a box, the field's grid with it. No ambiguous cells are treated: choose fields without.
#pragma once
#include "grid/block_grid.hpp"
#include "mesh/tet_mesh.hpp"
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <stdexcept>

namespace molmesh::test {

using Field = std::function<double(Vec3d)>; // G, isovalue 1

inline double volume6(Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
  return dot(cross(b - a, c - a), d - a);
}

/// Grid points (i, j, k), 0 ≤ i, j, k ≤ n, at h·(i, j, k) + origin; active are the corners of cells that meet the
/// band.
inline BlockGrid lattice_grid(const Field& field, Vec3d origin, double h, int n) {
  BlockGrid g;
  g.frame = {origin, h, {0, 0, 0}, {n + 1, n + 1, n + 1}};
  std::map<Vec3i, float> active;
  const auto at = [&](Vec3i p) { return static_cast<float>(field(g.frame.position(p))); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        float low = 1e30f, high = 0;
        for (int c = 0; c < 8; ++c) {
          const float v = at(Vec3i{i, j, k} + Vec3i{c >> 2, c >> 1 & 1, c & 1});
          low = std::min(low, v);
          high = std::max(high, v);
        }
        if (high < 0.9f || low > 1.1f)
          continue;
        for (int c = 0; c < 8; ++c) {
          const Vec3i p = Vec3i{i, j, k} + Vec3i{c >> 2, c >> 1 & 1, c & 1};
          active[p] = at(p);
        }
      }
  std::set<Vec3i> corners;
  for (const auto& [p, v] : active)
    corners.insert(block_corner(p));
  g.corner.assign(corners.begin(), corners.end());
  g.value.assign(512 * g.corner.size(), 0);
  g.active.assign(8 * g.corner.size(), 0);
  const BlockIndex index(g);
  for (size_t b = 0; b < g.corner.size(); ++b)
    for (int s = 0; s < 512; ++s) {
      const Vec3i p = g.corner[b] + within_block(s);
      const auto a = active.find(p);
      if (a != active.end()) {
        g.value[512 * b + size_t(s)] = a->second;
        g.active[8 * b + size_t(s >> 6)] |= uint64_t{1} << (s & 63);
      } else {
        g.value[512 * b + size_t(s)] = at(p) > 1 ? 2.f : 0.f;
      }
    }
  return g;
}

/// Regions: 1 inside, 2 outside; `keep`: 0 both, 1 or 2 that one alone.
inline TetMesh lattice_mesh(const Field& field, Vec3d origin, double h, int n, int keep = 0) {
  TetMesh mesh;
  const auto position = [&](Vec3i p) { return origin + h * to_double(p); };
  std::map<Vec3i, double> value;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j)
      for (int k = 0; k <= n; ++k)
        value[{i, j, k}] = std::log(double(float(field(position({i, j, k})))));
  const auto inside = [&](Vec3i p) { return value.at(p) > 0; };
  const auto crossing = [&](Vec3i p, Vec3i q) {
    const double a = value.at(p), b = value.at(q);
    return position(p) + a / (a - b) * (position(q) - position(p));
  };
  std::map<Vec3i, int32_t> grid_id, dual_id;
  const auto grid_vertex = [&](Vec3i p) {
    const auto [e, fresh] = grid_id.try_emplace(p, static_cast<int32_t>(mesh.point.size()));
    if (fresh)
      mesh.point.push_back(position(p));
    return e->second;
  };
  const auto dual_vertex = [&](Vec3i c) {
    const auto [e, fresh] = dual_id.try_emplace(c, static_cast<int32_t>(mesh.point.size()));
    if (!fresh)
      return e->second;
    Vec3d sum;
    int count = 0;
    for (int a = 0; a < 3; ++a)
      for (int k = 0; k < 4; ++k) {
        Vec3i p = c, step{};
        p[(a + 1) % 3] += k >> 1;
        p[(a + 2) % 3] += k & 1;
        step[a] = 1;
        if (inside(p) != inside(p + step))
          sum += crossing(p, p + step), ++count;
      }
    mesh.point.push_back(count ? sum / double(count) : position(c) + Vec3d{h / 2, h / 2, h / 2});
    return e->second;
  };
  const auto add = [&](Vec3i owner, int32_t a, int32_t b, int32_t c, int32_t d) {
    const int region = inside(owner) ? 1 : 2;
    if (keep != 0 && region != keep)
      return;
    if (volume6(mesh.point[a], mesh.point[b], mesh.point[c], mesh.point[d]) < 0)
      std::swap(c, d);
    mesh.tet.push_back({a, b, c, d});
    mesh.region.push_back(region);
  };
  const auto vol = [&](int32_t a, int32_t b, int32_t c, int32_t d) {
    return volume6(mesh.point[a], mesh.point[b], mesh.point[c], mesh.point[d]);
  };
  for (int i = 1; i < n; ++i)
    for (int j = 1; j < n; ++j)
      for (int k = 1; k < n; ++k)
        for (int a = 0; a < 3; ++a)
          for (int sign = -1; sign <= 1; sign += 2) {
            const Vec3i p{i, j, k};
            Vec3i q = p, low = p;
            q[a] += sign;
            if (sign < 0)
              low = q;
            const bool wall = q[a] < 1 || q[a] >= n;
            const bool surface = !wall && inside(p) != inside(q);
            if (!wall && sign < 0)
              continue;
            int32_t d[4]; // counter-clockwise around +a
            for (int s = 0; s < 4; ++s) {
              Vec3i c = low;
              c[(a + 1) % 3] -= s == 1 || s == 2;
              c[(a + 2) % 3] -= s >= 2;
              d[s] = dual_vertex(c);
            }
            const int32_t vp = grid_vertex(p);
            if (!wall && !surface) {
              for (int s = 0; s < 4; ++s)
                add(p, vp, grid_vertex(q), d[s], d[(s + 1) % 4]);
              continue;
            }
            if (wall) {
              add(p, vp, d[0], d[1], d[2]);
              add(p, vp, d[0], d[2], d[3]);
              continue;
            }
            const int32_t vq = grid_vertex(q);
            bool done = false;
            for (int s = 0; s < 2 && !done; ++s) {
              const int32_t w[4] = {d[s], d[s + 1], d[(s + 2) % 4], d[(s + 3) % 4]};
              if (!(vol(vp, w[0], w[1], w[2]) > 1e-9 && vol(vp, w[0], w[2], w[3]) > 1e-9))
                continue;
              if (!(vol(vq, w[0], w[2], w[1]) > 1e-9 && vol(vq, w[0], w[3], w[2]) > 1e-9))
                continue;
              add(p, vp, w[0], w[1], w[2]);
              add(p, vp, w[0], w[2], w[3]);
              add(q, vq, w[0], w[2], w[1]);
              add(q, vq, w[0], w[3], w[2]);
              done = true;
            }
            if (done)
              continue;
            const auto m = static_cast<int32_t>(mesh.point.size());
            mesh.point.push_back(crossing(p, q));
            for (int s = 0; s < 4; ++s) {
              add(p, vp, m, d[s], d[(s + 1) % 4]);
              add(q, vq, m, d[s], d[(s + 1) % 4]);
            }
          }
  // Triangles: faces between regions and faces with one element; the walls by their plane.
  static constexpr int face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  std::map<Tri, std::vector<std::pair<size_t, int>>> faces;
  for (size_t t = 0; t < mesh.tet.size(); ++t)
    for (int f = 0; f < 4; ++f) {
      Tri key{mesh.tet[t][face[f][0]], mesh.tet[t][face[f][1]], mesh.tet[t][face[f][2]]};
      std::sort(key.begin(), key.end());
      faces[key].push_back({t, f});
    }
  const Vec3d low = origin + Vec3d{h / 2, h / 2, h / 2}, high = origin + (n - 0.5) * Vec3d{h, h, h};
  for (const auto& [key, at] : faces) {
    if (at.size() == 2 && mesh.region[at[0].first] == mesh.region[at[1].first])
      continue;
    size_t s = 0;
    if (at.size() == 2 && mesh.region[at[1].first] < mesh.region[at[0].first])
      s = 1;
    const Tet& t = mesh.tet[at[s].first];
    const int* o = face[at[s].second];
    Tri tri{t[o[0]], t[o[1]], t[o[2]]};
    int label = surface;
    if (at.size() == 1)
      for (int a = 0; a < 3; ++a)
        for (int side = 0; side < 2; ++side) {
          const double wall = side ? high[a] : low[a];
          bool on = true;
          for (const int32_t v : tri)
            on = on && std::abs(mesh.point[v][a] - wall) < 1e-9;
          if (on)
            label = 2 + 2 * a + side;
        }
    if (label == surface && mesh.region[at[s].first] == 2)
      std::swap(tri[1], tri[2]);
    mesh.tri.push_back(tri);
    mesh.boundary.push_back(label);
  }
  // Unused vertices of a region left out go.
  std::vector<int32_t> id(mesh.point.size(), -1);
  std::vector<Vec3d> used;
  for (Tet& t : mesh.tet)
    for (int32_t& v : t) {
      if (id[v] < 0)
        id[v] = static_cast<int32_t>(used.size()), used.push_back(mesh.point[v]);
      v = id[v];
    }
  for (Tri& t : mesh.tri)
    for (int32_t& v : t)
      v = id[v];
  mesh.point = used;
  return mesh;
}

/// G = Σ exp(-0.3 (|x - c|² - r²)): three atoms that overlap, no ambiguous cells at h = 0.5 Å.
inline double three_atoms(Vec3d p) {
  const Vec3d centre[] = {{4.1, 4.2, 4.3}, {5.6, 4.9, 4.0}, {5.2, 6.1, 5.5}};
  double sum = 1e-30;
  for (const Vec3d& c : centre)
    sum += std::exp(-0.3 * (norm2(p - c) - 1.7 * 1.7));
  return sum;
}

} // namespace molmesh::test
