// interior_edges.hpp — the tetrahedra round interior edges, face by face: one for each edge of a face between two
// cells. Section 4.1 of Liao et al. 2013. Host and device.
#pragma once
#include "contour/elements/batch.hpp"
#include "contour/elements/face_shape.hpp"
#include "geom/predicates.hpp"
#include <cmath>

namespace molmesh::contour {

/// Out: Batch, Checks, or what counts or writes on a device.
template <class Out>
class LeafFaces {
public:
  MOLMESH_HD LeafFaces(const ComplexView& c, NearLeaves& near, Out& out) : c_(c), near_(near), out_(out) {}

  MOLMESH_HD void leaf(int32_t leaf) {
    const int level = c_.tree.level[leaf];
    int32_t other[6];
    smaller_ = 0;
    if constexpr (Out::checks)
      c_.face_points[leaf] = 0;
    for (int f = 0; f < 6; ++f) {
      other[f] = c_.neighbour(leaf, f);
      smaller_ |= unsigned(other[f] >= 0 && c_.tree.level[other[f]] < level) << f;
    }
    for (int f = 0; f < 6; ++f) {
      if (other[f] >= 0) {
        const int other_level = c_.tree.level[other[f]];
        if (other_level < level || (other_level == level && f % 2 == 0))
          continue; // the other cell's face
      }
      face(leaf, f, other[f]);
    }
    if (c_.is_split(leaf))
      split_interior(leaf);
  }

private:
  /// The vertex in the middle of the leaf's edge from corner a to b, or -1 when no cell round the edge is smaller.
  MOLMESH_HD int32_t middle_vertex(int32_t leaf, int a, int b) const {
    const int level = c_.tree.level[leaf];
    // Smaller cells at an edge are there at its ends too.
    if (c_.least_level[c_.corner_vertex(leaf, a)] >= level || c_.least_level[c_.corner_vertex(leaf, b)] >= level)
      return -1;
    const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const bool upper_u = a >> u & 1, upper_v = a >> v & 1;
    // Neighbours across a face are one level smaller all along it; so is one across the edge, by which the leaf
    // owns a face: the one beyond that face, its neighbour too, is no smaller than the leaf.
    const bool across_u = smaller_ >> (2 * u + upper_u) & 1,
               across_v = !across_u && smaller_ >> (2 * v + upper_v) & 1;
    const bool diagonal = !across_u && !across_v;
    // The first neighbour is known, and has the middle as a corner where the edge is on the face's lower side.
    if (across_u && !upper_v)
      return c_.corner_vertex(c_.neighbour(leaf, 2 * u + upper_u), 1 << axis | int(!upper_u) << u);
    if (across_v && !upper_u)
      return c_.corner_vertex(c_.neighbour(leaf, 2 * v + upper_v), 1 << axis | int(!upper_v) << v);
    uint64_t k = c_.tree.key[leaf] | uint64_t{1} << (3 * (level - 1) + axis); // the cell after the middle
    if ((across_u || diagonal) && !c_.tree.beyond(k, level, u, upper_u))
      return -1;
    if ((across_v || diagonal) && !c_.tree.beyond(k, level, v, upper_v))
      return -1;
    if (across_u)
      k = morton_before(morton_after(k, v, level), v);
    if (across_v)
      k = morton_before(morton_after(k, u, level), u);
    const int32_t other = near_.find_key(k);
    if (diagonal && c_.tree.level[other] >= level)
      return -1;
    // That leaf starts at the middle along the axis.
    const bool other_upper_u = across_u || diagonal ? !upper_u : upper_u;
    const bool other_upper_v = across_v || diagonal ? !upper_v : upper_v;
    return c_.corner_vertex(other, int(other_upper_u) << u | int(other_upper_v) << v);
  }

