// search.hpp — pattern search for the place of one vertex where its worst element is best.
// The worst quality is not smooth where two elements tie, so steps are tried, not derived: first along the gradient
// of the worst element, then along a fixed set of directions, with halving step lengths.
#pragma once
#include "improve/quality.hpp"
#include <array>
#include <utility>
#include <vector>

namespace molmesh::improve {

/// The elements at a vertex that moves, or that a new vertex would make.
class Spokes {
public:
  void clear() { tet_.clear(); }
  void add(const std::array<Vec3d, 4>& p, int moving) { tet_.push_back({p, moving}); }
  size_t size() const { return tet_.size(); }
  /// Smallest quality with the vertex at x, or some value ≤ above as soon as one element is no better than that.
  /// The element that decided moves one place forward: it is the likely one next time.
  float worst(Vec3d x, float above) {
    float w = 2;
    for (size_t i = 0; i < tet_.size(); ++i) {
      const float q = quality(tet_[i], x);
      if (q < w) {
        w = q;
        if (i > 0)
          std::swap(tet_[i], tet_[i - 1]);
        if (w <= above)
          return w;
      }
    }
    return w;
  }
  /// Direction (unit) in which the worst element at x improves fastest; zero when flat.
  Vec3d ascent(Vec3d x, double step) {
    size_t worst = 0;
    float w = 2;
    for (size_t i = 0; i < tet_.size(); ++i)
      if (const float q = quality(tet_[i], x); q < w)
        w = q, worst = i;
    std::swap(tet_[0], tet_[worst]);
    Vec3d g;
    for (int a = 0; a < 3; ++a) {
      Vec3d y = x, z = x;
      y[a] += step;
      z[a] -= step;
      g[a] = double(quality(tet_[0], y)) - double(quality(tet_[0], z));
    }
    const double length = norm(g);
    return length > 0 ? g / length : Vec3d{};
  }

private:
  struct Tet {
    std::array<Vec3d, 4> p;
    int moving;
  };
  static float quality(const Tet& t, Vec3d x) {
    auto p = t.p;
    p[size_t(t.moving)] = x;
    return tet_quality(p[0], p[1], p[2], p[3]);
  }
  std::vector<Tet> tet_;
};

/// Raises best = spokes.worst(x) by moving x until it reaches the goal or no step helps. `basis`: up to three
/// orthonormal directions to search. constrain(y) moves a trial onto what the vertex is bound to, or refuses;
/// accept(y) has the last word.
template <class Constrain, class Accept>
bool pattern_search(Spokes& spokes, Vec3d& x, float& best, float goal, double length, const Vec3d* basis,
                    int dimensions, Constrain constrain, Accept accept) {
  std::array<Vec3d, 14> direction;
  int directions = 0;
  for (int a = 0; a < dimensions; ++a) {
    direction[size_t(directions++)] = basis[a];
    direction[size_t(directions++)] = -basis[a];
  }
  if (dimensions == 2)
    for (int k = 0; k < 4; ++k)
      direction[size_t(directions++)] =
          std::sqrt(0.5) * ((k & 1 ? 1. : -1.) * basis[0] + (k & 2 ? 1. : -1.) * basis[1]);
  if (dimensions == 3)
    for (int k = 0; k < 8; ++k)
      direction[size_t(directions++)] =
          std::sqrt(1. / 3) *
          ((k & 1 ? 1. : -1.) * basis[0] + (k & 2 ? 1. : -1.) * basis[1] + (k & 4 ? 1. : -1.) * basis[2]);
  const auto try_step = [&](Vec3d d, double step) {
    Vec3d y = x + step * d;
    if (!constrain(y))
      return false;
    const float above = best + 1e-5f + 1e-3f * best;
    const float q = spokes.worst(y, above);
    if (q <= above || !accept(y))
      return false;
    x = y;
    best = q;
    return true;
  };
  bool moved = false;
  for (double step = 0.25 * length; step > 0.01 * length && best < goal; step *= 0.5) {
    bool again = true;
    for (int round = 0; again && round < 6 && best < goal; ++round) {
      again = false;
      Vec3d g = spokes.ascent(x, 1e-4 * length), tangent;
      for (int a = 0; a < dimensions; ++a)
        tangent += dot(g, basis[a]) * basis[a];
      const double t = norm(tangent);
      if (t > 0.1 && try_step(tangent / t, step)) {
        again = moved = true;
        continue;
      }
      for (int d = 0; d < directions && !again; ++d)
        while (best < goal && try_step(direction[size_t(d)], step))
          again = moved = true;
    }
  }
  return moved;
}

} // namespace molmesh::improve
