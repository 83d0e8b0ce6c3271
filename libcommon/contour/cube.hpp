// cube.hpp — numbering of a cell's corners, edges and faces; its topology under the trilinear function.
// Section 4.1 of Liao et al. 2013 (ambiguous cells, their reference 51).
#pragma once
#include "geom/hd.hpp"
#include "geom/vec.hpp"
#include <array>
#include <cstdint>

namespace molmesh::contour {

/// Corner c of a cell lies here, from its lower corner.
constexpr Vec3i corner_step(int c) {
  return {c & 1, c >> 1 & 1, c >> 2 & 1};
}

/// Corner i of face f, counter-clockwise seen from outside the cell. Faces: 0..5 = -x, +x, -y, +y, -z, +z.
/// A function: a device cannot see the table below.
HD constexpr int face_corner_of(int f, int i) {
  return (f == 0   ? 0x2640
          : f == 1 ? 0x5731
          : f == 2 ? 0x4510
          : f == 3 ? 0x3762
          : f == 4 ? 0x1320
                   : 0x6754) >>
             (4 * i) &
         7;
}

/// The same as a table.
struct FaceCorners {
  int corner[6][4];
  constexpr const int* operator[](int f) const { return corner[f]; }
};
inline constexpr FaceCorners face_corner = [] {
  FaceCorners table{};
  for (int f = 0; f < 6; ++f)
    for (int i = 0; i < 4; ++i)
      table.corner[f][i] = face_corner_of(f, i);
  return table;
}();

/// No diagonal, or the one from face_corner[f][0] to [2] (even), or from [1] to [3] (odd).
enum class Diagonal : uint8_t { none, even, odd };

/// Corners at either end of face f's diagonal d: 0 and 2, or 1 and 3, in face order.
constexpr std::array<int, 2> diagonal_corners(int f, Diagonal d) {
  const int first = d == Diagonal::even ? 0 : 1;
  return {face_corner[f][first], face_corner[f][first + 2]};
}

/// value[8]: corner values minus the isovalue; inside where > 0, zero counts as outside.
struct CellTopology {
  uint8_t mask = 0;                 ///< bit c: corner c is inside
  std::array<Diagonal, 6> diagonal; ///< joins the pair that the bilinear function joins on an ambiguous face
  /// The surface meets the cell's boundary in `loops` closed curves; 1: a disc, one dual vertex will do.
  int loops = 0;
  /// With two loops or more the cell is split around its centre, which takes the side that joins what the trilinear
  /// function joins. With `chop` ≥ 0 that corner (an isolated one) is cut off first.
  bool centre_inside = false;
  int chop = -1;
  bool split() const { return loops > 1; }
};

/// Which diagonal a face with these values (in face order, minus the isovalue) needs. The same for both its cells.
HD inline Diagonal face_diagonal(double a, double b, double c, double d) {
  const bool in = a > 0;
  if ((c > 0) != in || (b > 0) == in || (d > 0) == in)
    return Diagonal::none;
  // The saddle of the bilinear function is inside exactly when the inside pair has the larger product.
  const bool even_joined = in ? a * c > b * d : !(b * d > a * c);
  return even_joined ? Diagonal::even : Diagonal::odd;
}

CellTopology cell_topology(const double value[8]);

/// For each corner a label: two inside (outside) corners carry the same label exactly when the inside (outside) of
/// the trilinear function joins them within the cell. Labels are corner numbers.
std::array<int, 8> trilinear_components(const double value[8]);

} // namespace molmesh::contour
