// candidate_atoms.cpp — gathers the clusters near a brick, and their units near a part of it.
#include "density/culling/block_atoms.hpp"
#include <algorithm>

namespace molmesh::density {

void BlockAtoms::enter(Vec3d middle, std::span<const int32_t> clusters) {
  brick_middle_ = middle;
  const size_t n = clusters.size(), padded = (n + 15) / 16 * 16;
  LocalClusters& l = local_;
  l.cluster.assign(clusters.begin(), clusters.end());
  l.group.resize(n);
  l.exponent.resize(n);
  for (AlignedFloats* v : {&l.lo_x, &l.lo_y, &l.lo_z, &l.hi_x, &l.hi_y, &l.hi_z, &l.cutoff2})
    v->resize(padded);
  for (AlignedFloats* v : {&l.atom_x, &l.atom_y, &l.atom_z, &l.atom_peak})
    v->resize(16 * n);
  for (size_t i = 0; i < n; ++i) {
    const auto c = static_cast<size_t>(clusters[i]);
    l.group[i] = f_.group[c];
    l.exponent[i] = static_cast<float>(f_.level[0].exponent[f_.group[c]]);
    const Vec3d lo = f_.box[c].lo - middle, hi = f_.box[c].hi - middle;
    l.lo_x[i] = static_cast<float>(lo.x), l.lo_y[i] = static_cast<float>(lo.y),
    l.lo_z[i] = static_cast<float>(lo.z);
    l.hi_x[i] = static_cast<float>(hi.x), l.hi_y[i] = static_cast<float>(hi.y),
    l.hi_z[i] = static_cast<float>(hi.z);
    l.cutoff2[i] = static_cast<float>((1 + single) * f_.cutoff2[c]);
  }
  const double origin[3] = {middle.x, middle.y, middle.z};
  if (!f_.body.empty()) {
    local_body_.resize(n);
    for (size_t i = 0; i < n; ++i)
      local_body_[i] = f_.body_of(clusters[i]);
  }
  place_atoms({f_.x.data(), f_.y.data(), f_.z.data(), f_.peak.data(), f_.begin.data(), f_.x.size()},
              clusters.data(), n, origin, l);
}

/// near_: the units of the clusters of the brick that are near a part of it.
void BlockAtoms::gather(const LocalBox& part) {
  found_.resize(local_.cluster.size() + 16);
  const auto clusters =
      static_cast<size_t>(near_clusters(local_, static_cast<int32_t>(local_.cluster.size()), part, found_.data()));
  NearUnits& u = near_;
  u.begin.resize(clusters + 1);
  u.group.resize(clusters);
  u.exponent.resize(clusters + 16);
  u.cluster.resize(clusters);
  size_t n = 0;
  for (size_t i = 0; i < clusters; ++i) {
    const auto c = static_cast<size_t>(found_[i]);
    u.cluster[i] = found_[i];
    // With P = 1 a cluster can go without the others of its group.
    if (n == 0 || local_.exponent[c] == 1 || u.group[n - 1] != local_.group[c]) {
      u.exponent[n] = local_.exponent[c];
      u.group[n] = local_.group[c];
      u.begin[n++] = static_cast<int32_t>(i);
    }
  }
  u.n = static_cast<int32_t>(n);
  u.begin[n] = static_cast<int32_t>(clusters);
  std::fill_n(u.exponent.begin() + u.n, 16, 1.0f);
}

/// Forgets the units of near_ that are not kept.
void BlockAtoms::keep_only() {
  NearUnits& u = near_;
  size_t units_to = 0;
  int32_t to = 0;
  for (const int32_t k : kept()) {
    const auto n = static_cast<size_t>(k);
    const int32_t begin = u.begin[n], end = u.begin[n + 1];
    u.begin[units_to] = to;
    for (int32_t c = begin; c < end; ++c)
      u.cluster[to++] = u.cluster[c];
    u.group[units_to] = u.group[n];
    u.exponent[units_to++] = u.exponent[n];
  }
  u.n = static_cast<int32_t>(units_to);
  u.begin[units_to] = to;
  u.cluster.resize(static_cast<size_t>(to));
  std::fill_n(u.exponent.begin() + u.n, 16, 1.0f);
}

} // namespace molmesh::density
