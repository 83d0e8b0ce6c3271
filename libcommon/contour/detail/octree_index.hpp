// octree_index.hpp — the hash over the octree's blocks of leaves, filled by any number of threads at once. Host and
// device.
#pragma once
#include "contour/detail/raise.hpp"
#include "contour/octree.hpp"
#include <bit>

namespace molmesh::contour::detail {

/// Where two blocks want one slot the lower number has it, as if they had come one by one in ascending order.
struct IndexBlocks {
  const OctreeView::Block* block;
  uint32_t* slot;
  uint64_t mask;
  HD void operator()(int64_t i) const {
    auto b = static_cast<uint32_t>(i);
    for (uint64_t s = OctreeView::mix(block[b].key) & mask; b != OctreeView::free_slot; s = (s + 1) & mask)
      if (const uint32_t was = lower(slot[s], b); was > b)
        b = was; // goes on from here in its stead
  }
};

/// Slots for the tree's n blocks, in the launcher's memory; the tree gets to know them.
template <class Launcher>
auto index_blocks(Launcher& m, int64_t n, OctreeView& tree) {
  const auto capacity = static_cast<int64_t>(std::bit_ceil(static_cast<uint64_t>(n < 8 ? 16 : 2 * n)));
  auto slot = m.filled(capacity, OctreeView::free_slot);
  tree.slot = slot.data();
  tree.mask = static_cast<uint64_t>(capacity) - 1;
  m.for_n("index blocks", n, IndexBlocks{tree.block, slot.data(), tree.mask}, {double(n) * 12});
  return slot;
}

} // namespace molmesh::contour::detail
