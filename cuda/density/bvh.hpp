// bvh.hpp — the bounding volume hierarchy of the molecule itself (§3.2 of Liao et al. 2013): boxes of
// domains, chains, residues and their clusters of atoms, in the order of the file. What is found comes out group by
// group, so the sums of every level are formed while passing by, without a list per level. The host halves the
// grid's cubes instead (density/culling/bvh.hpp).
#pragma once
#include "density/field/field.hpp"
#include <vector>

namespace molmesh::cuda {

using density::Box;

/// A box with all clusters below it. Boxes are rounded outwards, cutoffs up: never a cluster too few.
struct BvhNode {
  Vec3f lo, hi;    ///< Å, of atoms' centres
  float cutoff2;   ///< Å², the largest of the clusters below
  int32_t skip;    ///< the next node that is not below this one
  int32_t cluster; ///< of a leaf; -1: the children follow
};

/// Depth first, children in order. Runs of consecutive children get a node of their own where there are many.
std::vector<BvhNode> bvh(const density::Field& f);

/// The field as plain views. Levels innermost first, as in density::Field.
struct FieldView {
  static constexpr int most_levels = 8;
  double decay, steepest;
  int levels; ///< that need a sum of their own: 1 when everything above the innermost level is a plain sum
  const double *x, *y, *z, *peak;
  const int64_t *begin, *group;
  const Box* box;
  const double *ln_peak, *cutoff2;
  const double* exponent[most_levels];
  const int64_t* parent[most_levels];
  const BvhNode* node;
  int32_t nodes;
};

MOLMESH_HD inline float distance2(Vec3f lo, Vec3f hi, const BvhNode& n) {
  float sum = 0;
  for (int a = 0; a < 3; ++a) {
    const float below = lo[a] - n.hi[a], above = n.lo[a] - hi[a];
    const float d = below > above ? below : above;
    sum += d > 0 ? d * d : 0;
  }
  return sum;
}

/// visit(cluster) for every cluster nearer to `box` than its cutoff, ascending, until it returns false.
template <class Visit>
MOLMESH_HD inline void for_near_clusters(const FieldView& f, const Box& box, Visit&& visit) {
  const auto down = [](double v) { return static_cast<float>(v - 2e-7 * (v < 0 ? -v : v)); };
  const auto up = [](double v) { return static_cast<float>(v + 2e-7 * (v < 0 ? -v : v)); };
  const Vec3f lo{down(box.lo.x), down(box.lo.y), down(box.lo.z)}, hi{up(box.hi.x), up(box.hi.y), up(box.hi.z)};
  for (int32_t i = 0; i < f.nodes;) {
    const BvhNode& n = f.node[i];
    if (!(distance2(lo, hi, n) * 0.999999f < n.cutoff2)) {
      i = n.skip;
      continue;
    }
    ++i;
    if (n.cluster < 0)
      continue;
    if (density::distance2(box, f.box[n.cluster]) < f.cutoff2[n.cluster] && !visit(n.cluster))
      return;
  }
}

} // namespace molmesh::cuda
