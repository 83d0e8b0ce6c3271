// octree.cpp — the octree's index over leaves, built on the host.
#include "contour/octree/octree.hpp"
#include "contour/octree/octree_index.hpp"
#include "par/launcher.hpp"
#include <utility>

namespace molmesh::contour {

Octree::Octree(Vec3i cells, LeafList leaves, int threads)
    : key(std::move(leaves.key)), level(std::move(leaves.level)), block_(std::move(leaves.block)),
      large_(std::move(leaves.large)) {
  par::HostLauncher launcher(threads);
  view_.key = key.data();
  view_.level = level.data();
  view_.leaves = static_cast<int32_t>(key.size());
  view_.cells = cells;
  view_.block = block_.data();
  view_.large = large_.data();
  view_.large_leaves = static_cast<int32_t>(large_.size());
  slot_ = index_leaves(launcher, static_cast<int64_t>(block_.size()), view_);
}

} // namespace molmesh::contour
