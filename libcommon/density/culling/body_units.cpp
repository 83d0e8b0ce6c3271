// body_units.cpp — bounds bodies without atoms over boxes, and has atoms stand for them in blocks (field.md §7).
#include "density/culling/block_atoms.hpp"
#include <algorithm>
#include <cmath>
#include <numbers>

namespace molmesh::density {

/// Overwrites the bounds of those units of near_ that are bodies: the core lies behind the plane through its place
/// nearest to the box's middle, and the box cannot reach it by more than its extent across that plane.
void BlockAtoms::bound_bodies(const LocalBox& part, float* log2_upper) const {
  if (f_.body.empty())
    return;
  const Vec3d m = brick_middle_ + Vec3d{part.middle[0], part.middle[1], part.middle[2]};
  for (size_t u = 0; u < static_cast<size_t>(near_.n); ++u) {
    const int32_t local = near_.cluster[near_.begin[u]], body = local_body(local);
    if (body < 0)
      continue;
    const Vec3d across = m - f_.body[body].core.nearest(m);
    const double d = norm(across);
    double least = d;
    for (int a = 0; a < 3 && d > 0; ++a)
      least -= std::abs(across[a]) / d * part.half[a];
    least = std::max(least, 0.0);
    const double ln = f_.ln_peak[local_.cluster[local]] - f_.decay * least * least;
    log2_upper[u] = static_cast<float>(std::max(std::numbers::log2e * ln, -1e30));
  }
}

/// Does one body alone, raised up the levels, surely keep G above the band? Its core is convex, and so the distance
/// from it is largest at a corner.
bool BlockAtoms::inside_a_body(Vec3d middle, Vec3d half) const {
  if (f_.body.empty())
    return false;
  const double total = budget_.total();
  for (size_t u = 0; u < static_cast<size_t>(near_.n); ++u) {
    const int32_t local = near_.cluster[near_.begin[u]], body = local_body(local);
    if (body < 0)
      continue;
    double farthest = 0, power = 1;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3d at = middle + Vec3d{corner & 4 ? half.x : -half.x, corner & 2 ? half.y : -half.y,
                                      corner & 1 ? half.z : -half.z};
      farthest = std::max(farthest, f_.body[body].core.distance2(at));
    }
    int64_t g = near_.group[u];
    for (const FieldLevel& l : f_.level) {
      power *= l.exponent[g];
      if (!l.parent.empty())
        g = l.parent[g];
    }
    const double least = power * (f_.ln_peak[local_.cluster[local]] - f_.decay * farthest);
    if (std::exp(least) * (1 - 4 * total - single) > upper_ + 4 * total)
      return true;
  }
  return false;
}

/// Moves the atoms that stand for the bodies to the places of the cores that are nearest to the block's middle.
void BlockAtoms::place_bodies(Vec3d middle) {
  for (size_t i = 0; i < local_body_.size(); ++i)
    if (local_body_[i] >= 0) {
      const Vec3d at = f_.body[local_body_[i]].core.nearest(middle) - brick_middle_;
      local_.atom_x[16 * i] = static_cast<float>(at.x);
      local_.atom_y[16 * i] = static_cast<float>(at.y);
      local_.atom_z[16 * i] = static_cast<float>(at.z);
    }
}

void BlockAtoms::list_bodies() {
  unit_bodies.clear();
  if (f_.body.empty())
    return;
  for (int32_t u = 0; u < block_units.n; ++u)
    if (const int32_t body = local_body(near_.cluster[near_.begin[kept_[u]]]); body >= 0)
      unit_bodies.push_back({u, body, f_.body[body].core.nearest(block_middle)});
}

} // namespace molmesh::density