  MOLMESH_HD void face(int32_t leaf, int f, int32_t other) {
    const Side mine = c_.side[leaf], its = other < 0 ? mine : c_.side[other];
    const bool both_crossed = mine == Side::crossed && its == Side::crossed;
    if (Out::checks && mine != Side::crossed && its != Side::crossed)
      return;
    if (other >= 0 && mine == c_.unmeshed && its == mine && mine != Side::crossed)
      return;
    const int corner[4] = {face_corner_of(f, 0), face_corner_of(f, 1), face_corner_of(f, 2), face_corner_of(f, 3)};
    const auto vertex = [&](int k) { return c_.corner_vertex(leaf, k); };
    // Only fine surface cells have ambiguous faces.
    Diagonal diagonal = Diagonal::none;
    if (both_crossed && c_.tree.level[leaf] == 0) {
      double v[4];
      for (int i = 0; i < 4; ++i)
        v[i] = over_isovalue(c_.value[vertex(corner[i])], c_.lattice.isovalue);
      diagonal = face_diagonal(v[0], v[1], v[2], v[3]);
    }
    if (diagonal == Diagonal::none) {
      Polygon p;
      for (int i = 0; i < 4; ++i) {
        p.add(vertex(corner[i]));
        const int32_t middle = middle_vertex(leaf, corner[i], corner[(i + 1) % 4]);
        if (middle >= 0)
          p.add(middle);
      }
      polygon(p, cell_dual(leaf, f, -1), other < 0 ? no_vertex : cell_dual(other, f ^ 1, -1), f,
              {needs_test(leaf, other), mine == Side::crossed || its == Side::crossed, both_crossed, leaf, 2 * f});
      return;
    }
    const int s = diagonal == Diagonal::even ? 0 : 1;
    for (int half = 0; half < 2; ++half) {
      const int k[3] = {corner[(s + 2 * half) % 4], corner[(s + 2 * half + 1) % 4], corner[(s + 2 * half + 2) % 4]};
      Polygon p;
      for (int i = 0; i < 3; ++i)
        p.add(vertex(k[i]));
      polygon(p, cell_dual(leaf, f, k[1]), other < 0 ? no_vertex : cell_dual(other, f ^ 1, k[1] ^ 1 << f / 2), f,
              {true, true, true, leaf, 2 * f + half});
    }
  }

  /// Whether the segment between the dual vertices could miss the face: never between unsplit boxes of one size,
  /// nor from the centre of a box.
  MOLMESH_HD bool needs_test(int32_t leaf, int32_t other) const {
    if (other < 0)
      return false;
    if (c_.is_split(leaf) || c_.is_split(other))
      return true;
    return c_.tree.level[leaf] != c_.tree.level[other] &&
           (c_.side[leaf] == Side::crossed || c_.side[other] == Side::crossed);
  }

  MOLMESH_HD int32_t cell_dual(int32_t leaf, int f, int off) const {
    return c_.is_split(leaf) ? c_.piece_dual(leaf, SplitCell(c_.topology(leaf)), f, off) : c_.dual(leaf);
  }

  /// What is known of the cells on a polygon's sides.
  struct Cells {
    bool test = true; ///< the segment between the dual vertices could miss the polygon
    /// One is a surface cell: looked at on both sides of the surface, all regions are parts of one mesh.
    bool check = true;
    bool both_crossed = true; ///< only then edges may change sides; at a wall: the one is
    int32_t leaf = -1;        ///< whose own face, or half of one, it is; -1: within a cell
    int bit = 0;              ///< of ComplexView::face_points
  };

