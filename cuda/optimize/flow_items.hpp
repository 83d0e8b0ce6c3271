// flow_items.hpp — geometric flow, a point at a time: where it wants to go, and whether it may when others go too.
// §5 of Liao et al. 2013.
#pragma once
#include "base/hd.hpp"
#include "geom/tet_quality.hpp"
#include "isosurface/guard.hpp"
#include "isosurface/isosurface_view.hpp"
#include "optimize/acceptance/acceptance.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"

namespace molmesh::cuda {

/// Corners of an element; of a free slot v[0] < 0.
struct alignas(16) Corners {
  int32_t v[4];
};
/// A triangle on the curved surface, running as the isosurface's normal does.
struct SurfaceTriangle {
  int32_t v[3];
};
/// Which faces of an element are surface triangles: bit f, and bit 4 + f where face f runs against the normal.
struct GatherSurfaceTriangles {
  const Corners* element;
  const uint8_t* faces;
  MOLMESH_HD int64_t operator()(int64_t i, SurfaceTriangle* out) const {
    int64_t n = 0;
    for (int f = 0; f < 4; ++f)
      if (faces[i] >> f & 1) {
        if (out) {
          const int32_t* const v = element[i].v;
          const int swapped = faces[i] >> (4 + f) & 1; // as seen from outside, or the other way round
          out[n] = {{v[tet_face(f, 0)], v[tet_face(f, 1 + swapped)], v[tet_face(f, 2 - swapped)]}};
        }
        ++n;
      }
    return n;
  }
};
/// Entries [begin[v], begin[v + 1]) of `item` are what hangs on point v.
struct Star {
  const int64_t* begin;
  const uint32_t* item;
};

/// The mesh while its connectivity stands still.
struct FlowMesh {
  const Corners* element;
  const SurfaceTriangle* triangle;
  const optimize::Vertex* vertex;
  Star elements, triangles;
  bool has_surface;
  IsosurfaceView surface;
  Guard guard;
  double most_tilt; ///< guard.tilt(): a device's cosine is another
  float goal;
  bool worst_first;
  optimize::Walls walls;

  MOLMESH_HD float deficit(float q) const { return optimize::deficit(q, goal, worst_first, guard); }
  /// Whether a triangle at the point must be kept from crossing another one (DynamicMesh::watched): the host's
  /// passes see to that, and know such triangles by their places.
  MOLMESH_HD bool is_watched(int64_t v) const {
    for (int64_t i = triangles.begin[v]; i < triangles.begin[v + 1]; ++i) {
      int watched = 0;
      for (const int32_t corner : triangle[triangles.item[i]].v)
        watched += vertex[corner].watched;
      if (watched >= 2)
        return true;
    }
    return false;
  }
};

/// What a point must keep to: every element of its star above `worst`, which is what it was; their deficit and the
/// misfit of its surface triangles no larger.
struct Limits {
  float worst, deficit;
  double misfit;
};

/// q[i] of element i with the points at `point`.
struct ElementQuality {
  const Corners* element;
  const Vec3d* point;
  float* q;
  MOLMESH_HD void operator()(int64_t i) const {
    const Corners e = element[i];
    if (e.v[0] >= 0)
      q[i] = tet_quality(point[e.v[0]], point[e.v[1]], point[e.v[2]], point[e.v[3]]);
  }
};

/// wanted[n]: point order[n] may move and has an element below the goal.
struct WantsToMove {
  FlowMesh m;
  const float* q;
  const uint32_t* order;
  int64_t* wanted;
  MOLMESH_HD void operator()(int64_t n) const {
    const int64_t v = order[n];
    bool bad = false;
    for (int64_t i = m.elements.begin[v]; i < m.elements.begin[v + 1]; ++i)
      bad = bad || q[m.elements.item[i]] < m.goal;
    const optimize::Kind kind = m.vertex[v].kind;
    wanted[n] = bad && (kind == optimize::Kind::interior || kind == optimize::Kind::sliding ||
                        (kind == optimize::Kind::surface && m.has_surface && !m.is_watched(v)));
  }
};

/// Points at their places but for those that are on the move: moving[v] ? to[v] : point[v].
struct Places {
  const Vec3d *point, *to;
  const uint8_t* moving;
  MOLMESH_HD Vec3d operator()(int32_t v) const { return moving[v] ? to[v] : point[v]; }
};
/// Points at their places but for one.
struct OneMoved {
  const Vec3d* point;
  int32_t moved;
  Vec3d at;
  MOLMESH_HD Vec3d operator()(int32_t v) const { return v == moved ? at : point[v]; }
};

/// Whether the star of v keeps to its limits, and by how much its worst element rises. No element may be so flat
/// that floating point cannot tell its sign.
template <class Where>
MOLMESH_HD inline float worst_if_kept(const FlowMesh& m, int64_t v, const Where& at, const Limits& limits) {
  float worst = 2, deficit = 0;
  for (int64_t i = m.elements.begin[v]; i < m.elements.begin[v + 1]; ++i) {
    const Corners& e = m.element[m.elements.item[i]];
    const float q = tet_quality(at(e.v[0]), at(e.v[1]), at(e.v[2]), at(e.v[3]));
    if (!(q > limits.worst && q > surely_positive))
      return -1;
    worst = q < worst ? q : worst;
    deficit += m.deficit(q);
  }
  if (deficit > limits.deficit)
    return -1;
  if (m.vertex[v].kind == optimize::Kind::surface)
    for (int64_t i = m.triangles.begin[v]; i < m.triangles.begin[v + 1]; ++i) {
      const SurfaceTriangle& s = m.triangle[m.triangles.item[i]];
      if (misfit(m.surface, m.guard, m.most_tilt, at(s.v[0]), at(s.v[1]), at(s.v[2])) > limits.misfit)
        return -1;
    }
  return worst;
}

/// Point active[n] looks for a place where its worst element is better, all others staying: to[v], moving[v] = 1.
/// First towards the mean of its neighbours, weighted by the volumes between (the flow), then along the ascent of
/// its worst element.
struct ProposeMove {
  FlowMesh m;
  const Vec3d* point;
  const uint32_t* active;
  Vec3d* to;
  uint8_t* moving;
  Limits* limits; ///< of active[n]

