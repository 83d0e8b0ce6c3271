// octree.hpp — a strongly balanced linear octree over the lattice: leaves along the Z-order curve.
// Section 4.1 of Liao et al. 2013. Neighbours across faces, edges and corners differ by one level at most.
#pragma once
#include "geom/vec.hpp"
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace molmesh::contour {

/// Called once for each level 1 … top, with the nodes of that level that have children already for balance: Morton
/// keys of the lower corner shifted right by 3·level. Appends those that must have them too.
using Refine = std::function<void(int level, std::vector<uint64_t>& nodes)>;

class Octree {
public:
  /// cells: size of the domain in fine cells; leaves never reach beyond it.
  Octree(Vec3i cells, int top_level, const Refine& refine, int threads);

  int32_t size() const { return static_cast<int32_t>(key.size()); }
  /// The leaf that holds fine cell p, or -1 beyond the domain.
  int32_t find(Vec3i p) const;
  Vec3i corner(int32_t leaf) const { return corner_[static_cast<size_t>(leaf)]; } ///< lower corner, lattice point
  int32_t extent(int32_t leaf) const { return 1 << level[static_cast<size_t>(leaf)]; } ///< fine cells along an edge

  std::vector<uint64_t> key;  ///< ascending; Morton code of the lower corner
  std::vector<uint8_t> level; ///< 0: fine cell

private:
  struct Block { ///< 8³ fine cells that hold leaves below level 3
    uint64_t key;
    int32_t first;                 ///< first leaf
    std::array<uint64_t, 8> start; ///< bit m: a leaf starts at Morton position m within the block
    std::array<uint16_t, 8> rank;  ///< leaves that start in the words before
  };
  void index_leaves();
  Vec3i cells_;
  std::vector<Vec3i> corner_; ///< [leaves]
  std::vector<Block> block_;
  std::vector<int32_t> slot_; ///< open addressing into block_, -1 free
  uint64_t mask_ = 0;
  std::vector<int32_t> large_; ///< leaves of level 3 and more, ascending
};

} // namespace molmesh::contour
