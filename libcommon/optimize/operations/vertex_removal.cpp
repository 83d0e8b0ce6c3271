// vertex_removal.cpp — contractions of one vertex, tried from the best on.
#include "optimize/operations/vertex_removal.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::optimize {
namespace {

// A new edge may be so much longer than the mean of the edges that is meant.
constexpr double longest_edge = 1.8;
// The best contractions fail for the surface or its topology, if any does: no more are tried.
constexpr size_t most_tried = 4;

} // namespace

bool VertexRemoval::find_neighbors(int32_t a) {
  near_.clear();
  surface_.clear();
  labelled_.clear();
  if (!r_.star(a, star_))
    return false;
  for (const int32_t t : star_) {
    const Element& e = r_.mesh.element[t];
    for (size_t f = 0; f < 4; ++f) {
      if (e.v[f] == a)
        continue;
      near_.push_back(e.v[f]);
      if (e.label[f] == 0)
        continue;
      for (const int32_t v : outward_triangle(e.v, f))
        if (v != a) {
          labelled_.push_back(v);
          if (r_.mesh.labels[e.label[f]].curved())
            surface_.emplace_back(v, e.label[f]);
        }
    }
  }
  par::sort_unique(near_, 1);
  par::sort_unique(surface_, 1);
  par::sort_unique(labelled_, 1);
  return true;
}

bool VertexRemoval::lengths_allow(int32_t a, int32_t b) const {
  const Vec3d x = r_.mesh.point[b];
  return std::all_of(near_.begin(), near_.end(), [&](int32_t w) {
    const double most = longest_edge * std::min(size_[b], size_[w]);
    const double now = norm2(r_.mesh.point[w] - x);
    return w == b || now <= most * most || now <= norm2(r_.mesh.point[w] - r_.mesh.point[a]);
  });
}

// Whether the middles of the surface's new edges stay as near to the target as the guard wants centroids, which
// contract_edge() looks at.
bool VertexRemoval::surface_allows(int32_t b) const {
  return std::all_of(surface_.begin(), surface_.end(), [&](const auto& at) {
    const Target* target = r_.target_of(at.second);
    double distance;
    Vec3d normal;
    return at.first == b ||
           (target && target->probe(0.5 * (r_.mesh.point[at.first] + r_.mesh.point[b]), distance, normal) &&
            std::abs(distance) <= accept_.guard.distance * target->spacing());
  });
}

// Of the elements with a at b; some value ≤ above where one is no better than that, or lies between faces of labels
// alone.
float VertexRemoval::worst_at(int32_t a, int32_t b, float above) const {
  const DynamicMesh& m = r_.mesh;
  const bool inner = m.vertex[a].kind == Kind::interior;
  float worst = 2;
  for (const int32_t t : star_) {
    const Element& e = m.element[t];
    if (e.find(b) >= 0)
      continue;
    std::array<int32_t, 4> v = e.v;
    v[e.find(a)] = b;
    if (inner && std::all_of(v.begin(), v.end(), [&](int32_t w) { return m.vertex[w].kind != Kind::interior; }))
      return -1;
    worst = std::min(worst, m.quality(v));
    if (worst <= above)
      break;
  }
  return worst;
}

bool VertexRemoval::contract(int32_t a, int32_t b) {
  for (const int32_t t : star_) {
    const Element& e = r_.mesh.element[t];
    if (e.find(b) >= 0)
      return contract_edge(r_, accept_, t, e.find(a), e.find(b));
  }
  return false;
}

bool VertexRemoval::operator()(int32_t a) {
  const Vertex& vertex = r_.mesh.vertex[a];
  if (vertex.kind == Kind::fixed || !find_neighbors(a))
    return false;
  const float above = accept_.demand(r_.worst(star_));
  places_.clear();
  for (const int32_t b : vertex.kind == Kind::interior ? near_ : labelled_)
    if (lengths_allow(a, b))
      if (const float q = worst_at(a, b, above); q > above && surface_allows(b))
        places_.emplace_back(-q, b);
  std::sort(places_.begin(), places_.end());
  for (size_t k = 0; k < std::min(places_.size(), most_tried); ++k)
    if (contract(a, places_[k].second))
      return true;
  return false;
}

} // namespace molmesh::optimize
