// face_pass.hpp — one tetrahedron per edge of each face between two cells. Host and device.
#pragma once
#include "contour/detail/at.hpp"
#include "contour/detail/batch.hpp"
#include "contour/detail/complex_queries.hpp"
#include "contour/octree.hpp"
#include "geom/predicates.hpp"
#include "geom/tet_measures.hpp"
#include <cmath>

namespace molmesh::contour::detail {

/// A convex polygon of vertices of the complex, counter-clockwise seen from the cell in front.
struct Polygon {
  int n = 0;
  int32_t vertex[8];
  HD void add(int32_t v) { vertex[n++] = v; }
};

HD inline double lesser(double a, double b) {
  return b < a ? b : a;
}

/// Volumes below this share of the cube of the face's shortest edge get a face point instead.
inline constexpr double least_volume = 0.003;

/// The same between boxes of one size, whose grid points may have moved.
inline constexpr double least_moved_volume = 1e-4;

/// C: Complex or its view on a device; Out: Batch, or what counts or writes there.
template <class C, class Out>
class FacePass {
public:
  HD FacePass(const C& c, const bool wanted[2], Out& out) : c_(c), wanted_{wanted[0], wanted[1]}, out_(out) {}

  HD void leaf(int32_t leaf) {
    const int level = c_.tree.level[at(leaf)];
    for (int f = 0; f < 6; ++f) {
      const int32_t other = neighbour(leaf, f);
      if (other >= 0) {
        const int other_level = c_.tree.level[at(other)];
        if (other_level < level || (other_level == level && f % 2 == 0))
          continue; // the other cell's face
      }
      face(leaf, f, other);
    }
    if (c_.is_split(leaf))
      split_interior(leaf);
  }

private:
  HD int32_t neighbour(int32_t leaf, int f) const {
    Vec3i p = c_.tree.corner(leaf);
    p[f / 2] += f % 2 ? c_.tree.extent(leaf) : -1;
    return c_.tree.find(p);
  }

  /// The vertex in the middle of the leaf's edge from corner a to b, or -1 when no cell round the edge is smaller.
  HD int32_t middle_vertex(int32_t leaf, int a, int b) const {
    const int32_t extent = c_.tree.extent(leaf);
    if (extent == 1)
      return -1;
    const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const Vec3i corner = c_.tree.corner(leaf);
    Vec3i middle = corner;
    middle[axis] += extent / 2;
    middle[u] += a >> u & 1 ? extent : 0;
    middle[v] += a >> v & 1 ? extent : 0;
    for (int n = 1; n < 4; ++n) { // the other three cells round the edge
      Vec3i p = middle;           // a fine cell at the edge, in the quadrant
      const bool high_u = ((a >> u & 1) != 0) == ((n & 1) != 0), high_v = ((a >> v & 1) != 0) == ((n & 2) != 0);
      if (!high_u)
        p[u] -= 1;
      if (!high_v)
        p[v] -= 1;
      const int32_t other = c_.tree.find(p);
      if (other < 0 || c_.tree.extent(other) >= extent)
        continue;
      // That leaf starts at the middle along the axis.
      const int k = (high_u ? 0 : 1 << u) | (high_v ? 0 : 1 << v);
      return c_.grid_vertex[at(int64_t{8} * other + k)];
    }
    return -1;
  }

  HD void face(int32_t leaf, int f, int32_t other) {
    const Side mine = c_.side[at(leaf)], its = other < 0 ? mine : c_.side[at(other)];
    const bool both_crossed = mine == Side::crossed && its == Side::crossed;
    if (!both_crossed) {
      const Side side = mine == Side::crossed ? its : mine;
      if (!wanted_[side == Side::inside] && mine != Side::crossed && its != Side::crossed)
        return;
    }
    const int corner[4] = {face_corner_of(f, 0), face_corner_of(f, 1), face_corner_of(f, 2), face_corner_of(f, 3)};
    const auto vertex = [&](int k) { return c_.grid_vertex[at(int64_t{8} * leaf + k)]; };
    // Only fine surface cells have ambiguous faces.
    Diagonal diagonal = Diagonal::none;
    if (both_crossed && c_.tree.level[at(leaf)] == 0) {
      double v[4];
      for (int i = 0; i < 4; ++i)
        v[i] = double(c_.value[at(vertex(corner[i]))]) - double(c_.lattice.isovalue);
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
              needs_test(leaf, other), mine == Side::crossed || its == Side::crossed);
      return;
    }
    const int s = diagonal == Diagonal::even ? 0 : 1;
    for (int half = 0; half < 2; ++half) {
      const int k[3] = {corner[(s + 2 * half) % 4], corner[(s + 2 * half + 1) % 4], corner[(s + 2 * half + 2) % 4]};
      Polygon p;
      for (int i = 0; i < 3; ++i)
        p.add(vertex(k[i]));
      polygon(p, cell_dual(leaf, f, k[1]), other < 0 ? no_vertex : cell_dual(other, f ^ 1, k[1] ^ 1 << f / 2), f,
              true, true);
    }
  }

