// numbering_items.hpp — kernels that find the leaves at the surface and number grid points and the vertices of
// split cells, in the order of their passes. Host and device.
#pragma once
#include "contour/complex/complex.hpp"
#include "geom/morton.hpp"

namespace molmesh::contour {

/// The leaf with grid point p as a corner whose fine cell there is p - step of the octant; -1: none.
MOLMESH_HD inline int32_t leaf_with_corner(NearLeaves& near, Vec3i p, int octant) {
  const int32_t leaf = near.find(p - corner_step(octant));
  return leaf >= 0 && ((p.x | p.y | p.z) & (near.tree().extent(leaf) - 1)) == 0 ? leaf : -1;
}

/// Of a surface cell: its leaf's first_cell, if this is it; -1 before.
struct ClaimLeaf {
  ComplexView c;
  MOLMESH_HD void operator()(int64_t i) const {
    const int32_t leaf = c.tree.find_key(c.cells[i].key);
    if (i == 0 || c.cells[i - 1].key < c.tree.key[leaf])
      c.first_cell[leaf] = static_cast<int32_t>(i);
  }
};

/// A grid point belongs to the last of the eight octants around it whose leaf has the point as a corner.
/// owned: [8·leaves] leaf and corner that it is there, as one number, 8·leaf + corner. first: [leaves] points
/// owned. beside: as ComplexView has it, found with the same blocks at hand.
struct OwnCorners {
  OctreeView tree;
  int32_t *owned, *first, *beside;

  MOLMESH_HD void operator()(int64_t leaf) const {
    NearLeaves near(tree);
    of_leaf(near, leaf);
  }
  /// Where many follow each other what held the last ones is known.
  void run(int64_t begin, int64_t end) const {
    NearLeaves near(tree);
    for (int64_t leaf = begin; leaf < end; ++leaf)
      of_leaf(near, leaf);
  }

private:
  MOLMESH_HD void of_leaf(NearLeaves& near, int64_t leaf) const {
    int32_t own = 1;
    owned[8 * leaf] = static_cast<int32_t>(8 * leaf);
    for (int c = 1; c < 8; ++c) {
      const int32_t o = owner(near, static_cast<int32_t>(leaf), c);
      owned[8 * leaf + c] = o;
      own += o == 8 * leaf + c;
    }
    first[leaf] = own;
    for (int f = 0; f < 6; ++f)
      beside[6 * leaf + f] = near.neighbour(static_cast<int32_t>(leaf), f);
  }
  MOLMESH_HD int32_t owner(NearLeaves& near, int32_t leaf, int c) const {
    const int level = tree.level[leaf];
    uint64_t k = tree.key[leaf];
    for (int a = 0; a < 3; ++a)
      if (c >> a & 1)
        k = morton_after(k, a, level);
    int before = 0, after = 0; // bit a: the domain goes on there
    for (int a = 0; a < 3; ++a) {
      before |= int((k & morton_axis(a)) != 0) << a;
      after |= int(tree.before_end(k, a)) << a;
    }
    if (after == 7)
      if (const int32_t last = near.starting_at(k); last >= 0)
        return 8 * last;
    for (int octant = 1; octant < 8; ++octant) {
      if ((octant & ~before) | (~octant & ~after & 7))
        continue;
      uint64_t q = k;
      for (int a = 0; a < 3; ++a)
        if (octant >> a & 1)
          q = morton_before(q, a);
      const int32_t other = near.find_key(q);
      if ((k & ((uint64_t{1} << 3 * tree.level[other]) - 1)) ==
          0) // the point is as far from the leaf's lower corner
        return 8 * other + octant;
    }
    return 8 * leaf + c; // not reached: the leaf's own octant is one of them
  }
};

/// first: scanned.
struct NumberCorners {
  ComplexView c;
  const int32_t *owned, *first;
  MOLMESH_HD void operator()(int64_t i) const {
    const auto leaf = static_cast<int32_t>(i);
    int32_t id = first[leaf];
    for (int k = 0; k < 8; ++k) {
      if (owned[8 * i + k] != 8 * i + k)
        continue;
      const Vec3i p = c.tree.corner(leaf) + c.tree.extent(leaf) * corner_step(k);
      c.grid_vertex[8 * i + k] = id;
      c.point[id] = p;
      c.position[id] = c.lattice.position(p);
      c.value[id] = c.lattice.value(p);
      ++id;
    }
  }
};
/// And the leaf's side.
struct ShareCorners {
  ComplexView c;
  const int32_t* owned;
  MOLMESH_HD void operator()(int64_t i) const {
    const bool crossed = c.first_cell[i] >= 0;
    c.side[i] = crossed ? Side::crossed : c.inside(c.grid_vertex[8 * i]) ? Side::inside : Side::outside;
    for (int k = 0; k < 8; ++k)
      if (owned[8 * i + k] != 8 * i + k) // an owner's own entry does not change here
        c.grid_vertex[8 * i + k] = c.grid_vertex[owned[8 * i + k]];
  }
};

/// extra: [leaves] vertices of a split cell: its centre, a dual vertex for each piece.
struct CountPieces {
  ComplexView c;
  int32_t* extra;
  MOLMESH_HD void operator()(int64_t i) const {
    extra[i] = 0;
    if (c.first_cell[i] < 0 || c.tree.level[i] > 0)
      return;
    const CellTopology t = c.topology(static_cast<int32_t>(i));
    if (t.split())
      extra[i] = 1 + SplitCell(t).pieces + (t.chop >= 0);
  }
};
/// extra: scanned, [leaves] + 1.
struct NumberPieces {
  ComplexView c;
  const int32_t* extra;
  MOLMESH_HD void operator()(int64_t i) const {
    const int32_t first = c.dual0 + c.tree.leaves;
    c.split[i] = extra[i + 1] > extra[i] ? first + extra[i] : -1;
    for (int32_t k = extra[i]; k < extra[i + 1]; ++k) {
      c.split_leaf[k] = static_cast<int32_t>(i);
      c.value[first + k] = c.lattice.isovalue;
    }
    c.value[c.dual(static_cast<int32_t>(i))] = c.lattice.isovalue;
  }
};

} // namespace molmesh::contour
