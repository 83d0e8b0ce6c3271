// dual_vertex.hpp — the dual vertex of each cell of the complex. Section 4.1 of Liao et al. 2013: the mass centre
// of the surface's crossings with the cell's edges, or the cell's centre off the surface. In place of the minimizer
// of reference 50's error function, mass centres are moved onto the surface's tangent plane, and those of merged
// cells off the cell's faces. Host and device.
#pragma once
#include "contour/complex/edge_crossing.hpp"
#include <bit>

namespace molmesh::contour {

/// The next float towards +∞ or -∞; x positive and finite.
MOLMESH_HD inline float next_float(float x, bool up) {
#ifdef __CUDA_ARCH__
  return __int_as_float(__float_as_int(x) + (up ? 1 : -1));
#else
  return std::bit_cast<float>(std::bit_cast<int32_t>(x) + (up ? 1 : -1));
#endif
}

/// Where the samples of a leaf's fine surface are, Å; most leaves have few, and those are found once.
class LeafSamples {
public:
  MOLMESH_HD LeafSamples(const ComplexView& c, int32_t leaf)
      : c_(c), begin_(c.first_cell[leaf]), end_(c.end_cell(leaf)) {
    for (int32_t k = 0; k < kept && k < size(); ++k) {
      const Vec3d foot = c.lattice.between(sample(k).point);
      x_[k] = foot.x, y_[k] = foot.y, z_[k] = foot.z;
    }
  }
  MOLMESH_HD int32_t size() const { return end_ - begin_; }
  MOLMESH_HD const SurfaceSample& sample(int32_t k) const { return c_.samples[begin_ + k]; }
  MOLMESH_HD Vec3d foot(int32_t k) const {
    return k < kept ? Vec3d{x_[k], y_[k], z_[k]} : c_.lattice.between(sample(k).point);
  }
  /// x moved onto the tangent plane of the nearest: the mean of a curved surface's crossings lies on its concave
  /// side.
  MOLMESH_HD Vec3d onto_surface(Vec3d x) const {
    int32_t which = 0;
    uint64_t least = ~uint64_t{0};
    for (int32_t k = 0; k < size(); ++k) { // no branches: bits of positive numbers are in the numbers' order
      const auto d = std::bit_cast<uint64_t>(norm2(foot(k) - x));
      which = d < least ? k : which;
      least = d < least ? d : least;
    }
    const Vec3d normal = sample(which).normal;
    return x + dot(foot(which) - x, normal) * normal;
  }

private:
  static constexpr int32_t kept = 32;
  const ComplexView& c_;
  int32_t begin_, end_;
  double x_[kept], y_[kept], z_[kept]; // no constructors: few are used
};

/// Of a leaf: its dual vertex, and those of its pieces, from where the grid points are now.
struct PlaceDual {
  ComplexView c;

  MOLMESH_HD void operator()(int64_t i) const {
    const auto leaf = static_cast<int32_t>(i);
    Vec3d& dual = c.position[c.dual(leaf)];
    if (c.side[leaf] == Side::crossed) {
      dual = c.tree.level[leaf] == 0 ? fine_dual(leaf) : merged_dual(leaf);
      if (c.is_split(leaf))
        place_split(leaf);
      return;
    }
    // The middle lies in a lattice plane, which holds an edge of the smaller neighbours' faces.
    const int32_t extent = c.tree.extent(leaf), half = extent / 2;
    const Vec3i corner = c.tree.corner(leaf);
    dual = extent > 1 ? c.lattice.position(corner + Vec3i{half, half, half})
                      : 0.5 * (c.lattice.position(corner) + c.lattice.position(corner + Vec3i{1, 1, 1}));
  }

private:
  /// Mean of the surface's crossings with the leaf's edges (the paper's mass centre).
  MOLMESH_HD Vec3d mean_crossing(int32_t leaf) const {
    Vec3d sum;
    int crossings = 0;
    for (int k = 0; k < 8; ++k)
      for (int bit = 1; bit < 8; bit *= 2) {
        const int32_t a = c.corner_vertex(leaf, k), b = c.corner_vertex(leaf, k | bit);
        if ((k & bit) || c.inside(a) == c.inside(b))
          continue;
        sum += crossing(c, a, b);
        ++crossings;
      }
    return sum / double(crossings);
  }

  MOLMESH_HD Vec3d fine_dual(int32_t leaf) const {
    const Vec3d x = mean_crossing(leaf), moved = LeafSamples(c, leaf).onto_surface(x), low = lower(leaf),
                size = upper(leaf) - low;
    for (int a = 0; a < 3; ++a)
      if (!(std::fabs(moved[a] - low[a] - 0.5 * size[a]) < 0.45 * size[a]))
        return x;
    return moved;
  }

