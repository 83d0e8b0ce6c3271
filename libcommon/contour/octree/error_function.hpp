// error_function.hpp — decides which octree nodes at the surface may be one cell. Section 4.1 of Liao et al. 2013.
//
// The feature-sensitive error function of their reference 50 compares a node's trilinear interpolant with the field
// at the node's finer points. It is replaced, since the grid holds constants at most corners of coarse nodes, which
// lie outside the band. The error is measured on what the band knows: the mass centres and normals of the fine
// cells that the surface crosses (SurfaceSample). It is their largest distance from their mean plane, in fine
// spacings (MergeNodes), and normals may turn by 72.5° at most. Merged cells keep the topology: OneDisc and
// middles_agree. Host and device.
#pragma once
#include "contour/octree/node_mask.hpp"
#include "contour/surface/ambiguous_cell.hpp"
#include "contour/surface/surface_cell.hpp"

namespace molmesh::contour {

/// A node whose surface is one nearly plane disc may be one cell; else it has children.
inline constexpr uint8_t one_cell = 1 << 6;
// Bit f of such a node: the middle of its surface is near face f.

/// Nodes of one level with surface cells, ascending. Level 0: the cells themselves, each its own node.
struct SurfaceNodes {
  const uint64_t* key = nullptr;  ///< Morton code / 8^level
  const int32_t* child = nullptr; ///< first node of the level below; its nodes follow each other. Level 0: null
  const int32_t* cell = nullptr;  ///< first surface cell. Level 0: null
  uint8_t* flags = nullptr;       ///< `one_cell` and near faces
  uint8_t* corners = nullptr;     ///< bit c: corner c is inside; of nodes within the domain
  int64_t n = 0, below = 0, cells = 0; ///< nodes here, of the level below, surface cells