  /// Moves y onto what v is bound to. False when that cannot be.
  MOLMESH_HD bool constrain(int64_t v, Vec3d& y, double length) const {
    const optimize::Vertex& k = m.vertex[v];
    if (k.kind == optimize::Kind::surface)
      return m.surface.project(y, m.guard.reach * length) &&
             m.walls.allow(point[v], y, optimize::apart_from_walls * m.surface.spacing());
    for (int a = 0; a < 3; ++a)
      if (k.frozen >> a & 1)
        y[a] = point[v][a];
    return true;
  }

  MOLMESH_HD void operator()(int64_t n) const {
    const auto v = int32_t(active[n]);
    const Vec3d from = point[v];
    Limits l{2, 0, 1};
    Vec3d moment;
    double weight = 0, length = 0;
    int32_t bad = -1;
    for (int64_t i = m.elements.begin[v]; i < m.elements.begin[v + 1]; ++i) {
      const Corners& e = m.element[m.elements.item[i]];
      const Vec3d p[4] = {point[e.v[0]], point[e.v[1]], point[e.v[2]], point[e.v[3]]};
      const float q = tet_quality(p[0], p[1], p[2], p[3]);
      if (q < l.worst) {
        l.worst = q;
        bad = int32_t(m.elements.item[i]);
      }
      l.deficit += m.deficit(q);
      const Vec3d sum = p[0] + p[1] + p[2] + p[3];
      const double volume = std::abs(dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]));
      moment += volume * 0.25 * sum;
      weight += volume;
      for (int k = 0; k < 4; ++k)
        length += norm(p[k] - from);
    }
    length /= 3. * double(m.elements.begin[v + 1] - m.elements.begin[v]);
    if (m.vertex[v].kind == optimize::Kind::surface)
      for (int64_t i = m.triangles.begin[v]; i < m.triangles.begin[v + 1]; ++i) {
        const SurfaceTriangle& s = m.triangle[m.triangles.item[i]];
        const double f = misfit(m.surface, m.guard, m.most_tilt, point[s.v[0]], point[s.v[1]], point[s.v[2]]);
        l.misfit = f > l.misfit ? f : l.misfit;
      }
    limits[n] = l;
    moving[v] = 0;
    to[v] = from;
    Vec3d best = from;
    float best_q = l.worst + 1e-9f + 5e-3f * l.worst; // less is not worth a move
    bool found = false;
    const auto attempt = [&](Vec3d y) {
      if (!constrain(v, y, length))
        return false;
      const float q = worst_if_kept(m, v, OneMoved{point, v, y}, l);
      if (!(q > best_q))
        return false;
      best = y;
      best_q = q;
      return found = true;
    };
    const Vec3d mean = weight > 0 ? moment / weight - from : Vec3d{};
    for (double step = 1; step > 0.2; step *= 0.5)
      if (attempt(from + step * mean))
        break;
    const Vec3d up = ascent(v, bad, 1e-3 * length);
    for (double step = 0.25; step > 0.01; step *= 0.4)
      if (attempt(from + step * length * up))
        break;
    to[v] = best;
    moving[v] = found;
  }

