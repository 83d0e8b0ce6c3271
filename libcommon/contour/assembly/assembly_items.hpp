// assembly_items.hpp — kernels that select and place the mesh's elements and number its points. Host and device.
#pragma once
#include "contour/elements/elements.hpp"
#include "par/atomic_updates.hpp"

namespace molmesh::contour {

/// Bit r: elements of Region r are wanted.
struct Wanted {
  uint8_t bits;
  MOLMESH_HD bool operator()(uint8_t region) const { return bits >> region & 1; }
};

/// The vertex by which a wanted element is put in order.
struct TetKey {
  const Tet* tet;
  const uint8_t* region;
  Wanted wanted;
  MOLMESH_HD int64_t operator()(int64_t t) const {
    const int32_t v = tet[t][0];
    return wanted(region[v]) ? v : -1;
  }
};
struct PlaceTets {
  const Tet* from;
  const uint8_t* region;
  Tet* to;
  int32_t* to_region;
  MOLMESH_HD void operator()(int64_t slot, int64_t t) const {
    to[slot] = from[t];
    to_region[slot] = region[from[t][0]];
  }
};

/// first: [points] the first element at each, by numbers below 2^32.
struct FirstElements {
  const Tet* tet;
  uint32_t* first;
  MOLMESH_HD void operator()(int64_t t) const {
    for (size_t c = 0; c < 4; ++c)
      par::lower(first[tet[t][c]], static_cast<uint32_t>(t));
  }
};
/// Points of which this element is the first, in its order.
struct FirstUses {
  const Tet* tet;
  const uint32_t* first;
  MOLMESH_HD int64_t operator()(int64_t t, int32_t* out) const {
    int64_t n = 0;
    for (size_t c = 0; c < 4; ++c)
      if (const int32_t v = tet[t][c]; first[v] == t) {
        if (out)
          out[n] = v;
        ++n;
      }
    return n;
  }
};
/// number: [points] of those that are used
struct NumberPoints {
  const int32_t* used;
  const Vec3d* position;
  int32_t* number;
  Vec3d* point;
  MOLMESH_HD void operator()(int64_t i) const {
    number[used[i]] = static_cast<int32_t>(i);
    point[i] = position[used[i]];
  }
};
struct Renumber {
  const int32_t* number;
  Tet* tet;
  MOLMESH_HD void operator()(int64_t t) const {
    for (size_t c = 0; c < 4; ++c)
      tet[t][c] = number[tet[t][c]];
  }
};

/// Faces between two regions, or at a wall, of which one is wanted.
struct GatherTriangles {
  ElementsView e;
  const uint8_t* region;
  Wanted wanted;
  MOLMESH_HD int64_t operator()(int64_t t, int64_t* out) const {
    const uint8_t behind = region[e.tri_sides[t][0]], front = region[e.tri_sides[t][1]];
    const bool kept =
        e.boundary[t] == surface ? behind != front && (wanted(behind) || wanted(front)) : wanted(behind);
    if (kept && out)
      *out = t;
    return kept;
  }
};
struct PlaceTriangles {
  ElementsView e;
  const int64_t* from;
  const int32_t* number;
  Tri* tri;
  int32_t* boundary;
  MOLMESH_HD void operator()(int64_t i) const {
    for (size_t c = 0; c < 3; ++c)
      tri[i][c] = number[e.tri[from[i]][c]];
    boundary[i] = e.boundary[from[i]];
  }
};

} // namespace molmesh::contour
