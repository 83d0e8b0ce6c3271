// surface_projection.cpp — surface vertices of a part move onto the target.
#include "optimize/operations/moving_vertex.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::optimize {
namespace {

// What an element of that quality has to stay above.
float least(float now, float floor) {
  return floor >= 1 ? 0.5f * now : std::min(floor, now) * 0.999999f;
}

void project_vertex(Region& r, const Acceptance& accept, int32_t v, float floor, Moves* later) {
  if (!r.star(v, r.work.star))
    return;
  Vec3d to = r.mesh.point[v];
  if (!project(r, r.mesh.vertex[v], to, accept.guard.reach * mean_edge(r, r.work.star, v)))
    return;
  step_towards(r, accept, v, to, 0.5, 0.1, least(r.worst(r.work.star), floor), later);
}

// Whether one of the targets of a vertex between domains is known, and farther than that.
bool is_away(const Region& r, int32_t v, double there) {
  const Vertex& vertex = r.mesh.vertex[v];
  double distance;
  Vec3d normal;
  for (int k = 0; k < (vertex.kind == Kind::line ? 2 : 1); ++k)
    if (r.target_of(k == 0 ? vertex.label : vertex.second)->probe(r.mesh.point[v], distance, normal) &&
        std::abs(distance) >= there)
      return true;
  return false;
}

// Those that are not there yet: a vertex stays where it is until its turn.
void project_each_vertex(Region& r, const Acceptance& accept, const std::vector<int32_t>& vertices, float floor,
                         Moves* later) {
  const double there = 2e-3 * r.spacing();
  for (size_t first = 0; first < vertices.size(); first += 8) {
    const size_t n = std::min<size_t>(8, vertices.size() - first);
    const EightProbes probes = probe_some(*r.target, r.mesh.point, vertices.data() + first, n);
    for (size_t i = 0; i < n; ++i)
      if (has_main_target(r.mesh, vertices[first + i]) ? probes.is_known(i) && std::abs(probes.distance[i]) >= there
                                                       : is_away(r, vertices[first + i], there))
        project_vertex(r, accept, vertices[first + i], floor, later);
  }
}

// Puts back those of the vertices that have moved, and where that spoils an element, those of the element too: at
// last it is as it was. Returns the triangles at them. back: all that are put back.
std::vector<int64_t> put_back(Region& r, const Moves& moved, std::vector<int32_t> vertices, float floor,
                              SmallNumbers& back) {
  std::vector<int64_t> face;
  while (!vertices.empty()) {
    SmallNumbers element;
    for (const int32_t v : vertices) {
      const int32_t move = moved.vertex.find(v);
      if (move < 0 || back.knows(v) || !r.star(v, r.work.star))
        continue;
      back(v);
      r.mesh.point[v] = moved.from[size_t(move)];
      for (const int32_t e : r.work.star)
        element(e);
      r.crossings.clear();
      r.crossings.add_at(r.work.star, v, -1);
      face.insert(face.end(), r.crossings.faces().begin(), r.crossings.faces().end());
    }
    vertices.clear();
    for (const int32_t id : element.met()) {
      Element& e = r.mesh.element[id];
      Candidate now{e.v, e.region, 0, {}};
      if (!r.judge(now, least(e.q, floor)))
        vertices.insert(vertices.end(), e.v.begin(), e.v.end());
      e.q = now.q;
    }
  }
  return face;
}

} // namespace

void project_to_surface(Region& r, const Acceptance& accept, const std::vector<int32_t>& vertices, float floor) {
  if (!r.target)
    return;
  Moves moved;
  project_each_vertex(r, accept, vertices, floor, r.crossings.on() ? &moved : nullptr);
  SmallNumbers back;
  for (std::vector<int64_t> face = moved.face; !face.empty();)
    face = put_back(r, moved, r.crossings.find_crossing(face), floor, back);
  r.counts.moves -= static_cast<int64_t>(back.met().size());
  std::vector<int32_t> again = back.met();
  std::sort(again.begin(), again.end());
  project_each_vertex(r, accept, again, floor, nullptr);
}

} // namespace molmesh::optimize
