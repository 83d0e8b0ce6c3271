// octree.cpp — the hash over the blocks of leaves.
#include "contour/octree.hpp"
#include <utility>

namespace molmesh::contour {

Octree::Octree(Vec3i cells, LeafList leaves)
    : key(std::move(leaves.key)), level(std::move(leaves.level)), block_(std::move(leaves.block)),
      large_(std::move(leaves.large)) {
  uint64_t capacity = 16;
  while (capacity < 2 * block_.size())
    capacity *= 2;
  slot_.assign(capacity, -1);
  for (size_t b = 0; b < block_.size(); ++b) {
    uint64_t s = OctreeView::mix(block_[b].key) & (capacity - 1);
    while (slot_[s] >= 0)
      s = (s + 1) & (capacity - 1);
    slot_[s] = static_cast<int32_t>(b);
  }
  view_.key = key.data();
  view_.level = level.data();
  view_.leaves = static_cast<int32_t>(key.size());
  view_.cells = cells;
  view_.block = block_.data();
  view_.slot = slot_.data();
  view_.mask = capacity - 1;
  view_.large = large_.data();
  view_.large_leaves = static_cast<int32_t>(large_.size());
}

} // namespace molmesh::contour