  /// Where elements are best: near the cell's middle and off its faces. A little beyond the fine surface where that
  /// is curved: chords then lie on both sides of it.
  MOLMESH_HD Vec3d merged_dual(int32_t leaf) const {
    constexpr double to_middle = 0.6, beyond = 1.5;
    constexpr int most_rounds = 4;
    const Vec3d low = lower(leaf), size = upper(leaf) - low;
    Vec3d x = mean_crossing(leaf);
    x += to_middle * (low + 0.5 * size - x);
    const LeafSamples samples(c, leaf);
    const Vec3d further = beyond * bulge(samples);
    for (int round = 0; round < most_rounds; ++round) { // to where the surface is off the faces
      x = samples.onto_surface(x) + further;
      for (int a = 0; a < 3; ++a)
        x[a] = low[a] + size[a] * off_faces(leaf, a, (x[a] - low[a]) / size[a]);
    }
    return x;
  }

  /// A share of the leaf's edge along an axis, off the leaf's faces: further where smaller cells are behind, whose
  /// faces would be seen aslant.
  MOLMESH_HD double off_faces(int32_t leaf, int axis, double share) const {
    constexpr double off_smaller = 0.25, off_any = 0.3; // in the leaf's edge, in fine spacings
    const bool upper = share > 0.5;
    const double from_face = upper ? 1 - share : share;
    double least = off_any / c.tree.extent(leaf);
    if (least < off_smaller && from_face < off_smaller)
      if (const int32_t other = c.neighbour(leaf, 2 * axis + upper);
          other >= 0 && c.tree.level[other] < c.tree.level[leaf])
        least = off_smaller;
    return from_face >= least ? share : upper ? 1 - least : least;
  }

  /// From the mean of the leaf's fine surface onto it.
  MOLMESH_HD Vec3d bulge(const LeafSamples& samples) const {
    Vec3d mean;
    for (int32_t k = 0; k < samples.size(); ++k)
      mean += samples.sample(k).point;
    mean = c.lattice.between(mean / double(samples.size()));
    return samples.onto_surface(mean) - mean;
  }

  MOLMESH_HD Vec3d lower(int32_t leaf) const { return c.lattice.position(c.tree.corner(leaf)); }
  MOLMESH_HD Vec3d upper(int32_t leaf) const {
    const int32_t extent = c.tree.extent(leaf);
    return c.lattice.position(c.tree.corner(leaf) + Vec3i{extent, extent, extent});
  }

  MOLMESH_HD void place_split(int32_t leaf) const {
    const SplitCell s(c.topology(leaf));
    const int32_t centre = c.split[leaf];
    const bool centre_inside = s.topology.centre_inside;
    const float iso = c.lattice.isovalue;
    const float* v = c.cells[c.first_cell[leaf]].value;
    Vec3d middle;
    double mean = 0, spread = 0;
    for (int k = 0; k < 8; ++k) {
      middle += 0.125 * c.position[c.corner_vertex(leaf, k)];
      mean += 0.125 * v[k];
      spread += 0.125 * std::fabs(double(v[k]) - iso);
    }
    c.position[centre] = middle;
    if ((mean > iso) != centre_inside)
      mean = iso + (centre_inside ? spread : -spread);
    c.value[centre] = static_cast<float>(mean);
    if ((c.value[centre] > iso) != centre_inside) // rounding to float
      c.value[centre] = next_float(iso, centre_inside);

    for (const Patch& p : s.patch) {
      if (p.piece < 0)
        continue;
      place_piece(leaf, c.piece_dual(leaf, s, p), p, centre);
      if (p.face < 0)
        place_piece(leaf, centre + 1 + s.pieces, p, c.corner_vertex(leaf, s.topology.chop));
    }
  }

  /// The piece between a patch and an apex: the mean of its crossings, or of its corners where there is none.
  MOLMESH_HD void place_piece(int32_t leaf, int32_t dual, const Patch& p, int32_t apex) const {
    Vec3d crossed, all = c.position[apex];
    int crossings = 0;
    const auto edge = [&](int32_t a, int32_t b) {
      if (c.inside(a) == c.inside(b))
        return;
      crossed += crossing(c, a, b);
      ++crossings;
    };
    for (int i = 0; i < p.n; ++i) {
      const int32_t a = c.corner_vertex(leaf, p.corner[i]);
      all += c.position[a];
      edge(a, c.corner_vertex(leaf, p.corner[(i + 1) % p.n]));
      edge(a, apex);
    }
    c.position[dual] = crossings ? crossed / double(crossings) : all / double(p.n + 1);
  }
};

} // namespace molmesh::contour
