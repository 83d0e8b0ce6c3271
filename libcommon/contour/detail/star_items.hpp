// star_items.hpp — the elements at each vertex that may move, and its neighbours. Host and device.
#pragma once
#include "geom/hd.hpp"
#include "mesh/tet_mesh.hpp"
#include <array>
#include <cstddef>
#include <cstdint>

namespace molmesh::contour::detail {

struct NumberCandidates {
  const int32_t* vertex;
  int32_t* number;
  HD void operator()(int64_t i) const { number[vertex[i]] = static_cast<int32_t>(i); }
};
/// Elements at a wanted vertex.
struct NearTets {
  static constexpr int64_t most = 1;
  const Tet* tet;
  const uint8_t* wanted;
  const int32_t* among; ///< null: all
  HD int64_t operator()(int64_t i, int32_t* out) const {
    const int64_t t = among ? among[i] : i;
    const Tet& v = tet[t];
    if (!(wanted[v[0]] | wanted[v[1]] | wanted[v[2]] | wanted[v[3]]))
      return 0;
    if (out)
      *out = static_cast<int32_t>(t);
    return 1;
  }
};
/// Of near element i: its corners' candidates, or -1.
struct CornerCandidates {
  const Tet* tet;
  const int32_t *near, *number;
  std::array<int32_t, 4>* corner;
  HD void operator()(int64_t i) const {
    const Tet& t = tet[near[i]];
    corner[i] = {number[t[0]], number[t[1]], number[t[2]], number[t[3]]};
  }
};
/// Corner i % 4 of near element i / 4.
struct CornerCandidate {
  const std::array<int32_t, 4>* corner;
  HD int64_t operator()(int64_t i) const { return corner[i >> 2][static_cast<size_t>(i & 3)]; }
};
/// In the order of the candidates, then of the elements.
struct PlaceStars {
  CornerCandidate of;
  int32_t *near_index, *owner;
  HD void operator()(int64_t slot, int64_t i) const {
    near_index[slot] = static_cast<int32_t>(i >> 2);
    owner[slot] = static_cast<int32_t>(of(i));
  }
};
struct FirstOfStars {
  const int32_t* owner;
  int64_t* first;
  HD void operator()(int64_t slot) const {
    if (slot == 0 || owner[slot - 1] != owner[slot])
      first[owner[slot]] = slot;
  }
};

/// Of a candidate: its neighbours and its elements.
struct NameStars {
  const int64_t* first;
  const int32_t* near;
  const std::array<int32_t, 4>* corner; ///< [near elements]
  int32_t* element;                     ///< places in `near` become elements
  int32_t* neighbour;                   ///< as RelaxView has it
  HD void operator()(int64_t c) const {
    constexpr int32_t kept = 16; // of those named last, which need not be named again
    int32_t last[kept];
    for (int32_t& j : last)
      j = -1;
    int32_t* const list = neighbour + 3 * first[c] + c;
    int64_t n = 0;
    for (int64_t k = first[c]; k < first[c + 1]; ++k) {
      for (size_t i = 0; i < 4; ++i) { // no branches: there is no telling
        const int32_t j = corner[element[k]][i];
        int32_t& known = last[j & (kept - 1)];
        list[n] = j;
        n += (j >= 0) & (j != c) & (j != known);
        known = j >= 0 ? j : known;
      }
      element[k] = near[element[k]];
    }
    list[n] = -1;
  }
};

} // namespace molmesh::contour::detail
