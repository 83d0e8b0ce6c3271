// edge_contraction.cpp — an edge shrinks to one of its ends; surfaces and walls keep their shape and topology.
#include "optimize/acceptance/sag.hpp"
#include "optimize/operations/moving_vertex.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::optimize {
namespace {

// For a vertex a on a labelled face: a and b have no neighbours in common but the ring's, on the surface none but
// its two ends, and no triangle over an edge of both links but the ring's (Dey, Edelsbrunner, Guha and Nekhayev
// 1999). Needs the
// stars of a and b in the workspace.
bool link_holds(const Region& r, int32_t a, int32_t b) {
  const Ring& ring = r.work.ring;
  const std::vector<int32_t>&star = r.work.star, &other_star = r.work.other_star;
  const auto on_ring = [&](int32_t v) {
    return std::find(ring.vertex.begin(), ring.vertex.end(), v) - ring.vertex.begin();
  };
  const auto size = static_cast<std::ptrdiff_t>(ring.vertex.size());
  std::vector<int32_t> near_a, surface_a, surface_b;
  const auto surface_of = [&](const std::vector<int32_t>& elements, int32_t v, std::vector<int32_t>& out) {
    for (const int32_t t : elements) {
      const Element& e = r.mesh.element[t];
      for (size_t f = 0; f < 4; ++f) {
        if (e.label[f] == 0 || e.v[f] == v)
          continue;
        for (size_t k = 0; k < 4; ++k)
          if (k != f && e.v[k] != v)
            out.push_back(e.v[k]);
      }
    }
    par::sort_unique(out, 1);
  };
  for (const int32_t t : star)
    for (const int32_t v : r.mesh.element[t].v)
      if (v != a && v != b)
        near_a.push_back(v);
  std::sort(near_a.begin(), near_a.end());
  const auto beside_a = [&](int32_t v) { return std::binary_search(near_a.begin(), near_a.end(), v); };
  for (const int32_t t : other_star) {
    const Element& e = r.mesh.element[t];
    if (e.find(a) >= 0)
      continue;
    for (size_t x = 0; x < 4; ++x) {
      if (e.v[x] == b || !beside_a(e.v[x]))
        continue;
      const auto i = on_ring(e.v[x]);
      if (i == size)
        return false;
      for (size_t y = x + 1; y < 4; ++y) {
        if (e.v[y] == b || !beside_a(e.v[y]))
          continue;
        const auto j = on_ring(e.v[y]);
        const auto gap = std::abs(i - j);
        if (j == size || gap == 1 || (ring.closed && gap == size - 1))
          continue;
        for (const int32_t u : star)
          if (r.mesh.element[u].find(e.v[x]) >= 0 && r.mesh.element[u].find(e.v[y]) >= 0)
            return false;
      }
    }
  }
  surface_of(star, a, surface_a);
  surface_of(other_star, b, surface_b);
  std::vector<int32_t> common;
  std::set_intersection(surface_a.begin(), surface_a.end(), surface_b.begin(), surface_b.end(),
                        std::back_inserter(common));
  return common.size() == ring.border.size() && surface_a.size() > 3;
}

bool may_contract(const Vertex& a, const Vertex& b) {
  if (a.kind == Kind::fixed || (a.kind != Kind::interior && b.kind == Kind::interior))
    return false;
  if (a.kind == Kind::trace)
    return b.kind == Kind::fixed || (b.kind == Kind::trace && a.frozen == b.frozen);
  if (a.kind == Kind::line)
    return b.kind == Kind::fixed || (b.kind == Kind::line && a.label == b.label && a.second == b.second);
  return a.kind != Kind::sliding || b.kind != Kind::sliding || (a.frozen & ~b.frozen) == 0;
}

// For a on a labelled face: the edge a b runs in all its labels, and its elements may go. Sets the ring.
bool borders_allow(Region& r, int32_t e, int32_t a, int32_t b) {
  Ring& ring = r.work.ring;
  const Vertex& ka = r.mesh.vertex[a];
  if (!r.ring(e, a, b, ring))
    return false;
  const bool trace = ka.kind == Kind::trace, line = ka.kind == Kind::line;
  const bool crease = trace || line || (ka.kind == Kind::sliding && (ka.frozen & (ka.frozen - 1)) != 0);
  const auto& label = ring.label;
  // Where a wall meets a surface with elements on both sides its triangle is between two of the wall's.
  if (line                ? label.size() != 3
      : label.size() == 3 ? !trace || label[1] == label[0] || label[1] == label[2]
                          : label.size() != 2 || (label[0] != label[1]) != crease)
    return false;
  if ((trace || line) &&
      std::any_of(ring.border.begin(), ring.border.end(), [&](int k) { // a loop of three may lie there
        const Kind kind = r.mesh.vertex[ring.vertex[k]].kind;
        return kind == Kind::trace || kind == Kind::line || kind == Kind::fixed;
      }))
    return false;
  for (const int32_t t : ring.element) { // they go: the faces beyond them take their labels
    const Element& el = r.mesh.element[t];
    const size_t fa = size_t(el.find(a)), fb = size_t(el.find(b));
    if (el.label[fb] != 0 && (crease || el.label[fa] != 0 || el.n[fa] < 0))
      return false;
    if (el.n[fb] < 0 && el.n[fa] < 0)
      return false;
  }
  return true;
}

// The star of a gives way to the candidates. moved: b has, and is on the surface; its elements stay but for the
// ring.
bool finish_contraction(Region& r, int32_t a, int32_t b, bool moved) {
  std::vector<int32_t>& other_star = r.work.other_star;
  bool& watched = r.mesh.vertex[b].watched;
  const bool was_watched = watched;
  watched |= r.mesh.vertex[a].watched;
  r.crossings.clear();
  if (r.crossings.on() && moved)
    r.crossings.add_at(other_star, b, a);
  r.work.old = r.work.star;
  if (!r.exchange(r.work.old, r.work.now, r.mesh.vertex[a].kind != Kind::interior, moved)) {
    watched = was_watched;
    return false;
  }
  r.mesh.incident[a] = -1;
  r.mesh.touched[b] = r.time;
  r.room.vertex.push_back(a);
  if (r.crossings.on() && !moved && watched && !was_watched && r.star(b, other_star)) {
    r.crossings.clear(); // its other triangles may be watched now, too
    r.crossings.add_at(other_star, b, -1);
  }
  r.crossings.note_moved();
  return true;
}

// As contract_edge(), but b moves too: both stars are judged at the best place for it.
bool merge(Region& r, const Acceptance& accept, int32_t e, int i, int j) {
  auto& [star, other_star, old, now, ring, elements, triangles] = r.work;
  int32_t a = r.mesh.element[e].v[i], b = r.mesh.element[e].v[j];
  if (!may_contract(r.mesh.vertex[a], r.mesh.vertex[b]))
    std::swap(a, b);
  const Vertex &ka = r.mesh.vertex[a], &kb = r.mesh.vertex[b];
  if (!may_contract(ka, kb) || ka.kind == Kind::trace || kb.kind == Kind::trace || ka.kind == Kind::line ||
      kb.kind == Kind::line || kb.kind == Kind::fixed || !r.star(a, star) || !r.star(b, other_star))
    return false;
  const float before = std::min(r.worst(star), r.worst(other_star)), above = accept.demand(before);
  const Vec3d pa = r.mesh.point[a], pb = r.mesh.point[b];
  const double length = mean_edge(r, other_star, b);
  Fit fit = gather_triangles(r, accept, star, a);
  const std::vector<MovingTriangle> triangles_a = triangles;
  const Fit fit_b = gather_triangles(r, accept, other_star, b);
  fit.worst = std::max(fit.worst, fit_b.worst);
  fit.excess += fit_b.excess;
  triangles.insert(triangles.end(), triangles_a.begin(), triangles_a.end());
  std::erase_if(triangles, [&](const MovingTriangle& s) { // those on the edge go
    int ends = 0;
    for (const Vec3d& p : s.p)
      ends += (p == pa) + (p == pb);
    if (ends == 2) // found from either end
      fit.excess -= 0.5 * std::max(0., misfit_of(r, accept, s.label, s.p[0], s.p[1], s.p[2]) - 1);
    return ends == 2;
  });
  elements.clear(pb);
  now.clear();
  const auto add = [&](const std::vector<int32_t>& at, int32_t from, int32_t other) {
    for (const int32_t t : at) {
      const Element& el = r.mesh.element[t];
      if (el.find(other) >= 0)
        continue;
      Candidate c{el.v, el.region, 0, el.label};
      std::array<Vec3d, 4> p;
      for (size_t n = 0; n < 4; ++n)
        p[n] = r.mesh.point[c.v[n]];
      const int k = el.find(from);
      c.v[k] = b;
      r.work.elements.add(p, k);
      if (from == a)
        r.work.now.push_back(c);
    }
  };
  add(star, a, b);
  const size_t made = now.size();
  add(other_star, b, a);
  Vec3d x = pb;
  float best = elements.worst(pb, 0);
  if (ka.kind == kb.kind && ka.frozen == kb.frozen) {
    Vec3d y = 0.5 * (pa + pb);
    const float q =
        Bound{accept, {r, kb, pb, accept.guard.reach * length}}(y) ? elements.worst(y, std::max(best, 0.f)) : -1.f;
    if (q > best)
      best = q, x = y;
  }
  if (!(best > 0.25f * before) || (!accept.fits_surface() && !fits_at(r, accept, x, fit)))
    return false;
  if (accept.fits_surface())
    best = worth_at(r, accept, x, above);
  search_place(r, accept, kb, x, best, std::max(accept.goal, above), length, fit, above);
  if (accept.fits_surface() ? !fits_at(r, accept, x, fit) : best <= above)
    return false;
  if (ka.kind != Kind::interior && (!borders_allow(r, e, a, b) || !link_holds(r, a, b)))
    return false;
  r.mesh.point[b] = x;
  bool good = true;
  for (size_t c = 0; c < made && good; ++c)
    good = r.judge(now[c], accept.fits_surface() ? above : before);
  float sum = deficit_of(accept, now), allowed = deficit_of(r, accept, star);
  std::vector<float> q;
  std::vector<int32_t> kept;
  for (size_t t = 0; t < other_star.size() && good; ++t) {
    const Element& el = r.mesh.element[other_star[t]];
    if (el.find(a) >= 0)
      continue;
    Candidate c{el.v, el.region, 0, {}};
    good = r.judge(c, accept.fits_surface() ? above : before);
    kept.push_back(other_star[t]);
    q.push_back(c.q);
    sum += accept.deficit_of(c.q), allowed += accept.deficit_of(el.q);
  }
  if (!good || sum > allowed || (kb.kind == Kind::round && largest_sag(r.mesh, other_star, b) > most_sag)) {
    r.mesh.point[b] = pb;
    return false;
  }
  if (!finish_contraction(r, a, b, kb.kind == Kind::surface)) {
    r.mesh.point[b] = pb;
    return false;
  }
  for (size_t t = 0; t < kept.size(); ++t) {
    r.mesh.element[kept[t]].q = q[t];
    r.touch(kept[t]);
    r.note_change(kept[t]);
    r.changed.push_back(kept[t]);
  }
  return r.done(&Counts::contractions, "merge of an edge");
}

} // namespace

