// relax_items.hpp — kernels of relaxation: which elements are bad, which vertices may move, in this round and in
// the next. Host and device.
#pragma once
#include "contour/complex/complex.hpp"
#include "contour/elements/elements.hpp"
#include "geom/tet_quality.hpp"
#include "par/atomic_updates.hpp"
#include <array>

namespace molmesh::contour {

/// [vertices of the complex] 1: a grid point that has not moved; 2 + level: a dual vertex of no surface cell; 0:
/// any other. With the flag `unmeshed`: a grid point or split cell's centre on the side that is not meshed.
struct LatticeClasses {
  static constexpr uint8_t unmeshed = 0x80;
  ComplexView c;
  uint8_t* of;
  MOLMESH_HD void operator()(int64_t i) const {
    const auto v = static_cast<int32_t>(i), leaf = c.leaf_of(v);
    const bool is_unmeshed = c.unmeshed == (c.inside(v) ? Side::inside : Side::outside);
    uint8_t is = 0;
    if (leaf < 0)
      is = !c.has_moved[v];
    else if (v == c.dual(leaf) && c.side[leaf] != Side::crossed)
      is = static_cast<uint8_t>(2 + c.tree.level[leaf]);
    of[v] = is_unmeshed && (leaf < 0 || v == c.split[leaf]) ? is | unmeshed : is;
  }
};

/// What is known of elements by their vertices.
struct ElementClasses {
  const uint8_t* lattice_class; ///< LatticeClasses
  int64_t known;                ///< of the vertices

  MOLMESH_HD bool is_meshed(const Tet& t) const { return !(class_of(t[0]) & LatticeClasses::unmeshed); }
  /// The lattice's own elements need no look: an edge of it with the middles of two boxes of one size.
  MOLMESH_HD bool of_lattice(const Tet& t) const {
    const uint8_t dual = class_of(t[2]); // near the surface this one says it
    return dual >= 2 && class_of(t[3]) == dual && class_of(t[0]) == 1 && class_of(t[1]) == 1;
  }

private:
  MOLMESH_HD uint8_t class_of(int32_t vertex) const { return vertex < known ? lattice_class[vertex] : uint8_t{0}; }
};

/// An element on the side that is not meshed has to stay positive, and is left alone where its sines are a quarter
/// of what others should have: flatter ones would hold vertices where they are. A power of two: no rounding.
inline constexpr float unmeshed_weight = 16;

struct Qualities {
  ElementsView e;
  ElementClasses classes;
  double shape; ///< of Q, as tet_quality has it
  float* quality;
  MOLMESH_HD void operator()(int64_t t) const {
    const Tet& v = e.tet[t];
    quality[t] = classes.of_lattice(v) ? 1
                                       : weighted(v, tet_quality(e.position[v[0]], e.position[v[1]],
                                                                 e.position[v[2]], e.position[v[3]], shape));
  }
  MOLMESH_HD float weighted(const Tet& t, float q) const { return classes.is_meshed(t) ? q : unmeshed_weight * q; }
};

/// What a vertex is bound to, by 4 flags: a wall across x, y, z, and the surface.
struct Bounds {
  uint8_t* flag;
  MOLMESH_HD bool on_wall(int64_t vertex, int axis) const { return flag[4 * vertex + axis]; }
  MOLMESH_HD bool on_surface(int64_t vertex) const { return flag[4 * vertex + 3]; }
};
struct RaiseBounds {
  ElementsView e;
  Bounds bound;
  MOLMESH_HD void operator()(int64_t t) const {
    const int32_t label = e.boundary[t];
    const int which = label == surface ? 3 : (label - box_x0) / 2;
    for (size_t c = 0; c < 3; ++c)
      if (uint8_t& flag = bound.flag[int64_t{4} * e.tri[t][c] + which]; !par::seen(flag))
        par::raise(flag);
  }
};

/// What a round works on. Candidates: vertices of bad elements that may move.
struct RelaxView {
  ElementsView e;
  Bounds bound;
  ElementClasses classes;
  float* quality;           ///< [tets] times unmeshed_weight where the element is not meshed
  float goal;               ///< elements below it are bad
  double shape;             ///< of Q, as tet_quality has it
  const int32_t* vertex;    ///< [candidates] ascending
  const int64_t* first;     ///< [candidates + 1] into element
  const int32_t* element;   ///< ascending at each candidate
  const int32_t* neighbour; ///< [3 · entries of element + candidates]
  float* worst;             ///< [candidates] worst element's quality as the round began
  uint32_t* turn;           ///< [candidates]
  uint8_t* wakes;           ///< [candidates] looks again in the next round
  uint8_t* changed;         ///< [candidates] since `worst` was found an element may have
  int32_t* moves;           ///< [candidates] how often it has moved

