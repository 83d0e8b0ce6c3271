// bounds.cpp — what surface triangles and vertices are bound to: the target, and not to cross another sheet.
#include "geom/intersect.hpp"  // exact test of two triangles
#include "geom/predicates.hpp" // on which side of a triangle a point lies
#include "optimize/operations/editor.hpp"
#include <algorithm>
#include <bit>
#include <cmath>

namespace molmesh::optimize {

double Editor::misfit(Vec3d a, Vec3d b, Vec3d c, double most_tilt) const {
  return molmesh::misfit(*target_, guard_, most_tilt, a, b, c);
}

// Of a labelled face; 0 for flat labels and without a target.
double Editor::misfit_face(const Element& e, size_t face, double most_tilt) const {
  if (!target_ || !m_.labels[e.label[face]].curved())
    return 0;
  std::array<Vec3d, 3> p;
  const auto v = outward_triangle(e.v, face);
  for (size_t i = 0; i < 3; ++i)
    p[i] = m_.point[v[i]];
  return m_.outward(e, face) ? misfit(p[0], p[1], p[2], most_tilt) : misfit(p[0], p[2], p[1], most_tilt);
}

// How far from the target loose vertices may be, in units of off().
constexpr double most_loose = 0.9;

// Whether x is as near to the target as the guard wants it.
bool Editor::stays(Vec3d x) const {
  double distance;
  Vec3d normal;
  return guard_.leave == Guard::anywhere ||
         (target_->probe(x, distance, normal) && std::fabs(distance) <= guard_.leave * target_->spacing());
}

// Moves x, of a vertex of that kind, onto the target.
bool Editor::project(const Vertex& k, Vec3d& x, double reach) const {
  return target_ &&
         (k.kind == Kind::trace ? target_->project_in_plane(x, k.axis(), reach) : target_->project(x, reach));
}

// And a trial of one at `from`, within the walls.
bool Editor::put_on_target(const Vertex& k, Vec3d from, Vec3d& x, double reach) const {
  if (k.kind == Kind::trace)
    x[k.axis()] = from[k.axis()];
  return project(k, x, reach) && inside_walls(from, x);
}

// n trials: those that come there, in front and in order; how many.
int Editor::put_all_on_target(const Vertex& k, Vec3d from, Vec3d* x, int n, double reach) const {
  int there = 0;
  if (k.kind != Kind::surface) {
    for (int i = 0; i < n; ++i)
      if (Vec3d y = x[i]; put_on_target(k, from, y, reach))
        x[there++] = y;
    return there;
  }
  for (int first = 0; first < n; first += 8) {
    const int count = std::min(8, n - first);
    EightPlaces eight;
    for (int i = 0; i < count; ++i)
      eight.set(size_t(i), x[first + i]);
    for (uint32_t put = target_->project_eight(eight, count, reach); put; put &= put - 1)
      if (const Vec3d y = eight[std::countr_zero(put)]; inside_walls(from, y))
        x[there++] = y;
  }
  return there;
}

// Moves a trial x of a vertex at `from` onto what it is bound to.
bool Editor::constrain(const Vertex& k, Vec3d from, Vec3d& x, double reach) const {
  switch (k.kind) {
  case Kind::interior:
    return true;
  case Kind::trace:
    x[k.axis()] = from[k.axis()];
    [[fallthrough]];
  case Kind::surface:
    // The distance to first order means nothing where the gradient vanishes, and that is where points must leave.
    if (target_ && guard_.lift > 0)
      return norm(x - from) <= guard_.lift * target_->spacing() && stays(x) && inside_walls(from, x);
    if (target_ && loose)
      return norm(x - from) <= reach && off_at(x).value_or(1) <= most_loose && inside_walls(from, x);
    return put_on_target(k, from, x, reach);
  case Kind::sliding:
    for (int a = 0; a < 3; ++a)
      if (k.frozen >> a & 1)
        x[a] = from[a];
    return true;
  case Kind::fixed:
    break;
  }
  return false;
}

int Editor::constrain_all(const Vertex& k, Vec3d from, Vec3d* x, int n, double reach) const {
  int allowed = 0;
  if (k.kind != Kind::surface || !target_ || guard_.lift > 0) {
    for (int i = 0; i < n; ++i)
      if (Vec3d y = x[i]; constrain(k, from, y, reach))
        x[allowed++] = y;
    return allowed;
  }
  if (!loose)
    return put_all_on_target(k, from, x, n, reach);
  for (int first = 0; first < n; first += 8) {
    const int count = std::min(8, n - first);
    EightPlaces eight;
    for (int i = 0; i < count; ++i)
      eight.set(size_t(i), x[first + i]);
    EightProbes probes;
    target_->probe_eight(eight, count, probes);
    for (uint32_t known = probes.known; known; known &= known - 1) {
      const auto i = size_t(std::countr_zero(known));
      if (target_->off_by(probes.distance[i]) <= most_loose && norm(eight[i] - from) <= reach &&
          inside_walls(from, eight[i]))
        x[allowed++] = eight[i];
    }
  }
  return allowed;
}

// A labelled face of e seen from the side that counts it, with vertex `from` moving.
void Editor::add_sail(const Element& e, size_t face, int32_t from) {
  if (!target_ || !m_.labels[e.label[face]].curved() || !m_.counts_here(e, face))
    return;
  Sail s{{}, -1};
  const auto v = outward_triangle(e.v, face);
  for (size_t i = 0; i < 3; ++i) {
    s.p[i] = m_.point[v[i]];
    if (v[i] == from)
      s.moving = static_cast<int>(i);
  }
  if (!m_.outward(e, face)) {
    std::swap(s.p[1], s.p[2]);
    s.moving = s.moving == 1 ? 2 : s.moving == 2 ? 1 : s.moving;
  }
  sails_.push_back(s);
}

Fit Editor::fit_of_sails(const Vec3d* x) const {
  Fit fit;
  EightTriangles triangle;
  EightPlaces centroid;
  EightProbes probes;
  for (size_t first = 0; first < sails_.size(); first += 8) {
    const size_t n = std::min<size_t>(8, sails_.size() - first);
    for (size_t i = 0; i < n; ++i) {
      const Sail& s = sails_[first + i];
      EightPlaces* const corner[3] = {&triangle.a, &triangle.b, &triangle.c};
      for (size_t k = 0; k < 3; ++k)
        corner[k]->set(i, x && s.moving == static_cast<int>(k) ? *x : s.p[k]);
    }
    centroids(triangle, centroid);
    target_->probe_eight(centroid, static_cast<int>(n), probes);
    double misfit[8];
    misfits(triangle, probes, guard_.distance * target_->spacing(), most_tilt_, misfit);
    for (size_t i = 0; i < n; ++i)
      fit.add(misfit[i]);
  }
  return fit;
}

bool Editor::sails_fit(Vec3d x, const Fit& before) const {
  return fits(fit_of_sails(&x), before);
}

bool Editor::bent(int32_t t, size_t face) const {
  const Element& e = m_.element[t];
  return m_.counts_here(e, face) && misfit_face(e, face, std::min(most_tilt_, bent_tilt_)) > 1;
}

std::optional<double> Editor::off_at(Vec3d x) const {
  double distance;
  Vec3d normal;
  if (!target_ || !target_->probe(x, distance, normal))
    return std::nullopt;
  return target_->off_by(distance);
}

double Editor::off(int32_t v) const {
  constexpr double two_spacings = 100; // where the target is not known: it is not near
  return follows_target(m_.vertex[v].kind) && target_ ? off_at(m_.point[v]).value_or(two_spacings) : 0;
}

// Whether t and three triangles of beyond_, one across each of its edges, close a hole that is inside out.
bool Editor::turns_over(const std::array<int32_t, 3>& t) const {
  const auto across = [&](int k, int32_t apex) {
    return std::any_of(beyond_.begin(), beyond_.end(),
                       [&](const Beyond& b) { return b.edge == k && b.apex == apex; });
  };
  const auto p = [&](int32_t v) { return m_.point[v]; };
  return std::any_of(beyond_.begin(), beyond_.end(), [&](const Beyond& b) {
    return b.edge == 0 && across(1, b.apex) && across(2, b.apex) &&
           !(orient3d(p(t[0]), p(t[1]), p(t[2]), p(b.apex)) > 0);
  });
}

// near_: what may stand in the way of any triangle of rim_. Triangles of other parts change meanwhile, each in its
// own cell, so none of those is met; triangles of no part stay as they are.
void Editor::gather_near(const Sheets& sheets, const Boxf& around, bool may_be_stale) {
  sheets.any(around, [&](const SheetTriangle& other) {
    const size_t n = near_.size();
    near_.push_back({other, may_be_stale ? Near::Stays::may_be_stale : Near::Stays::not_asked});
    if (n % 8 == 0)
      near_box_.emplace_back();
    near_box_[n / 8].set(n % 8, static_cast<int32_t>(n), other);
    return false;
  });
}

bool Editor::stays_near(Near& n, bool stamped_go) const {
  if (n.stays == Near::Stays::yes || n.stays == Near::Stays::no)
    return n.stays == Near::Stays::yes;
  const auto owner = [&](size_t k) { return parts_.owner[n.triangle.v[k]]; };
  const bool stays = !((owner(0) >= 0 && owner(0) != room_.part && owner(0) == owner(1) && owner(0) == owner(2)) ||
                       (stamped_go && stamp_[n.triangle.face / 4] == clock_) ||
                       (n.stays == Near::Stays::may_be_stale && changed_sheets_.knows(n.triangle.face)));
  n.stays = stays ? Near::Stays::yes : Near::Stays::no;
  return stays;
}

// Triangles of a hole with four of them share edges, all with all: turned inside out none crosses another.
void Editor::note_edge(const Apart& apart, const std::array<int32_t, 3>& other) {
  if (apart.share_edge())
    beyond_.push_back({std::countr_zero(apart.of_first), other[std::countr_zero(apart.of_second)]});
}

// Whether they are seen not to cross without the exact test.
bool Editor::lie_beside(const SheetTriangle& a, const SheetTriangle& b, const Apart& apart) const {
  return a.of_one_sheet(b, apart.beside()) && side_by_side(m_.point, a, b, apart);
}

// Whether it crosses the near one, which may be itself and may not stay; their common edge is noted.
bool Editor::crosses(const SheetTriangle& now, Near& near, bool stamped_go) {
  const SheetTriangle& other = near.triangle;
  const Apart apart(now.v, other.v);
  const bool beside = lie_beside(now, other, apart);
  // Whether it stays is further away in memory.
  if ((beside && !apart.share_edge()) || !stays_near(near, stamped_go))
    return false;
  note_edge(apart, other.v);
  return !beside && triangles_cross(m_.point, now.v, other.v);
}

// True when a triangle of rim_ leaves this part's cell.
bool Editor::rim_leaves() const {
  return std::any_of(rim_.begin(), rim_.end(), [&](const auto& t) {
    return std::any_of(t.begin(), t.end(), [&](int32_t v) { return parts_.at(m_.point[v]) != room_.part; });
  });
}

// True when a triangle of rim_ crosses another one or another of rim_, or leaves this part's cell.
bool Editor::rim_crosses(bool stamped_go) {
  elsewhere_ |= !rim_.empty();
  if (rim_leaves())
    return true;
  rim_sheet_.clear();
  Boxf around; // all of them
  for (const auto& t : rim_)
    around.add(rim_sheet_.emplace_back(sheet_triangle(m_.point, t, -1)));
  if (rim_.empty())
    return false;
  near_.clear();
  near_box_.clear();
  gather_near(changed_sheets_, around, false);
  gather_near(*sheets_, around, true);
  for (size_t i = 0; i < rim_.size(); ++i) {
    const SheetTriangle& now = rim_sheet_[i];
    beyond_.clear();
    for (const auto& o : rim_)
      note_edge(Apart(now.v, o), o);
    for (size_t j = 0; j < i; ++j)
      if (!lie_beside(now, rim_sheet_[j], Apart(now.v, rim_[j])) && triangles_cross(m_.point, now.v, rim_[j]))
        return true;
    for (const EightBoxes& eight : near_box_)
      for (uint32_t met = eight.met(now); met; met &= met - 1)
        if (crosses(now, near_[eight.id[std::countr_zero(met)]], stamped_go))
          return true;
    if (turns_over(now.v))
      return true;
  }
  return false;
}

// Faces at v where the mesh ends, of elements that keep their vertices.
void Editor::list_rim(const std::vector<int32_t>& elements, int32_t v, int32_t without) {
  for (const int32_t t : elements) {
    const Element& e = m_.element[t];
    if (without >= 0 && e.find(without) >= 0)
      continue;
    for (size_t f = 0; f < 4; ++f)
      if (e.n[f] < 0 && e.v[f] != v && m_.labels[e.label[f]].curved() && m_.crowded(outward_triangle(e.v, f))) {
        rim_.push_back(outward_triangle(e.v, f));
        rim_face_.push_back(4 * int64_t(t) + int64_t(f));
      }
  }
}

// After what list_rim(elements, …) was for: sheets know those triangles as they are now, or will.
void Editor::move_rim() {
  if (unlooked_) {
    unlooked_->face.insert(unlooked_->face.end(), rim_face_.begin(), rim_face_.end());
    return;
  }
  for (size_t i = 0; i < rim_face_.size(); ++i)
    changed_sheets_.insert(sheet_triangle(m_.point, rim_[i], rim_face_[i]));
}

} // namespace molmesh::optimize
