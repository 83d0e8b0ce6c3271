// chord_items.hpp — the volume that the chords of a selection of leaves cut off, estimated from the surface's
// samples.
#pragma once
#include "contour/detail/node_items.hpp"
#include <cmath>
#include <cstdint>

namespace molmesh::contour::detail {

/// Of the surface in the sample's cell, in squared fine spacings: a surface of area A crosses A (|nx| + |ny| +
/// |nz|) cells of a lattice on average.
HD inline double sample_area(const SurfaceSample& s) {
  const double crossed = std::fabs(s.normal.x) + std::fabs(s.normal.y) + std::fabs(s.normal.z);
  return crossed > 0 ? 1 / crossed : 0;
}

/// Volume that chords of leaves cut off, less where the surface is hollow, in cubed fine spacings, by nodes of a
/// level. Where κ is the mean curvature, chords of triangles with legs e lie κ e²/6 off on average; the samples of
/// a square of side e lie <t²> = e²/6 from its middle, and their inward normals turn so that n · t = -κ t². Cells
/// of half the size cut off a quarter.
struct CutOff {
  const SurfaceSample* sample;
  SurfaceNodes nodes;
  NodeSet refined;         ///< of this level
  const double* child_cut; ///< level 1: null
  double* cut;
  HD void operator()(int64_t i) const {
    const bool leaf = !(refined.word(nodes.key[i] >> 6) >> (nodes.key[i] & 63) & 1);
    cut[i] = 0;
    if (!leaf && child_cut)
      for (int64_t c = nodes.child_begin(i); c < nodes.child_begin(i + 1); ++c)
        cut[i] += child_cut[c];
    else
      cut[i] = (leaf ? 1 : 0.25) * of_one_cell(sample + nodes.cell_begin(i), sample + nodes.cell_begin(i + 1));
  }

private:
  HD static double of_one_cell(const SurfaceSample* begin, const SurfaceSample* end) {
    const Sheet sheet(begin, end);
    double sum = 0;
    for (const SurfaceSample* s = begin; s < end; ++s) {
      if (!sheet.has(*s))
        return 0; // nothing is known
      sum -= sample_area(*s) * dot(s->normal, s->point - sheet.middle);
    }
    return sum;
  }
};

/// Of samples: what the divergence theorem makes a volume of.
struct SurfaceSums {
  double area = 0, flux = 0; ///< flux: of the vector to the point through the surface, inwards
  Vec3d moment, normal;      ///< sums of points and of normals
  HD SurfaceSums& operator+=(const SurfaceSums& o) {
    area += o.area;
    flux += o.flux;
    moment += o.moment;
    normal += o.normal;
    return *this;
  }
  /// Enclosed by a closed surface; of one that the box cuts, of the cones from its middle.
  double volume() const { return area > 0 ? std::fabs(flux - dot(moment, normal) / area) / 3 : 0; }
};

/// In stretches, so that sums keep their order.
struct SumSamples {
  static constexpr int64_t stretch = 1024, grain = 1;
  const SurfaceSample* sample;
  int64_t samples;
  SurfaceSums* out;
  HD void operator()(int64_t i) const {
    SurfaceSums sums;
    for (int64_t s = stretch * i; s < stretch * (i + 1) && s < samples; ++s) {
      const double area = sample_area(sample[s]);
      sums +=
          {area, area * dot(sample[s].point, sample[s].normal), area * sample[s].point, area * sample[s].normal};
    }
    out[i] = sums;
  }
};

} // namespace molmesh::contour::detail
