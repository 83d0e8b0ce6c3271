// octree_index.hpp — the hash over the octree's blocks of leaves and larger leaves, filled by any number of threads
// at once. Host and device.
#pragma once
#include "contour/octree/octree.hpp"
#include "par/atomic_updates.hpp"
#include "par/launcher.hpp"
#include <bit>

namespace molmesh::contour {

/// Block i, or large leaf i - blocks. Where two want one slot the lower number has it, as if they had come one by
/// one in ascending order.
struct IndexEntries {
  OctreeView tree;
  int64_t blocks;
  uint32_t* slot;
  MOLMESH_HD void operator()(int64_t i) const {
    auto e = i < blocks ? static_cast<uint32_t>(i)
                        : OctreeView::of_large + static_cast<uint32_t>(tree.large[i - blocks]);
    for (uint64_t s = OctreeView::mix(tree.entry_key(e)) & tree.mask; e != OctreeView::free_slot;
         s = (s + 1) & tree.mask)
      if (const uint32_t was = par::lower(slot[s], e); was > e)
        e = was; // goes on from here in its stead
  }
};

/// Slots for the tree's blocks and large leaves, in the launcher's memory; the tree gets to know them,
/// and its ends.
template <par::Launcher Launcher>
auto index_leaves(Launcher& m, int64_t blocks, OctreeView& tree) {
  const int64_t n = blocks + tree.large_leaves;
  const auto capacity = static_cast<int64_t>(std::bit_ceil(static_cast<uint64_t>(n < 8 ? 16 : 2 * n)));
  auto slot = m.filled(capacity, OctreeView::free_slot);
  for (int a = 0; a < 3; ++a)
    tree.end[a] = morton_spread(static_cast<uint32_t>(tree.cells[a])) << a;
  tree.slot = slot.data();
  tree.mask = static_cast<uint64_t>(capacity) - 1;
  m.for_n("index leaves", n, IndexEntries{tree, blocks, slot.data()}, {double(n) * 12});
  return slot;
}

} // namespace molmesh::contour
