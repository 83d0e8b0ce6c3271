// band.cpp — unpacks the band.
#include "grid/band.hpp"
#include "grid/pack_simd.hpp"
#include "par/par.hpp"
#include <algorithm>

namespace molmesh {

const float* active_values(const BandBlock& block, BlockValues& room) {
  if (block.stored == block.active)
    return block.value;
  pack_part(block.value, block.stored.data(), block.active.data(), room.data());
  return room.data();
}

namespace {

/// All 512 points of a block; inactive ones hold their side's value.
void unpack(const BandBlock& block, double inside_value, float* out) {
  BlockValues room;
  const float* active = active_values(block, room);
  for (size_t s = 0; s < 512; ++s) {
    const uint64_t bit = uint64_t{1} << (s & 63);
    out[s] = block.active[s >> 6] & bit  ? *active++
             : block.above[s >> 6] & bit ? static_cast<float>(inside_value)
                                         : 0.0f;
  }
}

} // namespace

BlockGrid to_block_grid(const Band& band, int threads) {
  const size_t n = band.block.size();
  BlockGrid grid;
  grid.frame = band.frame;
  grid.info = band.info;
  grid.inside = band.inside;
  grid.corner.resize(n);
  grid.value.resize(512 * n);
  grid.active.resize(8 * n);
  par::for_n(static_cast<int64_t>(n), threads, 512, [&](int64_t i) {
    const auto b = static_cast<size_t>(i);
    const BandBlock& block = band.block[b];
    grid.corner[b] = block.corner;
    unpack(block, band.info.inside_value, &grid.value[512 * b]);
    std::copy(block.active.begin(), block.active.end(), &grid.active[8 * b]);
  });
  return grid;
}

namespace {

/// above(s): is point s of the block at `corner` above the isovalue?
template <class Above>
bool cut(const GridFrame& frame, Vec3i corner, Above&& above) {
  const Vec3i lo = frame.lower, last = lo + frame.points - Vec3i{1, 1, 1};
  for (int s = 0; s < 512; ++s) {
    const Vec3i p = corner + within_block(s);
    const bool wall = p.x == lo.x || p.y == lo.y || p.z == lo.z || p.x == last.x || p.y == last.y || p.z == last.z;
    if (wall && above(s))
      return true;
  }
  return false;
}

} // namespace

bool wall_cuts_surface(const GridFrame& frame, const FieldInfo& info, BandBlocks blocks) {
  return std::any_of(blocks.begin(), blocks.end(), [&](const BandBlock& b) {
    float value[512];
    unpack(b, info.inside_value, value);
    return cut(frame, b.corner, [&](int s) { return value[s] > info.isovalue; });
  });
}

bool wall_cuts_surface(const GridFrame& frame, std::span<const Vec3i> inside) {
  return std::any_of(inside.begin(), inside.end(),
                     [&](Vec3i c) { return cut(frame, c, [](int) { return true; }); });
}

} // namespace molmesh
