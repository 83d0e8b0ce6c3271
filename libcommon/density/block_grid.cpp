// block_grid.cpp — the block hash (open addressing, at most half full).
#include "density/block_grid.hpp"

namespace molmesh {
namespace {

uint64_t hash(Vec3i corner) {
  const auto u = [](int32_t c) { return static_cast<uint64_t>(static_cast<uint32_t>(c >> 3)); };
  uint64_t h =
      u(corner.x) * 0x9E3779B97F4A7C15u ^ u(corner.y) * 0xC2B2AE3D27D4EB4Fu ^ u(corner.z) * 0x165667B19E3779F9u;
  return h ^ (h >> 29);
}

} // namespace

BlockIndex::BlockIndex(const BlockGrid& grid) {
  uint64_t capacity = 16;
  while (capacity < 2 * (grid.corner.size() + grid.inside.size()))
    capacity *= 2;
  key_.resize(capacity);
  block_.assign(capacity, outside);
  mask_ = capacity - 1;
  const auto insert = [this](Vec3i corner, int64_t block) {
    uint64_t i = hash(corner) & mask_;
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

int64_t BlockIndex::find(Vec3i p) const {
  const Vec3i corner = block_corner(p);
  for (uint64_t i = hash(corner) & mask_; block_[i] != outside; i = (i + 1) & mask_)
    if (key_[i] == corner)
      return block_[i];
  return outside;
}

float value_at(const BlockGrid& grid, const BlockIndex& index, Vec3i p) {
  const int64_t b = index.find(p);
  if (b == BlockIndex::outside)
    return 0;
  if (b == BlockIndex::inside)
    return static_cast<float>(grid.info.inside_value);
  return grid.value[static_cast<size_t>(512 * b + slot(p))];
}

bool is_active(const BlockGrid& grid, const BlockIndex& index, Vec3i p) {
  const int64_t b = index.find(p);
  if (b < 0)
    return false;
  const int s = slot(p);
  return grid.active[static_cast<size_t>(8 * b + (s >> 6))] >> (s & 63) & 1;
}

} // namespace molmesh