private:
  /// Direction in which element e improves fastest when v moves; zero when flat.
  MOLMESH_HD Vec3d ascent(int32_t v, int32_t e, double step) const {
    Vec3d g;
    for (int a = 0; a < 3; ++a) {
      double q[2];
      for (int side = 0; side < 2; ++side) {
        OneMoved at{point, v, point[v]};
        at.at[a] += side ? step : -step;
        const Corners& c = m.element[e];
        q[side] = tet_quality(at(c.v[0]), at(c.v[1]), at(c.v[2]), at(c.v[3]));
      }
      g[a] = q[1] - q[0];
    }
    const double length = norm(g);
    return length > 0 ? g / length : Vec3d{};
  }
};

/// After all have moved: stays[n] = 1 for a moving point active[n] whose star does not keep to its limits.
struct CheckMove {
  FlowMesh m;
  Places at;
  const uint32_t* active;
  const Limits* limits;
  int64_t* stays;
  MOLMESH_HD void operator()(int64_t n) const {
    const int64_t v = active[n];
    stays[n] = at.moving[v] && worst_if_kept(m, v, at, limits[n]) < 0;
  }
};

/// Those that stay go back.
struct TakeBack {
  const uint32_t* active;
  const int64_t* stays; ///< scanned
  uint8_t* moving;
  MOLMESH_HD void operator()(int64_t n) const {
    if (stays[n + 1] != stays[n])
      moving[active[n]] = 0;
  }
};

struct CommitMoves {
  const uint32_t* active;
  const Vec3d* to;
  const uint8_t* moving;
  Vec3d* point;
  int64_t* moves;
  uint8_t* has_moved;
  MOLMESH_HD void operator()(int64_t n) const {
    const uint32_t v = active[n];
    moves[n] = moving[v];
    if (!moving[v])
      return;
    point[v] = to[v];
    has_moved[v] = 1;
  }
};
/// Quality of an element with a corner that has moved.
struct NewQuality {
  int32_t element;
  float q;
};
struct GatherNewQualities {
  const Corners* element;
  const Vec3d* point;
  const uint8_t* has_moved;
  MOLMESH_HD int64_t operator()(int64_t i, NewQuality* out) const {
    const Corners e = element[i];
    if (e.v[0] < 0 || !(has_moved[e.v[0]] || has_moved[e.v[1]] || has_moved[e.v[2]] || has_moved[e.v[3]]))
      return 0;
    if (out)
      *out = {int32_t(i), tet_quality(point[e.v[0]], point[e.v[1]], point[e.v[2]], point[e.v[3]])};
    return 1;
  }
};

/// The star of each point from pairs (point, item) sorted by point: begin[v] for v ≤ points.
struct StarBegin {
  const uint32_t* point_of; ///< [pairs] ascending
  int64_t pairs;
  int64_t* begin;
  MOLMESH_HD void operator()(int64_t v) const {
    int64_t low = 0, high = pairs;
    while (low < high) {
      const int64_t middle = (low + high) / 2;
      if (int64_t{point_of[middle]} < v)
        low = middle + 1;
      else
        high = middle;
    }
    begin[v] = low;
  }
};
/// Free slots hang on no point.
template <class Item, int corners>
struct StarPairs {
  const Item* item;
  uint32_t *point_of, *item_of;
  MOLMESH_HD void operator()(int64_t i) const {
    point_of[i] = uint32_t(item[i / corners].v[0] < 0 ? -1 : item[i / corners].v[i % corners]);
    item_of[i] = uint32_t(i / corners);
  }
};

/// Points by falling valence, so that those in one warp have about as much to do (§5).
struct ValenceKeys {
  const int64_t* begin;
  uint32_t *key, *order;
  MOLMESH_HD void operator()(int64_t v) const {
    key[v] = ~uint32_t(begin[v + 1] - begin[v]);
    order[v] = uint32_t(v);
  }
};

} // namespace molmesh::cuda
