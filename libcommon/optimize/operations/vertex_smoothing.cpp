// vertex_smoothing.cpp — vertices move: search for the worst element, places on the target.
#include "geom/tet_quality_simd.hpp"
#include "optimize/operations/editor.hpp"
#include <algorithm>
#include <array>

namespace molmesh::optimize {
namespace {

// Directions a vertex may take: all, the free axes, the plane across the normal, or that plane's line in another.
int basis_of(const Vertex& k, const Target* target, bool lifted, Vec3d x, Vec3d basis[3]) {
  int n = 0;
  if (k.kind == Kind::fixed)
    return 0;
  if (!follows_target(k.kind) || (lifted && target)) {
    for (int a = 0; a < 3; ++a)
      if (!(k.frozen >> a & 1))
        basis[n] = {}, basis[n++][a] = 1;
    return n;
  }
  double distance;
  Vec3d normal;
  if (!target || !target->probe(x, distance, normal))
    return 0;
  if (k.kind == Kind::trace) {
    Vec3d across;
    across[k.axis()] = 1;
    basis[0] = cross(across, normal);
    const double length = norm(basis[0]);
    if (!(length > 0))
      return 0;
    basis[0] = basis[0] / length;
    return 1;
  }
  Vec3d other{1, 0, 0};
  if (std::abs(normal.x) > 0.6)
    other = {0, 1, 0};
  basis[0] = cross(normal, other);
  basis[0] = basis[0] / norm(basis[0]);
  basis[1] = cross(normal, basis[0]);
  return 2;
}

} // namespace

// Of the sails with the vertex at x, where no element is as bad as `above`: what a search raises to make the
// surface fit.
float Editor::worth(Vec3d x, float above) {
  return star_quality_.worst(x, above) > above ? fit_of_sails(&x).worth() : 0;
}

bool Editor::search(const Vertex& k, Vec3d& x, float& best, float aim, double length, const Fit& before,
                    float above) {
  Vec3d basis[3];
  const int dimensions = basis_of(k, target_, guard_.lift > 0 || loose, x, basis);
  if (dimensions == 0)
    return false;
  const Vec3d from = x;
  struct {
    const Editor& editor;
    const Vertex& vertex;
    Vec3d from;
    double reach;
    bool operator()(Vec3d& y) const { return editor.constrain(vertex, from, y, reach); }
    int all(Vec3d* y, int n) const { return editor.constrain_all(vertex, from, y, n, reach); }
  } const bind{*this, k, from, guard_.reach * length};
  if (straighten) {
    struct {
      Editor& editor;
      float above;
      float worst(Vec3d y, float) { return editor.worth(y, above); }
      Vec3d ascent(Vec3d, double) { return {}; }
    } straightness{*this, above};
    return pattern_search(straightness, x, best, 1, length, basis, dimensions, bind, [](Vec3d) { return true; });
  }
  return pattern_search(
      star_quality_, x, best, aim, length, basis, dimensions, bind, [&](Vec3d y) { return sails_fit(y, before); },
      least_step);
}

// The best place on the target around x where the surface fits better. The way along the gradient alone leads
// nowhere where that vanishes.
bool Editor::place_on_target(const Vertex& k, Vec3d& x, double length, const Fit& before, float above) {
  const Vec3d from = x;
  float best = above;
  const double reach = guard_.reach * length;
  const auto bind = [&](Vec3d& y) { return put_on_target(k, from, y, reach); };
  const auto accept = [&](Vec3d y) { return sails_fit(y, before); };
  constexpr int all = 27 * 3; // directions, each at three lengths
  for (int first = 0; first < all; first += 8) {
    const int n = std::min(8, all - first);
    std::array<Vec3d, 8> place;
    for (int i = 0; i < n; ++i) {
      const int way = (first + i) / 3;
      const Vec3d d{way / 9 - 1., way / 3 % 3 - 1., way % 3 - 1.};
      place[i] = from + 0.15 * (1 << (first + i) % 3) * length / std::max(norm(d), 1.) * d;
    }
    const auto there = place.begin() + put_all_on_target(k, from, place.data(), n, reach);
    const auto near = std::remove_if(place.begin(), there, [&](Vec3d y) { return !(norm(y - from) < length); });
    const auto places = static_cast<int>(near - place.begin());
    float q;
    for (int i = 0; (i = star_quality_.first_above(place.data(), i, places, best, q)) < places; ++i)
      if (accept(place[i]))
        best = q, x = place[i];
  }
  if (!(best > above))
    return false;
  Vec3d basis[3];
  const int dimensions = basis_of(k, target_, false, x, basis);
  pattern_search(star_quality_, x, best, goal, length, basis, dimensions, bind, accept);
  return true;
}

// Sails of v's star, and how they fit now.
Fit Editor::gather_sails(const std::vector<int32_t>& star, int32_t v) {
  sails_.clear();
  if (follows_target(m_.vertex[v].kind))
    for (const int32_t t : star) {
      const Element& e = m_.element[t];
      for (size_t f = 0; f < 4 && e.any_labelled(); ++f)
        if (e.label[f] != 0 && e.v[f] != v)
          add_sail(e, f, v);
    }
  Fit fit = fit_of_sails();
  if (straighten)
    fit.excess += std::max(0., off(v) - 1);
  return fit;
}

double Editor::mean_edge(const std::vector<int32_t>& star, int32_t v) const {
  const Vec3d from = m_.point[v];
  double length = 0;
  for (const int32_t t : star)
    for (const int32_t w : m_.element[t].v)
      if (w != v)
        length += norm(m_.point[w] - from);
  return length / (3. * double(star.size()));
}

// Quality and sails of v's star; the mean length of its edges, and how it fits now.
void Editor::gather(const std::vector<int32_t>& star, int32_t v, double& length, Fit& before) {
  star_quality_.clear(m_.point[v]);
  for (const int32_t t : star) {
    const Element& e = m_.element[t];
    std::array<Vec3d, 4> p;
    for (size_t j = 0; j < 4; ++j)
      p[j] = m_.point[e.v[j]];
    star_quality_.add(p, e.find(v));
  }
  length = mean_edge(star, v);
  before = gather_sails(star, v);
}

// v is at its new place: takes it when every element of the star is above.
bool Editor::take(const std::vector<int32_t>& elements, int32_t v, Vec3d from, float above, float allowed) {
  if (follows_target(m_.vertex[v].kind) && !inside_walls(from, m_.point[v])) {
    m_.point[v] = from;
    return false;
  }
  now_.clear();
  const auto corner = [&](size_t k, size_t i) { return m_.point[m_.element[elements[k]].v[i]]; };
  const auto keep = [&](size_t k, float q) {
    const Element& e = m_.element[elements[k]];
    now_.push_back({e.v, e.region, q, {}});
    return is_above(now_.back(), above);
  };
  if (!judge_each(elements.size(), corner, keep)) {
    m_.point[v] = from;
    return false;
  }
  clear_rim();
  if (sheets_ && follows_target(m_.vertex[v].kind))
    list_rim(elements, v, -1);
  if (lack(now_) > allowed || (unlooked_ ? rim_leaves() : rim_crosses(false))) {
    m_.point[v] = from;
    return false;
  }
  if (unlooked_)
    unlooked_->vertex.emplace_back(v, from);
  move_rim();
  for (size_t i = 0; i < elements.size(); ++i) {
    Element& e = m_.element[elements[i]];
    if (unlooked_)
      unlooked_->element.emplace_back(elements[i], e.q);
    e.q = now_[i].q;
    note_change(elements[i]);
    touch(elements[i]);
  }
  changed.insert(changed.end(), elements.begin(), elements.end());
  ++counts.moves;
  return true;
}

bool Editor::smooth(int32_t v) {
  Failures::Attempt attempt{.a = v};
  return !has_failed(attempt) && (move_to_best(v) || note_failure(attempt));
}

bool Editor::move_to_best(int32_t v) {
  const Vertex& k = m_.vertex[v];
  if (k.kind == Kind::fixed || !star(v, star_))
    return false;
  const float before = worst(star_), above = straighten ? demand(before) : before;
  if (!straighten && before >= goal)
    return false;
  double length;
  Fit fit;
  gather(star_, v, length, fit);
  if (straighten && fit.excess == 0)
    return false;
  const Vec3d from = m_.point[v];
  Vec3d x = from;
  float best = straighten ? fit.worth() : before;
  if (straighten && off(v) > 1 ? !place_on_target(k, x, length, fit, above)
                               : !search(k, x, best, goal, length, fit, above))
    return false;
  m_.point[v] = x;
  return take(star_, v, from, above, lack(star_));
}

bool Editor::step_to(int32_t v, Vec3d to, double shorter, double least, float above) {
  const Vec3d from = m_.point[v];
  for (double step = 1; step > least; step *= shorter) {
    m_.point[v] = step == 1 ? to : from + step * (to - from);
    if (take(star_, v, from, above, 1e30f))
      return true;
  }
  return false;
}

} // namespace molmesh::optimize
