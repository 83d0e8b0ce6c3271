// block_grid.cpp — fills the block hash; looks up values at any index.
#include "grid/block_grid.hpp"

namespace molmesh {
BlockIndex::BlockIndex(const BlockGrid& grid) {
  uint64_t capacity = 16;
  while (capacity < 2 * (grid.corner.size() + grid.inside.size()))
    capacity *= 2;
  key_.resize(capacity);
  block_.assign(capacity, outside);
  mask_ = capacity - 1;
  const auto insert = [this](Vec3i corner, int64_t block) {
    uint64_t i = BlockIndexView::hash(corner) & mask_;
    while (block_[i] != outside)
      i = (i + 1) & mask_;
    key_[i] = corner;
    block_[i] = block;
  };
  for (size_t b = 0; b < grid.corner.size(); ++b)
    insert(grid.corner[b], static_cast<int64_t>(b));
  for (const Vec3i& corner : grid.inside)
    insert(corner, inside);
}

float value_at(const BlockGrid& grid, const BlockIndex& index, Vec3i p) {
  const int64_t b = index.find(p);
  if (b == BlockIndex::outside)
    return 0;
  if (b == BlockIndex::inside)
    return static_cast<float>(grid.info.inside_value);
  return grid.value[512 * b + slot(p)];
}

bool is_active(const BlockGrid& grid, const BlockIndex& index, Vec3i p) {
  const int64_t b = index.find(p);
  if (b < 0)
    return false;
  const int s = slot(p);
  return grid.active[8 * b + (s >> 6)] >> (s & 63) & 1;
}

} // namespace molmesh