  MOLMESH_HD int64_t child_begin(int64_t i) const { return i < n ? child[i] : below; }
  MOLMESH_HD int64_t cell_begin(int64_t i) const { return i >= n ? cells : cell ? cell[i] : i; }
};

/// Bit x + 3 y + 9 z: of the 27 corners of a node's children, (x, y, z) is inside. The children that the surface
/// crosses are nodes begin … end - 1; the others lie on one side, that of the corner that all eight share.
MOLMESH_HD inline uint32_t inside_points(const SurfaceNodes& children, int64_t begin, int64_t end) {
  const auto of_child = [](uint32_t octant, uint32_t corners) {
    const uint32_t points =
        (corners & 0x03) | (corners & 0x0C) << 1 | (corners & 0x30) << 5 | (corners & 0xC0) << 6;
    return points << ((octant & 1) + 3 * (octant >> 1 & 1) + 9 * (octant >> 2));
  };
  constexpr uint32_t middle = 1 << 13;
  uint32_t in = 0, crossed = 0;
  for (int64_t k = begin; k < end; ++k) {
    const auto octant = static_cast<uint32_t>(children.key[k] & 7);
    in |= of_child(octant, children.corners[k]);
    crossed |= 1u << octant;
  }
  for (uint32_t octant = 0; (in & middle) && octant < 8; ++octant)
    if (!(crossed >> octant & 1))
      in |= of_child(octant, 0xFF);
  return in;
}

/// Of each set of inside corners: whether the surface within the cell is one disc and no face is ambiguous, that
/// is, inside and outside corners are each joined by edges, and so are those of each face.
struct OneDisc {
  uint64_t of_set[4] = {};
  constexpr OneDisc() {
    for (uint32_t set = 1; set < 0xFF; ++set) {
      bool plain = joined(set) && joined(~set & 0xFF);
      for (int f = 0; f < 6; ++f) {
        const auto in = [&](int i) { return set >> face_corner_of(f, i) & 1; };
        plain = plain && !(in(0) == in(2) && in(1) == in(3) && in(0) != in(1));
      }
      of_set[set >> 6] |= uint64_t{plain} << (set & 63);
    }
  }
  MOLMESH_HD bool operator()(uint32_t inside_corners) const {
    return of_set[inside_corners >> 6] >> (inside_corners & 63) & 1;
  }

private:
  static constexpr bool joined(uint32_t set) {
    uint32_t part = set & ~(set - 1);
    for (int step = 0; step < 7; ++step)
      part |= ((part & 0x55) << 1 | (part & 0xAA) >> 1 | (part & 0x33) << 2 | (part & 0xCC) >> 2 |
               (part & 0x0F) << 4 | (part & 0xF0) >> 4) &
              set;
    return part == set;
  }
};

MOLMESH_HD inline uint32_t inside_corners(const SurfaceCell& cell, float isovalue) {
  uint32_t inside = 0;
  for (int c = 0; c < 8; ++c)
    inside |= uint32_t{cell.value[c] > isovalue} << c;
  return inside;
}

struct StartFromCells {
  const SurfaceCell* from;
  float isovalue;
  uint64_t* key;
  uint8_t *flags, *corners;
  OneDisc one_disc{};
  MOLMESH_HD void operator()(int64_t i) const {
    const uint32_t inside = inside_corners(from[i], isovalue);
    key[i] = from[i].key;
    corners[i] = static_cast<uint8_t>(inside);
    flags[i] = one_disc(inside) ? one_cell : uint8_t{0};
  }
};

/// First of the nodes with one parent.
struct FirstChildren {
  const uint64_t* key;
  MOLMESH_HD int64_t operator()(int64_t i, int32_t* out) const {
    if (i > 0 && key[i] >> 3 == key[i - 1] >> 3)
      return 0;
    if (out)
      *out = static_cast<int32_t>(i);
    return 1;
  }
};
struct MakeParents {
  SurfaceNodes below;
  const int32_t* child;
  int64_t n;
  uint64_t* key;
  int32_t* cell;
  uint8_t* corners;
  MOLMESH_HD void operator()(int64_t i) const {
    key[i] = below.key[child[i]] >> 3;
    cell[i] = static_cast<int32_t>(below.cell_begin(child[i]));
    const uint32_t in = inside_points(below, child[i], i + 1 < n ? child[i + 1] : below.n);
    uint32_t of_node = 0;
    for (int c = 0; c < 8; ++c)
      of_node |= (in >> (2 * (c & 1) + 6 * (c >> 1 & 1) + 18 * (c >> 2)) & 1) << c;
    corners[i] = static_cast<uint8_t>(of_node);
  }
};

/// The mean plane of samples.
struct MeanPlane {
  Vec3d normal, middle; ///< unit vector, zero where normals cancel

  MOLMESH_HD MeanPlane(const SurfaceSample* begin, const SurfaceSample* end) {
    for (const SurfaceSample* s = begin; s < end; ++s) {
      normal += s->normal;
      middle += s->point;
    }
    middle = middle / double(end - begin);
    const double length = norm(normal);
    if (length > 0)
      normal = normal / length;
  }
  /// Normals within 72.5° of their mean: one surface, no sharp crease.
  MOLMESH_HD bool has(const SurfaceSample& s) const { return dot(s.normal, normal) >= 0.3; }
};

/// Of inside_points: whether the signs at the middles of the edges, faces and volume each agree with a corner of
/// that edge, face or volume, so that eight plain cells may be one (Ju et al. 2002, the paper's reference 22).
MOLMESH_HD inline bool middles_agree(uint32_t in) {
  constexpr uint32_t corner_bits = 0x5140145, half_way[3] = {0x2492492, 0xE07038, 0x3FE00};
  // Whether any, and whether all of the corners of the edge, face or cell that a point is the middle of are inside.
  uint32_t any = in & corner_bits, all = any;
  for (int a = 0, step = 1; a < 3; ++a, step *= 3) {
    any |= (any << step | any >> step) & half_way[a];
    all |= (all << step & all >> step) & half_way[a];
  }
  return (in & ~any) == 0 && (all & ~in) == 0;
}

/// Sets the flags of node i: one_cell when its children are, its surface is nearly plane, and merging keeps the
/// topology.
struct MergeNodes {
  /// Of the surface's middle from a face with smaller cells behind, in the node's edge length: seen from nearer,
  /// those cells' faces are aslant, and their elements flat, or the dual vertex that keeps off them is off the
  /// surface. Nodes of two fine spacings are nearer to it.
  static constexpr double least_margin = 0.15, least_margin_of_two = 0.1;

