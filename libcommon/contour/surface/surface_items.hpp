// surface_items.hpp — kernels that find the cells that the surface crosses, in blocks of 8³ as bits, and make their
// values and samples. The signs of all points replace the minimum and maximum per octree cell of section 4.1 of
// Liao et al. 2013. Host and device.
#pragma once
#include "base/bits.hpp"
#include "contour/surface/block_window.hpp"
#include "contour/surface/surface_cell.hpp"
#include "geom/morton.hpp"
#include "par/passes.hpp"

namespace molmesh::contour {

/// Blocks of the lattice (Morton keys / 8³) with a cell that block i of the grid may make a surface cell. Where a
/// wall cuts the grid, values between two planes are met too, so that blocks further off and inside ones count.
struct CoveredBlocks {
  LatticeView l;
  const Vec3i* corner;
  MOLMESH_HD int64_t operator()(int64_t i, par::KeyedWord* out) const {
    const int32_t below = l.any_cut ? 2 : 1, above = l.any_cut ? 8 : 7;
    const Vec3i p = corner[i] - l.base;
    Vec3i first, last;
    for (int a = 0; a < 3; ++a) {
      first[a] = p[a] < below ? 0 : (p[a] - below) >> 3;
      last[a] = (p[a] + above < l.cells[a] ? p[a] + above : l.cells[a] - 1) >> 3; // -1 below the lattice
    }
    int64_t n = 0;
    for (Vec3i b = first; b.x <= last.x; ++b.x)
      for (b.y = first.y; b.y <= last.y; ++b.y)
        for (b.z = first.z; b.z <= last.z; ++b.z, ++n)
          if (out)
            out[n] = {morton(b), 0};
    return n;
  }
};

/// Bits of the surface cells of block i, by their place along the curve; its first one with an inactive corner.
struct CrossedCells {
  LatticeView l;
  const par::KeyedWord* block;
  uint64_t* crossed; ///< [8 blocks]
  int64_t* failed;   ///< [blocks] 1: it has such a cell,
  uint64_t* culprit; ///< [blocks] with this key

  MOLMESH_HD void operator()(int64_t i) const {
    const Vec3i corner = morton_point(block[i].key << 9), cells = l.cells - corner;
    const BlockWindow window(l, corner);
    uint64_t* const out = crossed + 8 * i;
    for (int w = 0; w < 8; ++w)
      out[w] = 0;
    failed[i] = 0;
    if (window.one_sided())
      return;
    const uint32_t in_z = cells.z < 8 ? (1u << cells.z) - 1 : 0xFF;
    uint32_t row[2][9];
    for (int x = 0; x < 9; ++x) {
      for (int y = 0; y < 9; ++y)
        row[x & 1][y] = window.inside(x, y);
      for (int y = 0; x > 0 && x <= cells.x && y < 8 && y < cells.y; ++y) {
        const uint32_t any = row[0][y] | row[0][y + 1] | row[1][y] | row[1][y + 1];
        const uint32_t all = row[0][y] & row[0][y + 1] & row[1][y] & row[1][y + 1];
        const uint32_t cell = (any | any >> 1) & ~(all & all >> 1) & in_z;
        if (cell == 0)
          continue;
        add(out, x - 1, y, cell);
        const uint32_t known =
            window.active(x - 1, y) & window.active(x - 1, y + 1) & window.active(x, y) & window.active(x, y + 1);
        const uint32_t unknown = cell & ~(known & known >> 1) & ~interpolated(corner + Vec3i{x - 1, y, 0});
        if (unknown != 0 && failed[i] == 0) {
          failed[i] = 1;
          culprit[i] = morton(corner + Vec3i{x - 1, y, lowest_bit(unknown)});
        }
      }
    }
  }

private:
  /// Cells z … z + 7 of row (x, y) beside a wall that cuts the grid.
  MOLMESH_HD uint32_t interpolated(Vec3i p) const {
    if (!l.any_cut)
      return 0;
    uint32_t cut = 0;
    for (int z = 0; z < 8; ++z)
      cut |= uint32_t{l.on_cut(p + Vec3i{0, 0, z}) || l.on_cut(p + Vec3i{1, 1, z + 1})} << z;
    return cut;
  }
  MOLMESH_HD static void add(uint64_t* out, int x, int y, uint32_t row) {
    const auto spread = [](uint64_t four) {
      return (four & 1) | (four & 2) << 3 | (four & 4) << 30 | (four & 8) << 33;
    };
    const int word = x >> 2 | y >> 2 << 1, shift = (x & 1) | (y & 1) << 1 | (x & 2) << 2 | (y & 2) << 3;
    out[word] |= spread(row & 15) << shift;
    out[word | 4] |= spread(row >> 4) << shift;
  }
};

/// The cells of word i, 4³ of them at most.
struct MakeSurfaceCells {
  LatticeView l;
  const par::KeyedWord* block;
  const uint64_t* crossed;
  MOLMESH_HD int64_t operator()(int64_t i, SurfaceCell* out) const {
    if (out && crossed[i]) {
      const uint64_t first = block[i >> 3].key << 9 | static_cast<uint64_t>(i & 7) << 6;
      const BlockWindow window(l, morton_point(first), 4);
      for (uint64_t bits = crossed[i]; bits; bits &= bits - 1, ++out) {
        const int k = lowest_bit(bits);
        out->key = first | static_cast<uint64_t>(k);
        window.corner_values({(k & 1) | (k >> 2 & 2), (k >> 1 & 1) | (k >> 3 & 2), (k >> 2 & 1) | (k >> 4 & 2)},
                             out->value);
      }
    }
    return count_bits(crossed[i]);
  }
};

/// point: within the cell; gradient: in its direction.
MOLMESH_HD inline SurfaceSample sample_of(const SurfaceCell& cell, Vec3d point, Vec3d gradient) {
  const double length = norm(gradient);
  return {to_double(morton_point(cell.key)) + point, length > 0 ? gradient / length : Vec3d{}};
}

struct MakeSamples {
  const SurfaceCell* cell;
  double isovalue;
  SurfaceSample* sample;
  MOLMESH_HD void operator()(int64_t i) const {
    double v[8], point[3], gradient[3];
    for (int c = 0; c < 8; ++c)
      v[c] = cell[i].value[c];
    sample_cells<double, uint64_t>(v, isovalue, point, gradient);
    sample[i] = sample_of(cell[i], {point[0], point[1], point[2]}, {gradient[0], gradient[1], gradient[2]});
  }
};

} // namespace molmesh::contour
