// face_balance.hpp — kernels that find the nodes with children: for the octree's balance across faces, where the
// surface passes near a face of smaller cells, and in a uniform region. Neighbours across faces differ by one level
// at most. The octree of section 4.1 of Liao et al. 2013 is balanced across edges and corners too, which no element
// needs (docs/theory/meshing.md §5). Host and device.
#pragma once
#include "contour/octree/node_mask.hpp"
#include "contour/surface/block_window.hpp"

namespace molmesh::contour {

/// Of a uniform mesh: nodes of level 1 in the grid that touch a wanted region. Block i of a box.
struct UniformNodes {
  LatticeView l;
  BlockBox box;
  Vec3i first, last; ///< nodes that meet the grid
  bool inside, outside;

  MOLMESH_HD int64_t operator()(int64_t i, par::KeyedWord* out) const {
    const Vec3i b = box.block(i), corner = 8 * b, points = l.cells - corner; // the last point
    const BlockWindow window(l, corner);
    if (!outside && window.one_sided() && !(window.inside(0, 0) & 1))
      return 0;
    const uint32_t valid = points.z < 8 ? (2u << points.z) - 1 : 0x1FF;
    uint32_t rows[4][4] = {}; // of each node's 3² rows together
    for (int x = 0; x < 9 && x <= points.x; ++x)
      for (int y = 0; y < 9 && y <= points.y; ++y) {
        const uint32_t in = window.inside(x, y);
        const uint32_t wanted = (inside ? in & valid : 0) | (outside ? ~in & valid : 0);
        for (int nx = x > 1 ? (x - 1) >> 1 : 0; nx <= x >> 1 && nx < 4; ++nx)
          for (int ny = y > 1 ? (y - 1) >> 1 : 0; ny <= y >> 1 && ny < 4; ++ny)
            rows[nx][ny] |= wanted;
      }
    uint64_t word = 0;
    for (int m = 0; m < 64; ++m) {
      const Vec3i p = morton_point(static_cast<uint64_t>(m)), q = 4 * b + p;
      const bool in_grid =
          q.x >= first.x && q.y >= first.y && q.z >= first.z && q.x <= last.x && q.y <= last.y && q.z <= last.z;
      word |= uint64_t{in_grid && (rows[p.x][p.y] >> 2 * p.z & 7) != 0} << m;
    }
    if (out && word)
      *out = {morton(b), word};
    return word != 0;
  }
};

/// The last layer of nodes along an axis, all nodes where axis < 0. Block i of a box.
struct NodeLayer {
  BlockBox box;
  Vec3i nodes; ///< of the level, per axis
  int axis;
  MOLMESH_HD int64_t operator()(int64_t i, par::KeyedWord* out) const {
    const Vec3i b = box.block(i);
    uint64_t word = nodes_within(b, nodes);
    if (axis >= 0) {
      Vec3i before = nodes;
      --before[axis];
      word &= ~nodes_within(b, before);
    }
    if (out)
      *out = {morton(b), word};
    return 1;
  }
};

/// For balance: the parents of the nodes of block i and of those across their faces, as nodes a level up.
struct ParentsOfNeighbours {
  NodeSet refined;
  Vec3i parents; ///< of that level, per axis
  MOLMESH_HD int64_t operator()(int64_t i, par::KeyedWord* out) const {
    const uint64_t word = refined.block[i].word;
    const Vec3i b = morton_point(refined.block[i].key), low = 2 * b - Vec3i{1, 1, 1};
    uint64_t region = 0; // bit x + 4 y + 16 z: parent low + (x, y, z)
    for (int j = 0; j < 8; ++j) {
      const auto siblings = static_cast<uint32_t>(word >> 8 * j & 0xFF);
      if (siblings == 0)
        continue;
      const int at = 1 + (j & 1) + 4 * (1 + (j >> 1 & 1)) + 16 * (1 + (j >> 2));
      region |= uint64_t{1} << at;
      for (int a = 0; a < 3; ++a) {
        const uint32_t lower = a == 0 ? 0x55 : a == 1 ? 0x33 : 0x0F;
        region |= uint64_t{(siblings & lower) != 0} << (at - (1 << 2 * a));
        region |= uint64_t{(siblings & ~lower) != 0} << (at + (1 << 2 * a));
      }
    }
    const Vec3i block = {low.x >> 2, low.y >> 2, low.z >> 2}; // the region lies in eight blocks
    uint64_t part[8] = {};
    for (; region; region &= region - 1) {
      const int m = lowest_bit(region);
      const Vec3i p = low + Vec3i{m & 3, m >> 2 & 3, m >> 4};
      if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= parents.x || p.y >= parents.y || p.z >= parents.z)
        continue;
      const Vec3i q = p - 4 * block;
      part[(q.x >> 2) | (q.y >> 2) << 1 | (q.z >> 2) << 2] |= uint64_t{1} << morton({q.x & 3, q.y & 3, q.z & 3});
    }
    int64_t n = 0;
    for (int k = 0; k < 8; ++k) {
      if (part[k] == 0)
        continue;
      if (out)
        out[n] = {morton(block + Vec3i{k & 1, k >> 1 & 1, k >> 2}), part[k]};
      ++n;
    }
    return n;
  }
};