  /// behind, front: dual vertices of the two cells; front no_vertex at wall f.
  MOLMESH_HD_CALL void polygon(const Polygon& p, int32_t behind, int32_t front, int f, Cells cells) {
    const bool wall = front == no_vertex;
    int32_t via = no_vertex;
    Vec3d via_position, front_position;
    if (wall) {
      front_position = face_point(c_, p);
      front_position[f / 2] = c_.position[p.vertex[0]][f / 2]; // planar to the last bit
      front = out_.add_point(front_position, box_x0 + f);
    } else {
      front_position = c_.position[front];
      if (gets_point(p, behind, front, cells, via_position))
        via = out_.add_point(via_position, 0);
    }
    uint32_t inside = 0;
    for (int i = 0; cells.both_crossed && i < p.n; ++i)
      inside |= uint32_t{c_.inside(p.vertex[i])} << i;
    bool positive = true;
    for (int i = 0; i < p.n; ++i) {
      const int32_t a = p.vertex[i], b = p.vertex[p.next(i)];
      const bool in_a = inside >> i & 1, in_b = inside >> p.next(i) & 1;
      if (Out::checks && cells.check && (wall || via != no_vertex)) { // others are positive by least_moved_volume
        const Vec3d xa = c_.position[a], xb = c_.position[b], xc = c_.position[behind];
        positive = positive && (via == no_vertex ? orient3d(xa, xb, xc, front_position) > 0
                                                 : orient3d(xa, xb, xc, via_position) > 0 &&
                                                       orient3d(xa, xb, via_position, front_position) > 0);
      }
      if (in_a != in_b) {
        out_.link.push_back(in_a ? Link{a, b, behind, via, front} : Link{b, a, front, via, behind});
        continue;
      }
      if (Out::checks)
        continue;
      if (via == no_vertex) {
        out_.tet.push_back({a, b, behind, front});
      } else {
        out_.tet.push_back({a, b, behind, via});
        out_.tet.push_back({a, b, via, front});
      }
      if (wall)
        out_.add_triangle({a, b, front}, a, a, box_x0 + f);
    }
    if constexpr (Out::checks) {
      for (int i = 0; !positive && i < p.n; ++i)
        out_.spoiled.push_back(p.vertex[i]);
      if (!positive)
        out_.spoiled.push_back(behind);
      if (!positive && !wall)
        out_.spoiled.push_back(front);
    }
  }

  /// Whether a point goes between the dual vertices, and where. What the check found is known of leaves' faces.
  MOLMESH_HD bool gets_point(const Polygon& p, int32_t behind, int32_t front, const Cells& cells,
                             Vec3d& point) const {
    if (!Out::checks && cells.leaf >= 0) {
      if (!(c_.face_points[cells.leaf] >> cells.bit & 1))
        return false;
      point = face_point(c_, p);
      return true;
    }
    if (!wants_point(c_, p, behind, front, cells.test, cells.check, point))
      return false;
    if (Out::checks && cells.leaf >= 0)
      c_.face_points[cells.leaf] = static_cast<uint16_t>(c_.face_points[cells.leaf] | 1 << cells.bit);
    return true;
  }

  /// Triangles from the cell's edges (and its faces' diagonals) to the centre.
  MOLMESH_HD void split_interior(int32_t leaf) {
    const SplitCell s(c_.topology(leaf));
    const auto vertex = [&](int k) { return c_.corner_vertex(leaf, k); };
    const int32_t centre = c_.split[leaf];
    for (const Patch& p : s.patch) {
      if (p.piece < 0)
        continue;
      for (int i = 0; i < p.n; ++i) {
        const int a = p.corner[i], b = p.corner[(i + 1) % p.n];
        for (const Patch& q : s.patch) {
          if (q.piece <= p.piece)
            continue; // each triangle once
          for (int j = 0; j < q.n; ++j) {
            if (q.corner[j] != b || q.corner[(j + 1) % q.n] != a)
              continue;
            Polygon t;
            t.add(vertex(a));
            t.add(vertex(b));
            t.add(centre);
            polygon(t, c_.piece_dual(leaf, s, q), c_.piece_dual(leaf, s, p), -1, {});
          }
        }
      }
      if (p.face >= 0)
        continue;
      Polygon t; // the cut below the chopped corner
      for (int i = 0; i < 3; ++i)
        t.add(vertex(p.corner[i]));
      polygon(t, c_.piece_dual(leaf, s, p), centre + 1 + s.pieces, -1, {});
    }
  }

  const ComplexView& c_;
  NearLeaves& near_;
  unsigned smaller_ = 0; ///< bit f: smaller cells across the leaf's face f
  Out& out_;
};

/// The elements of the faces that a leaf owns, and the links they add to sign-change edges. A face belongs to its
/// smaller cell, of two equal ones to the lower. near: the complex's tree.
template <class Out>
MOLMESH_HD void make_faces(const ComplexView& complex, NearLeaves& near, int32_t leaf, Out& out) {
  LeafFaces<Out>(complex, near, out).leaf(leaf);
}

} // namespace molmesh::contour
