// follow_neck.cpp — where the target is narrower than the grid, the surface around follows it down, in shells
// (shells.cpp). The surface is a tube there: a ring of its edges crosses the plane at the narrowest place. The
// elements at these edges shrink towards that place, and the tube runs into it from either side as a cone does.
// What its points are off then is small beside the elements they belong to.
#include "optimize/operations/editor.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh::optimize {

// The ring of surface edges across the neck's plane that comes nearest to the neck, of the surface near v: the
// elements at them.
bool Editor::find_ring(int32_t v, const Neck& neck, Piece& piece) {
  constexpr size_t most_reached = 100, longest = 24;
  const double far = 3 * target_->spacing();
  const auto ahead = [&](int32_t w) { return dot(m_.point[w] - neck.at, neck.along); };
  const auto crosses = [&](int32_t w, int32_t u) { return (ahead(w) > 0) != (ahead(u) > 0); };
  int32_t t = -1, a = -1, b = -1;
  double nearest = far;
  std::vector<int32_t> reached{v};
  for (size_t i = 0; i < reached.size() && reached.size() < most_reached; ++i) {
    const int32_t w = reached[i];
    if (m_.vertex[w].kind != Kind::surface || !star(w, star_))
      continue;
    for (const int32_t k : star_) {
      const Element& e = m_.element[k];
      for (size_t f = 0; f < 4; ++f)
        for (size_t g = 0; g < 4; ++g) {
          const int32_t u = e.v[g];
          if (e.label[f] == 0 || e.v[f] == w || g == f || u == w)
            continue;
          const Vec3d from = m_.point[w], to = m_.point[u];
          if (norm(to - neck.at) < far && std::find(reached.begin(), reached.end(), u) == reached.end())
            reached.push_back(u);
          if (!crosses(w, u))
            continue;
          const double x = ahead(w), distance = norm(from + x / (x - ahead(u)) * (to - from) - neck.at);
          if (distance < nearest)
            nearest = distance, t = k, a = w, b = u;
        }
    }
  }
  if (t < 0)
    return false;
  const std::pair<int32_t, int32_t> first = std::minmax(a, b);
  int32_t left = -1;
  for (size_t steps = 0; steps < longest; ++steps) {
    if (!ring(t, a, b, ring_) || ring_.border.size() != 2)
      return false;
    piece.element.insert(piece.element.end(), ring_.element.begin(), ring_.element.end());
    const bool back = ring_.vertex[ring_.border[0]] == left;
    const auto at = static_cast<size_t>(ring_.border[back ? 1 : 0]);
    const int32_t w = ring_.vertex[at]; // of the next triangle
    t = ring_.element[std::min(at, ring_.element.size() - 1)];
    left = std::exchange(crosses(w, a) ? b : a, w);
    if (std::pair<int32_t, int32_t>(std::minmax(a, b)) == first) {
      par::sort_unique(piece.element, 1);
      return true;
    }
  }
  return false;
}

bool Editor::follow_neck(int32_t v, const Neck& neck, double ratio) {
  Piece piece;
  piece.through = true;
  if (!target_ || !find_ring(v, neck, piece) || !find_shell(piece, neck.at))
    return false;
  for (const int32_t t : piece.element) {
    const Element& e = m_.element[t];
    for (size_t f = 0; f < 4; ++f)
      if (e.label[f] != 0)
        for (const int32_t w : outward_triangle(e.v, f))
          piece.vertex.push_back(w);
  }
  par::sort_unique(piece.vertex, 1);
  double scale = 1, least = 1e30;
  for (double s = 0.9; s > 0.005 && least > 0.8; s *= 0.9) {
    double most = 0;
    for (const int32_t w : piece.vertex)
      most = std::max(most, off_at(neck.at + s * (m_.point[w] - neck.at)).value_or(1e30));
    if (most < least)
      least = most, scale = s;
  }
  return scale < 0.9 && shrink(piece, neck.at, scale, ratio);
}

} // namespace molmesh::optimize
