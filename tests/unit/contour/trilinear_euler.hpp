// trilinear_euler.hpp — the topology of a grid's isosurface, counted cell by cell.
#pragma once
#include "contour/surface/ambiguous_cell.hpp"
#include "grid/block_grid.hpp"
#include <array>
#include <numeric>

namespace molmesh::test {

/// Euler number of the trilinear isosurface without a mesh: twice that of its inside, which is the alternating sum
/// over cells, faces, edges and points of the Euler numbers of the inside's parts there.
inline int64_t trilinear_euler(const BlockGrid& grid) {
  const BlockIndex index(grid);
  int64_t chi = 0;
  Vec3i p;
  const Vec3i end = grid.frame.lower + grid.frame.points - Vec3i{1, 1, 1};
  for (p.x = grid.frame.lower.x; p.x < end.x; ++p.x)
    for (p.y = grid.frame.lower.y; p.y < end.y; ++p.y)
      for (p.z = grid.frame.lower.z; p.z < end.z; ++p.z) {
        double v[8];
        for (int c = 0; c < 8; ++c)
          v[c] = contour::over_isovalue(value_at(grid, index, p + Vec3i{c & 1, c >> 1 & 1, c >> 2}),
                                        static_cast<float>(grid.info.isovalue));
        std::array<int, 8> parent;
        std::iota(parent.begin(), parent.end(), 0);
        const auto find = [&](int i) {
          while (parent[i] != i)
            i = parent[i];
          return i;
        };
        const auto join = [&](int i, int j) { parent[find(i)] = find(j); };
        for (int c = 0; c < 8; ++c)
          for (int bit = 1; bit < 8; bit *= 2)
            if ((v[c] > 0) == (v[c ^ bit] > 0))
              join(c, c ^ bit);
        for (int f = 0; f < 6; ++f) {
          const int c[4] = {contour::face_corner_of(f, 0), contour::face_corner_of(f, 1),
                            contour::face_corner_of(f, 2), contour::face_corner_of(f, 3)};
          const contour::Diagonal d = contour::face_diagonal(v[c[0]], v[c[1]], v[c[2]], v[c[3]]);
          if (d != contour::Diagonal::none)
            join(contour::diagonal_corners(f, d)[0], contour::diagonal_corners(f, d)[1]);
          if (f % 2)
            continue; // each face once
          const int in = (v[c[0]] > 0) + (v[c[1]] > 0) + (v[c[2]] > 0) + (v[c[3]] > 0);
          const bool apart = d != contour::Diagonal::none && !(v[contour::diagonal_corners(f, d)[0]] > 0);
          chi -= in == 0 ? 0 : apart ? 2 : 1;
        }
        for (int c : {1, 2, 4})
          chi += v[0] > 0 || v[c] > 0;
        chi -= v[0] > 0;
        // The inside's parts in the cell, less the tunnels that the outside makes through them.
        const std::array<int, 8> label = contour::trilinear_components(v);
        for (int c = 0; c < 8; ++c)
          chi += v[c] > 0 ? label[c] == c : (label[c] == c) - (find(c) == c);
      }
  return 2 * chi;
}

} // namespace molmesh::test
