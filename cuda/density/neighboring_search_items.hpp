// neighboring_search_items.hpp — halves cubes, counts states of blocks and merges known ones.
#pragma once
#include "cuda/density/band_items.hpp"
#include "cuda/density/block_bounds.hpp"
#include "par/items.hpp"

namespace molmesh::cuda {

/// Child i % 8 of cube i / 8: kept when it holds a block of the grid with x in [begin_x, end_x) and a cluster is
/// near.
struct HalveCubes {
  FieldView f;
  BlockFrame frame;
  bool all; ///< without asking for clusters
  int32_t edge, begin_x, end_x;
  const Key* parent;
  Key* child;
  int64_t* kept;

  MOLMESH_HD void operator()(int64_t i) const {
    const int c = int(i & 7);
    const Vec3i b = BlockFrame::block(parent[i >> 3]) + edge * Vec3i{c >> 2, c >> 1 & 1, c & 1};
    child[i] = BlockFrame::key(b);
    bool keep = frame.holds(b) && b.x < end_x && b.x + edge > begin_x;
    if (keep && !all) {
      keep = false;
      for_near_clusters(f, frame.box(b, edge), [&](int32_t) {
        keep = true;
        return false;
      });
    }
    kept[i] = keep;
  }
};

struct CountStates {
  const State* state;
  int64_t *open, *known;
  MOLMESH_HD void operator()(int64_t i) const {
    open[i] = state[i] == State::open;
    known[i] = state[i] != State::outside;
  }
};

/// Of the blocks that are not outside: mask and values of those that were evaluated, the mask of a side of the
/// others.
struct FillKnown {
  const State* state;
  const int64_t *open, *known; ///< scanned
  const uint64_t *mask, *above;
  const float* value;
  const uint64_t** mask_of;
  const float** value_of;
  MOLMESH_HD void operator()(int64_t i) const {
    if (state[i] == State::outside)
      return;
    const bool is_open = state[i] == State::open;
    mask_of[known[i]] = is_open ? mask + 16 * open[i] : above;
    value_of[known[i]] = is_open ? value + 512 * open[i] : nullptr;
  }
};

/// Flags the first of equal keys.
struct FirstOfEqual {
  const Key* key;
  int64_t* first;
  MOLMESH_HD void operator()(int64_t i) const { first[i] = i == 0 || key[i] != key[i - 1]; }
};

/// Known blocks and then new ones, whose keys replace equal ones among the known: those get no_key, and replaced 1.
struct MergeKeys {
  KnownView known;
  const Key* more;
  int64_t n_more;
  Key* key;
  uint32_t* index;
  int64_t* replaced;
  MOLMESH_HD void operator()(int64_t i) const {
    index[i] = uint32_t(i);
    replaced[i] = 0;
    if (i >= known.n) {
      key[i] = more[i - known.n];
    } else {
      replaced[i] = find_key(more, n_more, known.key[i]) >= 0;
      key[i] = replaced[i] ? no_key : known.key[i];
    }
  }
};
struct MergeKnown {
  KnownView known;
  const uint32_t* index;
  const uint64_t* mask;
  const float* value;
  const uint64_t** mask_of;
  const float** value_of;
  MOLMESH_HD void operator()(int64_t i) const {
    const int64_t k = index[i];
    mask_of[i] = k < known.n ? known.mask[k] : mask + 16 * (k - known.n);
    value_of[i] = k < known.n ? known.value[k] : value + 512 * (k - known.n);
  }
};

/// Points of the grid in blocks with begin_x ≤ x < end_x.
struct CountPoints {
  BlockFrame frame;
  int32_t begin_x, end_x;
  const Key* key;
  int64_t* points;
  MOLMESH_HD void operator()(int64_t i) const {
    const Vec3i b = BlockFrame::block(key[i]);
    points[i] = b.x >= begin_x && b.x < end_x ? frame.grid.points_of_block(frame.corner(b)) : 0;
  }
};

struct Widen {
  const uint32_t* from;
  int64_t* to;
  MOLMESH_HD void operator()(int64_t i) const { to[i] = from[i]; }
};

struct SortKeys { ///< most atoms first
  const uint32_t* atoms;
  uint32_t *key, *index;
  MOLMESH_HD void operator()(int64_t i) const {
    key[i] = ~atoms[i];
    index[i] = uint32_t(i);
  }
};

} // namespace molmesh::cuda
