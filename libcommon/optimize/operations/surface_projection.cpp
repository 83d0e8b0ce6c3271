// surface_projection.cpp — surface vertices of a part move onto the target; whether triangles cross is asked once
// all have.
#include "mesh/box_tree.hpp"
#include "optimize/operations/editor.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::optimize {

void Editor::settle(const std::vector<int32_t>& vertices, float floor) {
  if (!target_)
    return;
  Unlooked moved;
  if (sheets_)
    unlooked_ = &moved;
  const Counts before = counts;
  settle_each(vertices, floor);
  unlooked_ = nullptr;
  if (!sheets_ || !any_crosses(moved))
    return;
  put_back(moved);
  counts = before;
  settle_each(vertices, floor);
}

// Those that are not there yet: a vertex stays where it is until its turn.
void Editor::settle_each(const std::vector<int32_t>& vertices, float floor) {
  const double there = 2e-3 * target_->spacing();
  for (size_t first = 0; first < vertices.size(); first += 8) {
    const size_t n = std::min<size_t>(8, vertices.size() - first);
    const EightProbes probes = probe_some(*target_, m_.point, vertices.data() + first, n);
    for (size_t i = 0; i < n; ++i)
      if (probes.is_known(i) && std::abs(probes.distance[i]) >= there)
        settle(vertices[first + i], floor);
  }
}

void Editor::settle(int32_t v, float floor) {
  if (!star(v, star_))
    return;
  Vec3d to = m_.point[v];
  if (!project(m_.vertex[v], to, guard_.reach * mean_edge(star_, v)))
    return;
  const float now = worst(star_), above = floor >= 1 ? 0.5f * now : std::min(floor, now) * 0.999999f;
  step_to(v, to, 0.5, 0.1, above);
}

// Whether one of the triangles that have moved crosses another. settled_: all of them.
bool Editor::any_crosses(Unlooked& moved) {
  par::sort_unique(moved.face, 1);
  near_.clear();
  settled_.clear();
  OpenTable has_moved;
  has_moved.reserve(moved.face.size());
  Boxf around; // all of them
  for (const int64_t face : moved.face) {
    const auto v = outward_triangle(m_.element[face / 4].v, size_t(face % 4));
    has_moved[uint64_t(face)] = 1;
    settled_.push_back(sheet_triangle(m_.point, v, face));
    near_.push_back({settled_.back(), Near::Stays::yes});
    around.add(settled_.back());
  }
  sheets_->any(around, [&](const SheetTriangle& other) {
    if (Near n{other, Near::Stays::not_asked}; !has_moved.find(uint64_t(other.face)) && stays_near(n, false))
      near_.push_back(n);
    return false;
  });
  const BoxTree tree(near_.size(), [&](size_t n) { return near_[n].triangle; });
  // Each with those after it: the first of a hole's four has the others at its edges.
  for (size_t i = 0; i < moved.face.size(); ++i) {
    const SheetTriangle& now = near_[i].triangle;
    beyond_.clear();
    if (tree.any(
            now, [&](size_t n) { return crosses(now, near_[n], false); }, i + 1) ||
        turns_over(now.v))
      return true;
  }
  return false;
}

// A part in which nothing else has changed, as it was.
void Editor::put_back(const Unlooked& moved) {
  for (auto i = moved.vertex.rbegin(); i != moved.vertex.rend(); ++i)
    m_.point[i->first] = i->second;
  for (auto i = moved.element.rbegin(); i != moved.element.rend(); ++i)
    m_.element[i->first].q = i->second;
  settled_.clear();
  changed.clear();
}

SheetChanges Editor::take_sheet_changes() {
  SheetChanges all = changed_sheets_.changes();
  all.there.insert(all.there.end(), settled_.begin(), settled_.end());
  return all;
}

} // namespace molmesh::optimize
