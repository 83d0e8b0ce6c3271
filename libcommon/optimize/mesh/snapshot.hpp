// snapshot.hpp — counts of operations, the slots of a part, and its state at one moment.
#pragma once
#include "optimize/crossings/free_triangles.hpp"
#include "optimize/mesh/change_log.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace molmesh::optimize {

/// How many operations were done. A new one is one more member and one more entry of `all`.
struct Counts {
  int64_t moves = 0, edge_removals = 0, surface_flips = 0, face_swaps = 0, contractions = 0, splits = 0,
          cavity_shrinks = 0;
  static constexpr std::array<int64_t Counts::*, 7> all = {
      &Counts::moves,        &Counts::edge_removals, &Counts::surface_flips, &Counts::face_swaps,
      &Counts::contractions, &Counts::splits,        &Counts::cavity_shrinks};
  Counts& operator+=(const Counts& o) {
    for (const auto count : all)
      this->*count += o.*count;
    return *this;
  }
  int64_t total() const {
    int64_t sum = 0;
    for (const auto count : all)
      sum += this->*count;
    return sum;
  }
};
static_assert(sizeof(Counts) == Counts::all.size() * sizeof(int64_t), "every member is in the list");

/// Slots reserved for new elements and vertices of one part; nothing lives in them.
struct PartRoom {
  int32_t part = 0;
  std::vector<int32_t> element, vertex;
};

/// The state of a part, for Region::restore(), or what has changed in it, for Region::redo().
struct Snapshot {
  struct Corner {
    int32_t id;
    Vec3d point;
    Vertex vertex;
    int32_t incident, touched;
    uint32_t state;
  };
  struct Side {
    int32_t element, n;
    uint8_t face, label;
  };
  std::vector<std::pair<int32_t, Element>> element; ///< ascending
  std::vector<std::array<uint32_t, 4>> corner_of;   ///< [element] in `corner`
  std::vector<Corner> corner;
  std::vector<Side> side; ///< faces of other parts' elements towards these
  PartRoom room;
  FreeTriangles free_triangles{1};
  Counts counts;
  uint64_t number = 0; ///< of the region's
  ChangeLog::Moment taken;
};

} // namespace molmesh::optimize