/// The nodes of block i and those across their faces. A block without nodes stays one.
struct WithNeighbours {
  NodeSet set;
  Vec3i nodes; ///< of the level, per axis
  MOLMESH_HD int64_t operator()(int64_t i, par::KeyedWord* out) const {
    const uint64_t word = set.block[i].word;
    const Vec3i b = morton_point(set.block[i].key);
    uint64_t own = word;
    for (int a = 0; a < 3; ++a)
      own |= with_next(word, 0, a) | with_previous(word, 0, a);
    int64_t n = 0;
    const auto add = [&](Vec3i block, uint64_t w) {
      w &= nodes_within(block, nodes);
      if (w == 0 && !(block == b))
        return;
      if (out)
        out[n] = {morton(block), w};
      ++n;
    };
    add(b, own);
    for (int a = 0; a < 3; ++a) {
      Vec3i q = b;
      ++q[a];
      add(q, with_previous(0, word, a));
      q[a] -= 2;
      if (q[a] >= 0)
        add(q, with_next(0, word, a));
    }
    return n;
  }
};

/// Surface blocks with a node near a face.
struct NearBlocks {
  const uint64_t* near;
  MOLMESH_HD int64_t operator()(int64_t i, int64_t* out) const {
    uint64_t any = 0;
    for (int f = 0; f < 6; ++f)
      any |= near[6 * i + f];
    if (out && any)
      *out = i;
    return any != 0;
  }
};
/// Positions in `refined` of such a block and of the blocks beyond its faces, -1: none.
struct FindNeighbours {
  const int64_t* candidate;
  const par::KeyedWord* surface;
  NodeSet refined;
  int64_t* position; ///< [7 candidates]
  MOLMESH_HD void operator()(int64_t i) const {
    const uint64_t key = surface[candidate[i]].key;
    const Vec3i p = morton_point(key);
    position[7 * i + 6] = refined.find(key);
    for (int f = 0; f < 6; ++f) {
      Vec3i q = p;
      q[f / 2] += f % 2 ? 1 : -1;
      position[7 * i + f] = q[f / 2] < 0 ? -1 : refined.find(morton(q));
    }
  }
};
/// One wave: nodes that may be one cell, that the surface passes near a face of, with children behind it, get
/// children too.
struct SpreadWave {
  const int64_t *candidate, *position;
  const uint64_t* near;
  NodeSet refined;
  uint64_t* grown; ///< [candidates]
  int64_t* changed;
  MOLMESH_HD void operator()(int64_t i) const {
    const int64_t* const at = position + 7 * i;
    const uint64_t* const near_face = near + 6 * candidate[i];
    const uint64_t before = refined.block[at[6]].word;
    uint64_t behind[6];
    for (int f = 0; f < 6; ++f)
      behind[f] = at[f] < 0 ? 0 : refined.block[at[f]].word;
    uint64_t now = before;
    for (uint64_t last = ~now; last != now;) {
      last = now;
      for (int a = 0; a < 3; ++a)
        now |= (near_face[2 * a] & with_previous(now, behind[2 * a], a)) |
               (near_face[2 * a + 1] & with_next(now, behind[2 * a + 1], a));
    }
    grown[i] = now;
    changed[i] = now != before;
  }
};
struct ApplyWave {
  const int64_t* position;
  const uint64_t* grown;
  par::KeyedWord* refined;
  MOLMESH_HD void operator()(int64_t i) const { refined[position[7 * i + 6]].word = grown[i]; }
};

} // namespace molmesh::contour
