// block_window.hpp — the 9³ points, or fewer, of 8³ cells of the lattice: which are inside or active, as rows of
// bits, and their values.
#pragma once
#include "contour/octree/lattice.hpp"

namespace molmesh::contour {

class BlockWindow {
public:
  /// corner: lattice point; cells: 8 at most along each axis, whose points are read
  MOLMESH_HD BlockWindow(const LatticeView& lattice, Vec3i corner, int cells = 8)
      : lattice_(lattice), corner_(corner) {
    const Vec3i first = lattice.base + corner;
    offset_ = {first.x & 7, first.y & 7, first.z & 7};
    const int needed = (offset_.x + cells) >> 3 | (offset_.y + cells) >> 3 << 1 | (offset_.z + cells) >> 3 << 2;
    for (int n = 0; n < 8; ++n)
      block_[n] =
          (n & needed) == n ? lattice.index.find(first + 8 * Vec3i{n & 1, n >> 1 & 1, n >> 2}) : block_[n & needed];
  }
  /// No block of the grid holds one of the points, and all are on one side.
  MOLMESH_HD bool one_sided() const {
    for (int n = 0; n < 8; ++n)
      if (block_[n] >= 0 || block_[n] != block_[0])
        return false;
    return !lattice_.any_cut;
  }
  /// Bit z of row (x, y), each 0 … 8.
  MOLMESH_HD uint32_t inside(int x, int y) const {
    uint32_t bits = row(lattice_.inside_words, x, y, true);
    if (lattice_.any_cut)
      for (int z = 0; z < 9; ++z)
        if (const Vec3i p = corner_ + Vec3i{x, y, z}; lattice_.on_cut(p))
          bits = (bits & ~(1u << z)) | uint32_t{lattice_.value(p) > lattice_.isovalue} << z;
    return bits;
  }
  /// At the corners c = x + 2 y + 4 z of the cell there, 0 … 7 along each axis.
  MOLMESH_HD void corner_values(Vec3i cell, float v[8]) const {
    const Vec3i first = offset_ + cell;
    const auto block_of = [&](Vec3i p) { return block_[p.x >> 3 | p.y >> 3 << 1 | p.z >> 3 << 2]; };
    const int64_t b = block_of(first);
    if (b >= 0 && !lattice_.any_cut && (first.x & 7) < 7 && (first.y & 7) < 7 && (first.z & 7) < 7) {
      const float* const at = lattice_.grid + 512 * b + slot(first);
      for (int c = 0; c < 8; ++c)
        v[c] = at[(c & 1) << 6 | (c >> 1 & 1) << 3 | c >> 2];
      return;
    }
    for (int c = 0; c < 8; ++c) {
      const Vec3i step{c & 1, c >> 1 & 1, c >> 2};
      v[c] = lattice_.any_cut ? lattice_.value(corner_ + cell + step)
                              : lattice_.value_in(block_of(first + step), first + step);
    }
  }
  MOLMESH_HD uint32_t active(int x, int y) const { return row(lattice_.active_words, x, y, false); }

private:
  /// `constant`: what points of inside blocks have.
  MOLMESH_HD uint32_t row(const uint64_t* words, int x, int y, bool constant) const {
    const int px = offset_.x + x, py = offset_.y + y, n = px >> 3 | py >> 3 << 1;
    const auto byte = [&](int64_t block) {
      return block >= 0 ? static_cast<uint32_t>(words[8 * block + (px & 7)] >> 8 * (py & 7)) & 0xFF
             : constant && block == BlockIndexView::inside ? 0xFFu
                                                           : 0u;
    };
    return (byte(block_[n]) | byte(block_[n | 4]) << 8) >> offset_.z & 0x1FF;
  }
  const LatticeView& lattice_;
  Vec3i corner_, offset_;
  int64_t block_[8];
};

} // namespace molmesh::contour