  Vec3i cells; ///< of the domain
  const SurfaceSample* sample;
  SurfaceNodes nodes, children;
  int level;
  double tolerance; ///< distance of the samples from their mean plane, fine spacings
  NodeSet loose;    ///< nodes with a tolerance of their own
  double loose_tolerance;
  OneDisc one_disc{};

  MOLMESH_HD void operator()(int64_t i) const {
    uint8_t& flags = nodes.flags[i];
    flags = 0;
    const Vec3i corner = morton_point(nodes.key[i] << 3 * level);
    const int32_t extent = 1 << level;
    if (corner.x + extent > cells.x || corner.y + extent > cells.y || corner.z + extent > cells.z)
      return;
    for (int64_t c = nodes.child_begin(i); c < nodes.child_begin(i + 1); ++c)
      if (!(children.flags[c] & one_cell))
        return;
    if (!keeps_topology(i))
      return;
    const SurfaceSample *const begin = sample + nodes.cell_begin(i), *const end = sample + nodes.cell_begin(i + 1);
    const MeanPlane plane(begin, end);
    const uint64_t key = nodes.key[i];
    if (nearly_plane(begin, end, plane, loose.word(key >> 6) >> (key & 63) & 1 ? loose_tolerance : tolerance))
      flags = static_cast<uint8_t>(one_cell | near_faces(plane.middle, corner, extent));
  }

private:
  MOLMESH_HD static bool nearly_plane(const SurfaceSample* begin, const SurfaceSample* end, const MeanPlane& plane,
                                      double most) {
    for (const SurfaceSample* s = begin; s < end; ++s)
      if (!(plane.has(*s) && std::fabs(dot(s->point - plane.middle, plane.normal)) <= most))
        return false;
    return true;
  }
  MOLMESH_HD bool keeps_topology(int64_t i) const {
    return one_disc(nodes.corners[i]) &&
           middles_agree(inside_points(children, nodes.child_begin(i), nodes.child_begin(i + 1)));
  }
  MOLMESH_HD static uint8_t near_faces(Vec3d middle, Vec3i corner, int32_t extent) {
    const double margin = extent == 2 ? least_margin_of_two : least_margin;
    uint8_t faces = 0;
    for (int a = 0; a < 3; ++a) {
      const double share = (middle[a] - corner[a]) / extent;
      faces = static_cast<uint8_t>(faces | (share < margin) << 2 * a | (share > 1 - margin) << (2 * a + 1));
    }
    return faces;
  }
};

/// Surface nodes of one level by blocks of 4³: block i is node i two levels up. word: those that have children.
struct SurfaceBlocks {
  SurfaceNodes nodes, parents, blocks;
  par::KeyedWord* refined;
  uint64_t* near; ///< [6 blocks] nodes near face f
  MOLMESH_HD void operator()(int64_t i) const {
    uint64_t children = 0, near_face[6] = {};
    const int64_t begin = parents.child_begin(blocks.child_begin(i)),
                  end = parents.child_begin(blocks.child_begin(i + 1));
    for (int64_t k = begin; k < end; ++k) {
      const uint64_t bit = uint64_t{1} << (nodes.key[k] & 63);
      const uint8_t flags = nodes.flags[k];
      children |= flags & one_cell ? 0 : bit;
      for (int f = 0; f < 6; ++f)
        near_face[f] |= flags >> f & 1 ? bit : 0;
    }
    refined[i] = {blocks.key[i], children};
    for (int f = 0; f < 6; ++f)
      near[6 * i + f] = near_face[f];
  }
};

} // namespace molmesh::contour
