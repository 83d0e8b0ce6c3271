// flips.cpp — edges and faces go: edge removal (3-2, 4-4, any ring), surface flips with it, 2-3 swaps.
#include "optimize/operations/editor.hpp"
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

} // namespace

bool Editor::edge_is_labelled(int32_t a, int32_t b) {
  if (!star(a, star_))
    return true;
  for (const int32_t t : star_) {
    const Element& e = m_.element[t];
    const int i = e.find(a), j = e.find(b);
    if (j < 0)
      continue;
    for (int f = 0; f < 4; ++f)
      if (f != i && f != j && e.label[f] != 0)
        return true;
  }
  return false;
}

bool Editor::remove_edge(int32_t e, int i, int j) {
  const int32_t a = m_.element[e].v[i], b = m_.element[e].v[j];
  if (!ring(e, a, b, ring_))
    return false;
  const int m = static_cast<int>(ring_.vertex.size());
  const bool surface = !ring_.border.empty();
  if (surface && (ring_.border.size() != 2 || ring_.label[0] != ring_.label[1]))
    return false;
  if (!surface && (m < 3 || m > longest))
    return false;
  const float above = demand(worst(ring_.element));
  const auto vertex = [&](int k) { return ring_.vertex[k % m]; };
  const auto element = [&](int k) -> const Element& { return m_.element[ring_.element[k % m]]; };
  const auto pair_of = [&](int first, int x, int y, int z) {
    return std::array<std::array<int32_t, 4>, 2>{{{vertex(first + x), vertex(first + y), vertex(first + z), b},
                                                  {vertex(first + x), vertex(first + z), vertex(first + y), a}}};
  };
  // One polygon, or one on each side of the surface.
  const int s = surface ? ring_.border[0] : 0, t = surface ? ring_.border[1] : m - 1;
  const int sides = surface && ring_.closed ? 2 : 1;
  const int first[2] = {s, t}, vertices[2] = {t - s + 1, s + m - t + 1};
  std::array<Polygon, 2> polygon;
  now_.clear();
  for (int side = 0; side < sides; ++side) {
    const int f = first[side];
    if (!polygon[side].solve(vertices[side], above, [&](int x, int y, int z, float floor) {
          const auto pair = pair_of(f, x, y, z);
          const auto q = qualities(m_, pair);
          for (size_t k = 0; k < 2; ++k)
            if (!is_above({pair[k], 0, q[k], {}}, floor))
              return -1.f;
          return std::min(q[0], q[1]);
        }))
      return false;
    const int32_t region = element(f).region;
    polygon[side].triangles([&](int x, int y, int z) {
      for (const auto& v : pair_of(f, x, y, z))
        now_.push_back({v, region, m_.quality(v), {}});
    });
  }
  if (surface) {
    const Label& label = m_.labels[ring_.label[0]];
    const int32_t vs = vertex(s), vt = vertex(t);
    const Element &after = element(s), &before = element(t - 1);
    const size_t face_s = size_t(after.find(vertex(s + 1))), face_t = size_t(before.find(vertex(t - 1)));
    if (label.curved()) {
      if (!target_)
        return false;
      Fit old_fit, fit;
      old_fit.add(misfit_face(after, face_s));
      old_fit.add(misfit_face(before, face_t));
      const auto p = [&](int32_t v) { return m_.point[v]; };
      const bool out = m_.outward(after, face_s);
      fit.add(out ? misfit(p(vs), p(b), p(vt)) : misfit(p(vt), p(b), p(vs)));
      fit.add(out ? misfit(p(vs), p(vt), p(a)) : misfit(p(vt), p(vs), p(a)));
      if (!fits(fit, old_fit))
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
    if (edge_is_labelled(vs, vt))
      return false;
    if (!ring_.closed && m > 2) // an edge on the outside must be new
      for (const int32_t x : star_)
        if (m_.element[x].find(vt) >= 0)
          return false;
  }
  if (!has_room(ring_.element.size(), now_.size()) || lack(now_) > lack(ring_.element))
    return false;
  old_ = ring_.element;
  clear_rim();
  if (!replace(old_, now_, surface))
    return false;
  ++(surface ? counts.surface_flips : counts.edge_removals);
  return true;
}

bool Editor::swap_face(int32_t e, int i) {
  const Element& el = m_.element[e];
  const int32_t n = el.n[i];
  if (n < 0 || el.label[i] != 0 || !owned(e) || !owned(n))
    return false;
  const Element& other = m_.element[n];
  const int32_t a = el.v[i];
  int32_t b = -1;
  for (size_t k = 0; k < 4; ++k)
    if (other.n[k] == e)
      b = other.v[k];
  const float above = demand(std::min(el.q, other.q));
  now_.clear();
  const auto face = outward_triangle(el.v, size_t(i));
  for (size_t k = 0; k < 3; ++k) {
    Candidate c{{a, b, face[k], face[(k + 1) % 3]}, el.region, 0, {}};
    if (!judge(c, above))
      return false;
    now_.push_back(c);
  }
  old_ = {e, n};
  if (!has_room(2, 3) || lack(now_) > lack(old_))
    return false;
  clear_rim();
  if (!replace(old_, now_, false))
    return false;
  ++counts.face_swaps;
  return true;
}

} // namespace molmesh::optimize
