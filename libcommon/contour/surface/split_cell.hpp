// split_cell.hpp — an ambiguous cell split into tetrahedra and pyramids. Section 4.1 of Liao et al. 2013, their
// reference 51. Host and device.
#pragma once
#include "contour/surface/ambiguous_cell.hpp"
#include <cstddef>

namespace molmesh::contour {

/// Of a leaf.
enum class Side : uint8_t { outside, inside, crossed };

/// A boundary polygon of a split cell, counter-clockwise seen from outside the piece of the cell that its apex
/// closes.
struct Patch {
  int face;      ///< cell face it lies on, or -1 for the cut below a chopped corner
  int n;         ///< 3 or 4 corners
  int corner[4]; ///< cell corners
  int piece;     ///< piece of the cell behind it; -1: the chopped corner
};

/// A fine cell that the surface crosses in more than one component: one piece (pyramid or tetrahedron) per patch,
/// with the cell's centre as apex; a chopped corner is one more piece.
struct SplitCell {
  /// 6 faces in at most two, and the cut.
  struct Patches {
    Patch item[13];
    int n = 0;
    MOLMESH_HD const Patch* begin() const { return item; }
    MOLMESH_HD const Patch* end() const { return item + n; }
  };
  CellTopology topology;
  Patches patch;
  int pieces = 0; ///< without the chopped corner

  MOLMESH_HD explicit SplitCell(const CellTopology& t) : topology(t) {
    for (int f = 0; f < 6; ++f) {
      const int c[4] = {face_corner_of(f, 0), face_corner_of(f, 1), face_corner_of(f, 2), face_corner_of(f, 3)};
      if (t.diagonal[f] == Diagonal::none) {
        add({f, 4, {c[0], c[1], c[2], c[3]}, 0});
      } else {
        const int s = t.diagonal[f] == Diagonal::even ? 0 : 1;
        add({f, 3, {c[s], c[s + 1], c[(s + 2) % 4], -1}, 0});
        add({f, 3, {c[(s + 2) % 4], c[(s + 3) % 4], c[s], -1}, 0});
      }
    }
    if (t.chop >= 0) {
      // The three neighbours, turned so that the cut is counter-clockwise seen from the chopped corner.
      const int k = t.chop, x = k ^ 1, y = k ^ 2, z = k ^ 4;
      const bool even = ((k & 1) + (k >> 1 & 1) + (k >> 2)) % 2 == 0;
      add(even ? Patch{-1, 3, {x, z, y, -1}, 0} : Patch{-1, 3, {x, y, z, -1}, 0});
    }
  }

private:
  MOLMESH_HD void add(Patch p) {
    bool chopped = false;
    for (int i = 0; p.face >= 0 && topology.chop >= 0 && i < p.n; ++i)
      chopped = chopped || p.corner[i] == topology.chop;
    p.piece = chopped ? -1 : pieces++;
    patch.item[patch.n++] = p;
  }
};

} // namespace molmesh::contour
