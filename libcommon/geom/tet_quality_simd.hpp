// tet_quality_simd.hpp — tet_quality of eight elements, vectorized for the best instruction set of this machine.
#pragma once
#include "geom/tet_quality.hpp"
#include <algorithm>
#include <cstddef>
#include <cstring>

namespace molmesh {

/// Corner i of eight elements at [i][0 … 7].
struct alignas(64) EightElements {
  double x[4][8], y[4][8], z[4][8];

  void set(size_t element, size_t corner, Vec3d p) {
    x[corner][element] = p.x, y[corner][element] = p.y, z[corner][element] = p.z;
  }
  Vec3d corner(size_t element, size_t i) const { return {x[i][element], y[i][element], z[i][element]}; }
  /// Of as many elements as V has lanes, from `first` on.
  template <class V>
  __attribute__((always_inline)) void load(int first, Corners<V>& p) const {
    for (int i = 0; i < 4; ++i) {
      std::memcpy(&p.x[i], x[i] + first, sizeof(V));
      std::memcpy(&p.y[i], y[i] + first, sizeof(V));
      std::memcpy(&p.z[i], z[i] + first, sizeof(V));
    }
  }
};

/// As tet_quality, to the last bit.
void qualities(const EightElements& e, float (&quality)[8], double shape = shape_weight);

/// visit(k, quality) for the elements k in [0, n), ascending, until it says false; false then. corner(k, i): a
/// place.
template <class Corner, class Visit>
bool judge_each(size_t n, Corner&& corner, Visit&& visit, double shape = shape_weight) {
  EightElements eight{};
  for (size_t first = 0; first < n; first += 8) {
    const size_t end = std::min(first + 8, n);
    for (size_t k = first; k < end; ++k)
      for (size_t i = 0; i < 4; ++i)
        eight.set(k - first, i, corner(k, i));
    float quality[8];
    qualities(eight, quality, shape);
    for (size_t k = first; k < end; ++k)
      if (!visit(k, quality[k - first]))
        return false;
  }
  return true;
}

} // namespace molmesh
