// star_items.hpp — kernels that gather the elements at each vertex that may move, and its neighbours. Host and
// device.
#pragma once
#include "base/hd.hpp"
#include "mesh/tet_mesh.hpp"
#include <array>
#include <cstddef>
#include <cstdint>

namespace molmesh::contour {

struct NumberCandidates {
  const int32_t* vertex;
  int32_t* number;
  MOLMESH_HD void operator()(int64_t i) const { number[vertex[i]] = static_cast<int32_t>(i); }
};
struct ForgetCandidates {
  const int32_t* vertex;
  int32_t* number;
  MOLMESH_HD void operator()(int64_t i) const { number[vertex[i]] = -1; }
};
/// Elements at a wanted vertex.
struct NearTets {
  static constexpr int64_t most = 1;
  const Tet* tet;
  const uint8_t* wanted;
  const int32_t* among; ///< null: all
  MOLMESH_HD int64_t operator()(int64_t i, int32_t* out) const {
    const int64_t t = among ? among[i] : i;
    const Tet& v = tet[t];
    if (out) // wanted or not, since there is no telling: the next one takes the place
      *out = static_cast<int32_t>(t);
    return (wanted[v[0]] | wanted[v[1]] | wanted[v[2]] | wanted[v[3]]) != 0;
  }
};
struct NearElement {
  std::array<int32_t, 4> corner; ///< candidates, or -1
  float quality;
};
struct DescribeNear {
  const Tet* tet;
  const float* quality;
  const int32_t *near, *number;
  NearElement* out;
  MOLMESH_HD void operator()(int64_t i) const {
    const Tet& t = tet[near[i]];
    out[i] = {{number[t[0]], number[t[1]], number[t[2]], number[t[3]]}, quality[near[i]]};
  }
};
/// Corner i % 4 of near element i / 4.
struct CornerCandidate {
  const NearElement* element;
  MOLMESH_HD int64_t operator()(int64_t i) const { return element[i >> 2].corner[i & 3]; }
};
/// In the order of the candidates, then of the elements.
struct PlaceStars {
  CornerCandidate of;
  int32_t *near_index, *owner;
  MOLMESH_HD void operator()(int64_t slot, int64_t i) const {
    near_index[slot] = static_cast<int32_t>(i >> 2);
    owner[slot] = static_cast<int32_t>(of(i));
  }
};
/// Those between two owners have none; those after the last keep what they have.
struct FirstOfStars {
  const int32_t* owner;
  int64_t* first;
  MOLMESH_HD void operator()(int64_t slot) const {
    for (int32_t c = slot == 0 ? 0 : owner[slot - 1] + 1; c <= owner[slot]; ++c)
      first[c] = slot;
  }
};

/// Of a candidate: its neighbours, its elements and the worst one's quality.
struct ListNeighbours {
  const int64_t* first;
  const int32_t* near;
  const NearElement* described; ///< [near elements]
  int32_t* element;             ///< places in `near` become elements
  int32_t* neighbour;           ///< as RelaxView has it
  float* worst;
  MOLMESH_HD void operator()(int64_t c) const {
    constexpr int32_t kept = 16; // of those named last, which need not be named again
    int32_t last[kept];
    for (int32_t& j : last)
      j = -1;
    int32_t* const list = neighbour + 3 * first[c] + c;
    int64_t n = 0;
    float w = 1;
    for (int64_t k = first[c]; k < first[c + 1]; ++k) {
      const NearElement& e = described[element[k]];
      w = e.quality < w ? e.quality : w;
      for (size_t i = 0; i < 4; ++i) { // no branches: there is no telling
        const int32_t j = e.corner[i];
        int32_t& known = last[j & (kept - 1)];
        list[n] = j;
        n += (j >= 0) & (j != c) & (j != known);
        known = j >= 0 ? j : known;
      }
      element[k] = near[element[k]];
    }
    list[n] = -1;
    worst[c] = w;
  }
};

} // namespace molmesh::contour
