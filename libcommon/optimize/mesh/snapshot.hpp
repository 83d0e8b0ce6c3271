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

/// How many operations were done.
struct Counts {
  int64_t moves = 0, edge_removals = 0, surface_flips = 0, face_swaps = 0, contractions = 0, splits = 0,
          cavity_shrinks = 0;
  Counts& operator+=(const Counts& o);
  int64_t total() const {
    return moves + edge_removals + surface_flips + face_swaps + contractions + splits + cavity_shrinks;
  }
};

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
