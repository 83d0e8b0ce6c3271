// weighted_star.hpp — Spokes of a star's elements, those apart that nobody asks for.
#pragma once
#include "contour/relaxation/relax_items.hpp"
#include "geom/star_quality.hpp"
#include <algorithm>
#include <array>

namespace molmesh::contour {

/// What pattern_search asks; quality counts as in detail::Qualities.
class WeightedSpokes {
public:
  static constexpr int most_places = Spokes::most_places;
  void clear(Vec3d origin, double shape) {
    asked_.clear(origin, shape);
    other_.clear(origin, shape);
  }
  void add(const std::array<Vec3d, 4>& p, int moving, bool is_asked) {
    (is_asked ? asked_ : other_).add(p, moving);
  }
  float worst(Vec3d x, float above) {
    const float w = asked_.worst(x, above);
    return w > above && other_.size() > 0 ? std::min(w, worst_other(x, above)) : w;
  }
  Vec3d ascent(Vec3d x, double step) {
    float asked = none, other = none;
    const Vec3d of_asked = asked_.size() > 0 ? asked_.ascent(x, step, &asked) : Vec3d{};
    const Vec3d of_other = other_.size() > 0 ? other_.ascent(x, step, &other) : Vec3d{};
    return asked <= detail::unasked_weight * other ? of_asked : of_other;
  }
  int first_above(const Vec3d* y, int from, int n, float above, float& q) {
    for (int k = from;; ++k) {
      k = asked_.first_above(y, k, n, above, q);
      if (k >= n || other_.size() == 0)
        return k;
      if (const float other = worst_other(y[k], above); other > above) {
        q = std::min(q, other);
        return k;
      }
    }
  }

private:
  static constexpr float none = 2; ///< better than any element
  float worst_other(Vec3d x, float above) {
    return detail::unasked_weight * other_.worst(x, above / detail::unasked_weight);
  }
  Spokes asked_, other_;
};

} // namespace molmesh::contour