  /// Candidates that share an element with candidate c, some more than once, up to the first -1.
  MOLMESH_HD const int32_t* neighbours(int64_t c) const { return neighbour + 3 * first[c] + c; }

  /// Of candidate c, where an element may have changed.
  MOLMESH_HD void update_worst(int64_t c) const {
    if (!changed[c])
      return;
    float w = 1;
    for (int64_t k = first[c]; k < first[c + 1]; ++k)
      if (const float q = quality[element[k]]; q < w)
        w = q;
    worst[c] = w;
    changed[c] = 0;
  }

  static constexpr uint32_t at_rest = ~uint32_t{0}; ///< of turn: does not want to move
};

/// Of run i of elements.
struct WantVertices {
  static constexpr int64_t run = 16;
  ElementsView e;
  Bounds bound;
  const float* quality;
  float goal;
  bool surface_moves;
  const int32_t* near;   ///< the elements that may be bad; null: all
  int64_t n;             ///< how many
  const int32_t* number; ///< [vertices] of the pass before, where there was one
  uint8_t* wanted;       ///< [vertices]
  uint8_t* has_new;      ///< raised where one was no candidate before
  MOLMESH_HD void operator()(int64_t i) const {
    const int64_t begin = run * i, end = begin + run < n ? begin + run : n;
    if (!near && end == begin + run && !any_bad(quality + begin))
      return;
    for (int64_t k = begin; k < end; ++k)
      want(near ? near[k] : k);
  }

private:
  MOLMESH_HD bool any_bad(const float* of_run) const {
    int bad = 0; // no branches: most runs have none
    for (int64_t k = 0; k < run; ++k)
      bad |= of_run[k] < goal;
    return bad;
  }
  MOLMESH_HD void want(int64_t t) const {
    for (size_t c = 0; quality[t] < goal && c < 4; ++c)
      if (const int32_t v = e.tet[t][c]; surface_moves || !bound.on_surface(v)) {
        par::raise(wanted[v]);
        if (number && number[v] < 0)
          par::raise(*has_new);
      }
  }
};

/// Whose turn it is: another order in each round, lest one vertex that creeps holds up its neighbours.
MOLMESH_HD inline uint32_t turn(int32_t candidate, int round) {
  uint64_t h =
      static_cast<uint64_t>(candidate) * 0x9E3779B97F4A7C15u + static_cast<uint64_t>(round) * 0xC2B2AE3D27D4EB4Fu;
  h = (h ^ h >> 29) * 0x165667B19E3779F9u;
  return static_cast<uint32_t>(h >> 33);
}

/// Of active candidates.
struct StartRound {
  RelaxView r;
  const int32_t* active;
  int round;
  MOLMESH_HD void operator()(int64_t i) const {
    const int32_t c = active[i];
    r.update_worst(c);
    r.turn[c] = r.worst[c] < r.goal ? turn(c, round) : RelaxView::at_rest;
    r.wakes[c] = 0;
  }
};

enum class Fate : uint8_t { waits, stays, moves };

/// Whether a candidate wants to move and none of its neighbours does whose turn is earlier: `stays` until it has
/// moved. No two of them share an element.
struct ChooseFirst {
  static constexpr int64_t grain = 64;
  RelaxView r;
  const int32_t* active;
  Fate* fate;
  MOLMESH_HD void operator()(int64_t i) const { fate[i] = is_first(active[i]) ? Fate::stays : Fate::waits; }

private:
  MOLMESH_HD bool is_first(int32_t c) const {
    const uint32_t mine = r.turn[c];
    if (mine == RelaxView::at_rest)
      return false;
    for (const int32_t* j = r.neighbours(c); *j >= 0; ++j)
      if (r.turn[*j] < mine || (r.turn[*j] == mine && *j < c))
        return false;
    return true;
  }
};
/// Those who still want to, and all round one that moved, look again; until then all are at rest.
struct WakeNeighbours {
  static constexpr int64_t grain = 64;
  RelaxView r;
  const int32_t* active;
  const Fate* fate;
  MOLMESH_HD void operator()(int64_t i) const {
    const int32_t c = active[i];
    if (fate[i] == Fate::waits && r.turn[c] != RelaxView::at_rest)
      par::raise(r.wakes[c]);
    r.turn[c] = RelaxView::at_rest;
    if (fate[i] != Fate::moves)
      return;
    ++r.moves[c];
    par::raise(r.wakes[c]);
    par::raise(r.changed[c]);
    for (const int32_t* j = r.neighbours(c); *j >= 0; ++j) {
      par::raise(r.wakes[*j]);
      par::raise(r.changed[*j]);
    }
  }
};

} // namespace molmesh::contour
