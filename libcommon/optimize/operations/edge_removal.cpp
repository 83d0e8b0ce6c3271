// edge_removal.cpp — an edge goes and its ring is filled anew: 3-2, 4-4, any ring, and flips of surface edges.
#include "optimize/operations/moving_vertex.hpp"
#include <array>

namespace molmesh::optimize {
namespace {

constexpr int longest = 8; // vertices of a chain: an edge with a longer ring rarely goes with profit

// Best triangulation of the polygon of a chain of vertices, by its worst element (Klincsek's recursion).
class Polygon {
public:
  template <class Judge>
  bool solve(int vertices, float above, Judge&& judge) {
    n_ = vertices;
    if (n_ > longest)
      return false;
    for (int span = 1; span < n_; ++span)
      for (int i = 0; i + span < n_; ++i) {
        const int j = i + span;
        Cell& c = cell(i, j);
        c = {span == 1 ? 2.f : -1.f, -1};
        for (int k = i + 1; k < j; ++k) {
          const float sides = std::min(cell(i, k).q, cell(k, j).q);
          if (sides <= above || sides <= c.q)
            continue;
          const float q = std::min(sides, judge(i, k, j, std::max(above, c.q)));
          if (q > c.q)
            c = {q, k};
        }
      }
    return cell(0, n_ - 1).q > above;
  }
  template <class F>
  void triangles(F&& f) {
    if (n_ > 2)
      walk(0, n_ - 1, f);
  }

private:
  struct Cell {
    float q;
    int k;
  };
  Cell& cell(int i, int j) { return cell_[i * longest + j]; }
  template <class F>
  void walk(int i, int j, F& f) {
    const int k = cell(i, j).k;
    if (k < 0)
      return;
    f(i, k, j);
    walk(i, k, f);
    walk(k, j, f);
  }
  std::array<Cell, longest * longest> cell_;
  int n_ = 0;
};

/// DynamicMesh::quality of both, side by side.
std::array<float, 2> qualities(const DynamicMesh& m, const std::array<std::array<int32_t, 4>, 2>& v) {
  using Two = double __attribute__((vector_size(16)));
  Corners<Two> corners;
  for (size_t i = 0; i < 4; ++i) {
    const Vec3d &p = m.point[v[0][i]], &q = m.point[v[1][i]];
    corners.x[i] = Two{p.x, q.x}, corners.y[i] = Two{p.y, q.y}, corners.z[i] = Two{p.z, q.z};
  }
  Two q;
  corners_quality(corners, q, shape_weight);
  return {static_cast<float>(q[0]), static_cast<float>(q[1])};
}

// Also where not all elements at a are of the part. The workspace's star becomes a's.
bool edge_is_labelled(Region& r, int32_t a, int32_t b) {
  if (!r.star(a, r.work.star))
    return true;
  for (const int32_t t : r.work.star) {
    const Element& e = r.mesh.element[t];
    const int i = e.find(a), j = e.find(b);
    if (j < 0)
      continue;
    for (int f = 0; f < 4; ++f)
      if (f != i && f != j && e.label[f] != 0)
        return true;
  }
  return false;
}

} // namespace

bool remove_edge(Region& r, const Acceptance& accept, int32_t e, int i, int j) {
  auto& [star, other_star, old, now, ring, elements, triangles] = r.work;
  const int32_t a = r.mesh.element[e].v[i], b = r.mesh.element[e].v[j];
  if (!r.ring(e, a, b, ring))
    return false;
  const int m = static_cast<int>(ring.vertex.size());
  const bool surface = !ring.border.empty();
  if (surface && (ring.border.size() != 2 || ring.label[0] != ring.label[1]))
    return false;
  if (!surface && (m < 3 || m > longest))
    return false;
  const float above = accept.demand(r.worst(ring.element));
  const auto vertex = [&](int k) { return r.work.ring.vertex[k % m]; };
  const auto element = [&](int k) -> const Element& { return r.mesh.element[r.work.ring.element[k % m]]; };
  const auto pair_of = [&](int first, int x, int y, int z) {
    return std::array<std::array<int32_t, 4>, 2>{{{vertex(first + x), vertex(first + y), vertex(first + z), b},
                                                  {vertex(first + x), vertex(first + z), vertex(first + y), a}}};
  };
  // One polygon, or one on each side of the surface.
  const int s = surface ? ring.border[0] : 0, t = surface ? ring.border[1] : m - 1;
  const int sides = surface && ring.closed ? 2 : 1;
  const int first[2] = {s, t}, vertices[2] = {t - s + 1, s + m - t + 1};
  std::array<Polygon, 2> polygon;
  now.clear();
  for (int side = 0; side < sides; ++side) {
    const int f = first[side];
    if (!polygon[side].solve(vertices[side], above, [&](int x, int y, int z, float floor) {
          const auto pair = pair_of(f, x, y, z);
          const auto q = qualities(r.mesh, pair);
          for (size_t k = 0; k < 2; ++k)
            if (!r.is_above({pair[k], 0, q[k], {}}, floor))
              return -1.f;
          return std::min(q[0], q[1]);
        }))
      return false;
    const int32_t region = element(f).region;
    polygon[side].triangles([&](int x, int y, int z) {
      for (const auto& v : pair_of(f, x, y, z))
        r.work.now.push_back({v, region, r.mesh.quality(v), {}});
    });
  }
  if (surface) {
    const uint8_t l = ring.label[0];
    const Label& label = r.mesh.labels[l];
    const int32_t vs = vertex(s), vt = vertex(t);
    const Element &after = element(s), &before = element(t - 1);
    const size_t face_s = size_t(after.find(vertex(s + 1))), face_t = size_t(before.find(vertex(t - 1)));
    if (label.curved()) {
      if (!r.target)
        return false;
      Fit old_fit, fit;
      old_fit.add(misfit_of(r, accept, after, face_s));
      old_fit.add(misfit_of(r, accept, before, face_t));
      const auto p = [&](int32_t v) { return r.mesh.point[v]; };
      const bool out = r.mesh.outward(after, face_s);
      fit.add(out ? misfit_of(r, accept, l, p(vs), p(b), p(vt)) : misfit_of(r, accept, l, p(vt), p(b), p(vs)));
      fit.add(out ? misfit_of(r, accept, l, p(vs), p(vt), p(a)) : misfit_of(r, accept, l, p(vt), p(vs), p(a)));
      if (!accept.fits(fit, old_fit))
        return false;
    }
    // Where one side has a single element it goes altogether: its other faces must be free to take the label.
    for (int side = 0; side < sides; ++side)
      if (vertices[side] == 2) {
        const Element& flat = element(first[side]);
        const size_t fa = size_t(flat.find(a)), fb = size_t(flat.find(b));
        if (flat.label[fa] != 0 || flat.label[fb] != 0 || flat.n[fa] < 0 || flat.n[fb] < 0)
          return false;
      }
    if (edge_is_labelled(r, vs, vt))
      return false;
    if (!ring.closed && m > 2) // an edge on the outside must be new
      for (const int32_t x : star)
        if (r.mesh.element[x].find(vt) >= 0)
          return false;
  }
  if (!r.has_room(ring.element.size(), now.size()) || deficit_of(accept, now) > deficit_of(r, accept, ring.element))
    return false;
  old = ring.element;
  if (!r.exchange(old, now, surface))
    return false;
  return r.done(surface ? &Counts::surface_flips : &Counts::edge_removals, "edge removal");
}

} // namespace molmesh::optimize