bool is_tiny(const Region& r, int32_t e, int i, int j) {
  const auto p = [&](int k) { return r.mesh.point[r.mesh.element[e].v[k]]; };
  return r.target && norm(p(i) - p(j)) < 0.1 * r.target->spacing();
}

bool contract_edge(Region& r, const Acceptance& accept, int32_t e, int i, int j) {
  auto& [star, other_star, old, now, ring, elements, triangles] = r.work;
  const int32_t a = r.mesh.element[e].v[i], b = r.mesh.element[e].v[j];
  const Vertex& ka = r.mesh.vertex[a];
  if (!may_contract(ka, r.mesh.vertex[b]) || !r.star(a, star))
    return false;
  const bool tiny = accept.tiny_share < 1 && is_tiny(r, e, i, j);
  const float before = r.worst(star), above = (tiny ? accept.tiny_share : 1.f) * accept.demand(before);
  now.clear();
  for (const int32_t t : star) {
    const Element& el = r.mesh.element[t];
    if (el.find(b) >= 0)
      continue;
    Candidate c{el.v, el.region, 0, el.label};
    c.v[el.find(a)] = b;
    if (!r.judge(c, above))
      return false;
    now.push_back(c);
  }
  if (deficit_of(accept, now) > (tiny ? 0.9f : 1.f) * deficit_of(r, accept, star))
    return false;
  if (ka.kind != Kind::interior) {
    const Fit fit = gather_triangles(r, accept, star, a);
    const Vec3d pb = r.mesh.point[b];
    std::erase_if(triangles, [&](const MovingTriangle& s) { return s.p[0] == pb || s.p[1] == pb || s.p[2] == pb; });
    if (!fits_at(r, accept, pb, fit) || !borders_allow(r, e, a, b) || !r.star(b, other_star) ||
        !link_holds(r, a, b))
      return false;
  }
  return finish_contraction(r, a, b, false) && r.done(&Counts::contractions, "edge contraction");
}

bool merge_edge(Region& r, const Acceptance& accept, int32_t e, int i, int j) {
  const auto& v = r.mesh.element[e].v;
  return r.unless_failed(accept, {.operation = FailedAttempts::Operation::merge, .a = v[i], .b = v[j]},
                         [&] { return merge(r, accept, e, i, j); });
}

} // namespace molmesh::optimize
