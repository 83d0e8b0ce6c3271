// chord_items.hpp — kernels that estimate, from the surface's samples, the volume that the chords of leaves cut
// off. It limits the error function's tolerance for small bodies. Host and device.
#pragma once
#include "contour/octree/error_function.hpp"
#include "contour/surface/surface_cell.hpp"
#include "geom/morton.hpp"
#include <cmath>
#include <cstdint>

namespace molmesh::contour {

/// Of the surface in the sample's cell, in squared fine spacings: a surface of area A crosses A (|nx| + |ny| +
/// |nz|) cells of a lattice on average.
MOLMESH_HD inline double sample_area(const SurfaceSample& s) {
  const double crossed = std::fabs(s.normal.x) + std::fabs(s.normal.y) + std::fabs(s.normal.z);
  return crossed > 0 ? 1 / crossed : 0;
}

/// Volume that the chords from the sample of cell i to those of the next cells along the axes cut off, less where
/// the surface is hollow, in cubed fine spacings. Along a chord d inward normals turn so that Δn · d = -κ d², and a
/// quadrangle of four chords lies a twelfth of their sum off on average.
/// Of large surfaces every so many cells speak for all: item i is the cell that many times i.
struct CutByCells {
  static constexpr int64_t enough = 1 << 17;
  const SurfaceCell* cell;
  const SurfaceSample* sample;
  const uint64_t* key; ///< of the cells
  int64_t n;
  float isovalue;
  double* cut = nullptr; ///< [items(n)]
  MOLMESH_HD static int64_t every(int64_t n) { return 1 + n / enough; }
  MOLMESH_HD static int64_t items(int64_t n) { return (n + every(n) - 1) / every(n); }
  MOLMESH_HD void operator()(int64_t i) const { cut[i] = static_cast<double>(every(n)) * of_cell(i * every(n)); }

  MOLMESH_HD double of_cell(int64_t i) const {
    double sum = 0;
    const uint32_t inside = inside_corners(cell[i], isovalue);
    for (int axis = 0; axis < 3; ++axis) {
      const uint32_t face = axis == 0 ? 0xAA : axis == 1 ? 0xCC : 0xF0;
      if ((inside & face) == 0 || (inside & face) == face)
        continue;
      const uint64_t beside = morton_after(key[i], axis, 0);
      const int64_t k = first_from(i, beside);
      if (k == n || key[k] != beside)
        continue; // beyond the lattice
      const SurfaceSample &a = sample[i], &b = sample[k];
      sum -= (sample_area(a) + sample_area(b)) / 24 * dot(b.normal - a.normal, b.point - a.point);
    }
    return sum;
  }

private:
  /// After i and likely near: the first key not below the one wanted, which is larger than key[i].
  MOLMESH_HD int64_t first_from(int64_t i, uint64_t wanted) const {
    int64_t step = 1;
    for (; i + step < n && key[i + step] < wanted; step *= 2)
      i += step;
    int64_t end = i + step < n ? i + step : n;
    while (end - i > 1) {
      const int64_t middle = (i + end) / 2;
      (key[middle] < wanted ? i : end) = middle;
    }
    return end;
  }
};

/// The same by nodes of a level, of the chords of leaves: chords twice as long cut off four times as much.
struct CutByNodes {
  const double* cell_cut; ///< of every so many cells
  int64_t every;
  SurfaceNodes nodes;
  NodeSet refined; ///< of this level
  int level;
  const double* child_cut; ///< level 1: null
  double* cut;
  MOLMESH_HD void operator()(int64_t i) const {
    const bool leaf = !(refined.word(nodes.key[i] >> 6) >> (nodes.key[i] & 63) & 1);
    const bool of_cells = leaf || !child_cut;
    const double* const from = of_cells ? cell_cut : child_cut;
    const int64_t begin = of_cells ? first_sample(nodes.cell_begin(i)) : nodes.child_begin(i),
                  end = of_cells ? first_sample(nodes.cell_begin(i + 1)) : nodes.child_begin(i + 1);
    double sum = 0;
    for (int64_t c = begin; c < end; ++c)
      sum += from[c];
    cut[i] = leaf ? sum * (1 << 2 * level) : sum;
  }

private:
  /// Of cells from this one on; both are below 2^31.
  MOLMESH_HD int64_t first_sample(int64_t cell) const {
    return static_cast<uint32_t>(cell + every - 1) / static_cast<uint32_t>(every);
  }
};

/// What the surface's area and the volume within are made of, in fine spacings.
struct SurfaceSums {
  double area = 0;
  // Of crossings with the lattice's lines along each axis: their number, the sum of their places, those outwards
  // less those inwards, and the same of their places. On a line the places' difference is what lies within: bodies
  // far apart do not blur each other.
  Vec3d crossings, places, outwards, moment;

  MOLMESH_HD SurfaceSums& operator+=(const SurfaceSums& o) {
    area += o.area;
    crossings += o.crossings;
    places += o.places;
    outwards += o.outwards;
    moment += o.moment;
    return *this;
  }
  /// Within the surface, by the axis whose lines see most of it: they all do where the box cuts nothing; lines that
  /// end at a wall see what lies between crossings, or those from their mean place.
  MOLMESH_HD double volume() const {
    double most = 0;
    for (int a = 0; a < 3; ++a)
      if (crossings[a] > 0)
        most = std::fmax(most, std::fabs(moment[a] - outwards[a] * places[a] / crossings[a]));
    return most;
  }
};

/// Of one cell, for the lines through its lowest corner. A crossing is taken to be where the sample is: the mean of
/// the cell's, so that what is too much on one side of a body is too little on the other.
MOLMESH_HD inline SurfaceSums sums_of_cell(const SurfaceCell& cell, const SurfaceSample& s, float isovalue) {
  SurfaceSums sums;
  sums.area = sample_area(s);
  const bool inside = cell.value[0] > isovalue;
  for (int a = 0; a < 3; ++a)
    if ((cell.value[1 << a] > isovalue) != inside) {
      const double sign = inside ? 1 : -1;
      sums.crossings[a] = 1;
      sums.places[a] = s.point[a];
      sums.outwards[a] = sign;
      sums.moment[a] = sign * s.point[a];
    }
  return sums;
}

/// Item i sums `run` cells, so that sums keep their order.
struct SumCells {
  static constexpr int64_t run = 1024, grain = 1;
  const SurfaceCell* cell;
  const SurfaceSample* sample;
  int64_t cells;
  float isovalue;
  SurfaceSums* out;
  MOLMESH_HD void operator()(int64_t i) const {
    SurfaceSums sums;
    for (int64_t c = run * i; c < run * (i + 1) && c < cells; ++c)
      sums += sums_of_cell(cell[c], sample[c], isovalue);
    out[i] = sums;
  }
};

} // namespace molmesh::contour
