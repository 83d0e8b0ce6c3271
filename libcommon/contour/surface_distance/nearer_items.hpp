// nearer_items.hpp — kernels that find the surface triangles far from the isosurface and the vertices that may move
// for them. Host and device.
#pragma once
#include "contour/relaxation/relax_items.hpp"
#include <cmath>

namespace molmesh::contour {

/// How far a surface triangle's centroid is from its foot on the isosurface, in spacings.
struct CentroidDistance {
  static constexpr float most = 0.49F;   ///< beyond it a triangle is far
  static constexpr float least = 0.4F;   ///< up to it all are as good
  static constexpr float sure = 0.2F;    ///< up to it to first order will do
  static constexpr float beyond = 5;     ///< where the field is not known, or it is that far
  static constexpr float of_a_wall = -1; ///< such a triangle is left alone

  /// What moves and divisions lower.
  MOLMESH_HD static double cost(float off) {
    const double more = off > least ? double(off) - least : 0;
    return more * more;
  }

  /// Of the place c, whose distance (Å) to first order it is.
  template <class Surface>
  MOLMESH_HD static float measured(const Surface& surface, Vec3d c, double distance) {
    const double spacing = surface.spacing();
    const auto off = static_cast<float>(std::fabs(distance) / spacing);
    Vec3d foot = c;
    if (off > sure && surface.project(foot, beyond * spacing))
      return static_cast<float>(norm(foot - c) / spacing);
    return off < beyond ? off : beyond;
  }
  template <class Surface>
  MOLMESH_HD static float of(const Surface& surface, Vec3d c) {
    double distance;
    Vec3d normal;
    return surface.probe(c, distance, normal) ? measured(surface, c, distance) : beyond;
  }
};

/// Surface: may be a reference.
template <class Surface>
struct MeasureTriangles {
  ElementsView e;
  Surface isosurface;
  float* off; ///< [tris]
  MOLMESH_HD void operator()(int64_t t) const {
    off[t] = is_surface(t) ? CentroidDistance::of(isosurface, centroid(t)) : CentroidDistance::of_a_wall;
  }
  MOLMESH_HD bool is_surface(int64_t t) const { return e.boundary[t] == surface; }
  MOLMESH_HD Vec3d centroid(int64_t t) const { return (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.; }

private:
  MOLMESH_HD const Vec3d& corner(int64_t t, size_t i) const { return e.position[e.tri[t][i]]; }
};
struct FarTriangles {
  const float* off;
  const int32_t* among; ///< null: all
  MOLMESH_HD int64_t operator()(int64_t i, int32_t* out) const {
    const int64_t t = among ? among[i] : i;
    if (off[t] > CentroidDistance::most && out)
      *out = static_cast<int32_t>(t);
    return off[t] > CentroidDistance::most;
  }
};

/// Cell: Tri or Tet.
template <class Cell>
struct WantCorners {
  const Cell* cell;
  const int32_t* which;
  uint8_t* wanted; ///< [vertices]
  MOLMESH_HD void operator()(int64_t i) const {
    for (const int32_t v : cell[which[i]])
      par::raise(wanted[v]);
  }
};
/// Surface triangles at a wanted vertex.
struct NearTriangles {
  static constexpr int64_t most = 1;
  ElementsView e;
  const uint8_t* wanted;
  const int32_t* among; ///< null: all
  MOLMESH_HD int64_t operator()(int64_t i, int32_t* out) const {
    const int64_t t = among ? among[i] : i;
    const Tri& v = e.tri[t];
    if (out) // wanted or not, since there is no telling: the next one takes the place
      *out = static_cast<int32_t>(t);
    return ((wanted[v[0]] | wanted[v[1]] | wanted[v[2]]) != 0) & (e.boundary[t] == surface);
  }
};
/// Corner i % 3 of near triangle i / 3.
struct TriangleCandidate {
  const Tri* tri;
  const int32_t *near, *number;
  MOLMESH_HD int64_t operator()(int64_t i) const { return number[tri[near[i / 3]][i % 3]]; }
};
/// In the order of the candidates, then of the triangles.
struct PlaceTriangleStars {
  TriangleCandidate of;
  int32_t *triangle, *owner;
  MOLMESH_HD void operator()(int64_t slot, int64_t i) const {
    triangle[slot] = of.near[i / 3];
    owner[slot] = static_cast<int32_t>(of(i));
  }
};

/// What such a round works on.
struct NearerView {
  RelaxView r;
  float room;              ///< quality of elements that make room
  float* off;              ///< [tris] CentroidDistance
  const int64_t* first;    ///< [candidates + 1] into triangle
  const int32_t* triangle; ///< surface triangles, ascending at each candidate
};

/// Corners of far triangles want to move; vertices off the surface want to make room for them.
struct StartNearer {
  NearerView v;
  const int32_t* active;
  int round;
  MOLMESH_HD void operator()(int64_t i) const {
    const int32_t c = active[i];
    v.r.update_worst(c);
    v.r.turn[c] = wants(c) ? turn(c, round) : RelaxView::at_rest;
    v.r.wakes[c] = 0;
  }

private:
  MOLMESH_HD bool wants(int32_t c) const {
    if (!v.r.bound.on_surface(v.r.vertex[c]))
      return v.r.worst[c] < v.room;
    for (int64_t k = v.first[c]; k < v.first[c + 1]; ++k)
      if (v.off[v.triangle[k]] > CentroidDistance::most)
        return true;
    return false;
  }
};

} // namespace molmesh::contour
