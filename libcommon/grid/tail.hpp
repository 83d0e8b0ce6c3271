// tail.hpp — how fast a density falls beyond what a file holds of it.
#pragma once
#include <algorithm>
#include <cmath>

namespace molmesh {

/// G(x) ≤ exp(log - decay·(d² + 2·radius·d)) with d = max(0, D - depth), where D (Å) is the distance of x from the
/// nearest grid point that is active or inside (docs/theory/field.md §8).
struct Tail {
  double log = 0;
  double decay = 0;  ///< Å⁻²; 0: nothing is known
  double radius = 0; ///< Å
  double depth = 0;  ///< Å
  bool known() const { return decay > 0; }
  /// At the distance D.
  double bound(double distance) const {
    const double d = std::max(0.0, distance - depth);
    return std::exp(log - decay * (d * d + 2 * radius * d));
  }
  /// The least D from which on the bound is at most `value`.
  double distance(double value) const {
    const double c = (log - std::log(value)) / decay; // d² + 2·radius·d ≥ c
    return c <= 0 ? 0 : std::sqrt(radius * radius + c) - radius + depth;
  }
};

} // namespace molmesh
