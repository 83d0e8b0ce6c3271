// tet_mesh.hpp — tetrahedra with regions and boundary triangles: what the .vtu file holds.
#pragma once
#include "base/large_array.hpp"
#include "geom/sphere.hpp"
#include "geom/vec.hpp"
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace molmesh {

using Tet = std::array<int32_t, 4>; ///< dot(cross(p1 - p0, p2 - p0), p3 - p0) > 0, VTK's order
using Tri = std::array<int32_t, 3>; ///< counter-clockwise seen from outside

enum Region : int32_t { molecule = 1, outside = 2, cavity = 3 };
enum Boundary : int32_t { surface = 1, box_x0 = 2, box_x1, box_y0, box_y1, box_z0, box_z1, outer_sphere = box_x0 };

/// Further values of every cell, tetrahedra first: integers or reals, the other vector is empty.
struct CellArray {
  std::string name;
  std::vector<int32_t> integer;
  std::vector<double> real;
};

/// UTF-8, of the whole mesh: the names that the integers of a CellArray count.
struct NamedText {
  std::string name, text;
};

/// Triangles are exactly the faces between regions and the faces with one tetrahedron. Molecular-surface triangles
/// point out of region 1, triangles of the box or sphere out of it. No duplicate or unused point (I6).
struct TetMesh {
  std::vector<Vec3d> point; ///< Å
  LargeArray<Tet> tet;
  std::vector<int32_t> region; ///< [tets] Region; any positive label of a foreign mesh
  std::vector<int32_t> part;   ///< [tets] METIS part, or empty
  std::vector<Tri> tri;
  std::vector<int32_t> boundary;  ///< [tris] Boundary; any positive label of a foreign mesh
  double isovalue = 1, decay = 0; ///< of the field that the surface is of; κ in Å⁻², 0: not known
  std::string source, creator;
  std::vector<CellArray> cell_array; ///< labels of tetlabel, or of a foreign mesh
  std::vector<NamedText> named_text;
  std::optional<Sphere>
      sphere;        ///< the outer boundary, with the label outer_sphere; none: a box, or no outer boundary
  int64_t atoms = 0; ///< of the field that the surface is of; 0: not known
};

/// Centroid (Å) of a cell as cell arrays count them: tetrahedra first, then triangles.
inline Vec3d cell_centroid(const TetMesh& m, size_t cell) {
  const auto p = [&](int32_t v) { return m.point[v]; };
  if (cell < m.tet.size()) {
    const Tet& t = m.tet[cell];
    return 0.25 * (p(t[0]) + p(t[1]) + p(t[2]) + p(t[3]));
  }
  const Tri& t = m.tri[cell - m.tet.size()];
  return (p(t[0]) + p(t[1]) + p(t[2])) / 3.0;
}

} // namespace molmesh
