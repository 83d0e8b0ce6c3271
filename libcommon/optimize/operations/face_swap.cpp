// face_swap.cpp — the face between two elements goes: three take their place, round a new edge.
#include "optimize/operations/moving_vertex.hpp"
#include <algorithm>

namespace molmesh::optimize {

bool swap_face(Region& r, const Acceptance& accept, int32_t e, int i) {
  std::vector<int32_t>& old = r.work.old;
  std::vector<Candidate>& now = r.work.now;
  const Element& el = r.mesh.element[e];
  const int32_t n = el.n[i];
  if (n < 0 || el.label[i] != 0 || !r.owned(e) || !r.owned(n))
    return false;
  const Element& other = r.mesh.element[n];
  const int32_t a = el.v[i];
  int32_t b = -1;
  for (size_t k = 0; k < 4; ++k)
    if (other.n[k] == e)
      b = other.v[k];
  const float above = accept.demand(std::min(el.q, other.q));
  now.clear();
  const auto face = outward_triangle(el.v, size_t(i));
  for (size_t k = 0; k < 3; ++k) {
    Candidate c{{a, b, face[k], face[(k + 1) % 3]}, el.region, 0, {}};
    if (!r.judge(c, above))
      return false;
    now.push_back(c);
  }
  old = {e, n};
  if (!r.has_room(2, 3) || deficit_of(accept, now) > deficit_of(r, accept, old))
    return false;
  if (!r.exchange(old, now, false))
    return false;
  return r.done(&Counts::face_swaps, "face swap");
}

} // namespace molmesh::optimize
