// local_scaling.hpp — the surroundings of a point shrink towards it, and shells of new elements take the room.
#pragma once
#include "optimize/operations/region.hpp"
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

/// What shrinks towards a point: elements around it, out to a shell whose triangles face it.
struct Core {
  struct ShellTriangle {
    std::array<int32_t, 3> v; ///< seen from outside
    int32_t region;           ///< inside
  };
  std::vector<int32_t> vertex;  ///< of the surface: these are to come to the target
  std::vector<int32_t> element; ///< inside the shell, ascending
  std::vector<ShellTriangle> shell;
  bool through = false; ///< the surface runs through the shell; else it is closed and inside
  bool hole = false;    ///< closed: in the molecule
  Vec3d centre;         ///< closed: of its vertices

  bool has(int32_t v) const { return std::find(vertex.begin(), vertex.end(), v) != vertex.end(); }
  bool has(const std::array<int32_t, 3>& t) const { return has(t[0]) && has(t[1]) && has(t[2]); }
};

/// Elements join the core's beyond triangles that do not face c, or that the surface may not be left at or touches
/// from inside, until there are none; then those triangles are the shell. False where there is no such shell.
bool find_shell(const Region& r, Core& core, Vec3d c);

/// Contracts what is inside the shell towards c, to `scale`, with shells smaller by about `ratio` each. False, and
/// nothing changed, when that cannot be.
bool shrink(Region& r, const Core& core, Vec3d c, double scale, double ratio);

} // namespace molmesh::optimize
