// shrink_cavity.cpp — a closed surface smaller than the grid comes to the target's size and place, in shells of its
// own surroundings (shells.cpp).
#include "optimize/operations/editor.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::optimize {

constexpr size_t most_vertices = 24; // of the surface, which else has room

// The closed surface that v is on and the elements at it. False where it is large or not all of this part.
bool Editor::find_piece(int32_t v, Piece& piece) {
  piece.vertex.push_back(v);
  for (size_t i = 0; i < piece.vertex.size(); ++i) {
    const int32_t w = piece.vertex[i];
    if (piece.vertex.size() > most_vertices || m_.vertex[w].kind != Kind::surface || !star(w, star_))
      return false;
    piece.element.insert(piece.element.end(), star_.begin(), star_.end());
    for (const int32_t t : star_) {
      const Element& e = m_.element[t];
      for (size_t f = 0; f < 4; ++f)
        for (size_t k = 0; k < 4; ++k)
          if (e.label[f] != 0 && e.v[f] != w && k != f && !piece.has(e.v[k]))
            piece.vertex.push_back(e.v[k]);
    }
  }
  par::sort_unique(piece.element, 1);
  double volume = 0; // six times, negative where the molecule is around it
  const Vec3d home = m_.point[v];
  for (const int32_t w : piece.vertex)
    piece.centre += m_.point[w] / double(piece.vertex.size());
  for (const int32_t t : piece.element) {
    const Element& e = m_.element[t];
    for (size_t f = 0; f < 4; ++f)
      if (const auto s = outward_triangle(e.v, f); piece.has(s) && m_.counts_here(e, f)) {
        const auto p = [&](size_t k) { return m_.point[s[k]] - home; };
        volume += (m_.outward(e, f) ? 1 : -1) * dot(p(0), cross(p(1), p(2)));
      }
  }
  piece.hole = volume < 0;
  return true;
}

// How small the piece has to be, and where, to lie on the target around `to`: as large as it may.
bool Editor::fit_piece(const Piece& piece, Vec3d& to, double& scale) const {
  const double h = target_->spacing();
  const auto most_off = [&](Vec3d at, double s) {
    double most = 0;
    for (const int32_t w : piece.vertex)
      most = std::max(most, off_at(at + s * (m_.point[w] - piece.centre)).value_or(1e30));
    return most;
  };
  double best = 1e30;
  const Vec3d from = to;
  for (double s = 1; s > 0.005 && best > 0.8; s *= 0.9) {
    Vec3d x = from;
    double now = most_off(x, s);
    for (double step = 0.2 * h; step > 1e-3 * h; step *= 0.5)
      for (bool again = true; again;) {
        again = false;
        for (int d = 0; d < 6; ++d) {
          Vec3d y = x;
          y[d / 2] += d % 2 ? step : -step;
          if (const double off = most_off(y, s); off < 0.99 * now)
            now = off, x = y, again = true;
        }
      }
    if (now < best)
      best = now, to = x, scale = s;
  }
  return scale < 0.9;
}

bool Editor::nest(int32_t v, double ratio) {
  Piece piece;
  if (!target_ || !find_piece(v, piece))
    return false;
  Vec3d to = piece.centre;
  double scale = 1;
  if (!target_->pocket(piece.centre, piece.hole, to) || !fit_piece(piece, to, scale))
    return false;
  const Vec3d c = piece.centre + (to - piece.centre) / (1 - scale);
  return find_shell(piece, c) && shrink(piece, c, scale, ratio);
}

} // namespace molmesh::optimize