  /// Whether the segment between the dual vertices could miss the face: never between unsplit boxes of one size,
  /// nor from the centre of a box.
  HD bool needs_test(int32_t leaf, int32_t other) const {
    if (other < 0)
      return false;
    if (c_.is_split(leaf) || c_.is_split(other))
      return true;
    return c_.tree.level[at(leaf)] != c_.tree.level[at(other)] &&
           (c_.side[at(leaf)] == Side::crossed || c_.side[at(other)] == Side::crossed);
  }

  HD int32_t cell_dual(int32_t leaf, int f, int off) const {
    return c_.is_split(leaf) ? c_.piece_dual(leaf, SplitCell(c_.topology(leaf)), f, off) : c_.dual(leaf);
  }

  /// behind, front: dual vertices of the two cells; front no_vertex at wall f. Elements at surface cells are
  /// checked on both sides of the surface, wanted or not: all regions are parts of one mesh.
  HD_CALL void polygon(const Polygon& p, int32_t behind, int32_t front, int f, bool test, bool check) {
    const bool wall = front == no_vertex;
    int32_t via = no_vertex;
    Vec3d via_position, front_position;
    if (wall) {
      front_position = face_point(p);
      front_position[f / 2] = c_.position[at(p.vertex[0])][f / 2]; // planar to the last bit
      front = out_.add_point(front_position, box_x0 + f);
    } else {
      front_position = c_.position[at(front)];
      if (!pierced(p, behind, front, test ? least_volume : check ? least_moved_volume : -1)) {
        via_position = face_point(p);
        via = out_.add_point(via_position, 0);
      }
    }
    bool positive = true;
    for (int i = 0; i < p.n; ++i) {
      const int32_t a = p.vertex[i], b = p.vertex[(i + 1) % p.n];
      const bool in_a = c_.inside(a), in_b = c_.inside(b);
      if (check) {
        const Vec3d xa = c_.position[at(a)], xb = c_.position[at(b)], xc = c_.position[at(behind)];
        positive = positive && (via == no_vertex ? orient3d(xa, xb, xc, front_position) > 0
                                                 : orient3d(xa, xb, xc, via_position) > 0 &&
                                                       orient3d(xa, xb, via_position, front_position) > 0);
      }
      if (in_a != in_b) {
        out_.link.push_back(in_a ? Link{a, b, behind, via, front} : Link{b, a, front, via, behind});
        continue;
      }
      if (!wanted_[in_a])
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
    if (positive)
      return;
    for (int i = 0; i < p.n; ++i)
      out_.spoiled.push_back(p.vertex[i]);
    out_.spoiled.push_back(behind);
    if (!wall)
      out_.spoiled.push_back(front);
  }

  /// A point within the polygon: the middle of the surface's trace on it, or the polygon's centre.
  HD Vec3d face_point(const Polygon& p) const {
    Vec3d crossed, all;
    int crossings = 0;
    for (int i = 0; i < p.n; ++i) {
      const int32_t a = p.vertex[i], b = p.vertex[(i + 1) % p.n];
      all += c_.position[at(a)];
      if (c_.inside(a) == c_.inside(b))
        continue;
      crossed += c_.crossing(a, b);
      ++crossings;
    }
    return crossings ? crossed / double(crossings) : all / double(p.n);
  }

  /// least: share as below; negative: no test.
  HD bool pierced(const Polygon& p, int32_t behind, int32_t front, double least_share) const {
    if (least_share < 0)
      return true;
    const Vec3d d = c_.position[at(behind)], e = c_.position[at(front)];
    double size2 = 1e300;
    for (int i = 0; i < p.n; ++i)
      size2 = lesser(size2, norm2(c_.position[at(p.vertex[i])] - c_.position[at(p.vertex[(i + 1) % p.n])]));
    const double least = 6 * least_share * size2 * std::sqrt(size2);
    for (int i = 0; i < p.n; ++i)
      if (six_volume(c_.position[at(p.vertex[i])], c_.position[at(p.vertex[(i + 1) % p.n])], d, e) < least)
        return false;
    return true;
  }

  /// Triangles from the cell's edges (and its faces' diagonals) to the centre.
  HD void split_interior(int32_t leaf) {
    const SplitCell s(c_.topology(leaf));
    const auto vertex = [&](int k) { return c_.grid_vertex[at(int64_t{8} * leaf + k)]; };
    const int32_t centre = c_.split[at(leaf)];
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
            polygon(t, c_.piece_dual(leaf, s, q), c_.piece_dual(leaf, s, p), -1, true, true);
          }
        }
      }
      if (p.face >= 0)
        continue;
      Polygon t; // the cut below the chopped corner
      for (int i = 0; i < 3; ++i)
        t.add(vertex(p.corner[i]));
      polygon(t, c_.piece_dual(leaf, s, p), centre + 1 + s.pieces, -1, true, true);
    }
  }

  const C& c_;
  bool wanted_[2];
  Out& out_;
};

/// The elements of the faces that a leaf owns, and the links they add to sign-change edges. A face belongs to its
/// smaller cell, of two equal ones to the lower. wanted[0]: outside, wanted[1]: inside.
template <class C, class Out>
HD void make_faces(const C& complex, int32_t leaf, const bool wanted[2], Out& out) {
  FacePass<C, Out>(complex, wanted, out).leaf(leaf);
}

} // namespace molmesh::contour::detail
