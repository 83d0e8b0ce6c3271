// piece.hpp — what shrinks towards a point: elements around it, out to a shell whose triangles face it.
#pragma once
#include "geom/vec.hpp"
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

struct Piece {
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

} // namespace molmesh::optimize
