// duals.cpp — dual vertices from where the surface crosses the complex's edges (detail/complex_queries.hpp).
#include "contour/complex.hpp"
#include "contour/detail/at.hpp"
#include "contour/detail/complex_queries.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::contour {

using detail::at;

Vec3d Complex::crossing(int32_t a, int32_t b) const {
  return detail::crossing(*this, a, b);
}

/// Mean of the surface's crossings with the leaf's edges (the paper's mass centre).
Vec3d Complex::mean_crossing(int32_t leaf) const {
  Vec3d sum;
  int crossings = 0;
  for (int c = 0; c < 8; ++c)
    for (int bit = 1; bit < 8; bit *= 2) {
      const int32_t a = grid_vertex[at(int64_t{8} * leaf + c)], b = grid_vertex[at(int64_t{8} * leaf + (c | bit))];
      if ((c & bit) || inside(a) == inside(b))
        continue;
      sum += crossing(a, b);
      ++crossings;
    }
  return sum / double(crossings);
}

/// x moved onto the tangent plane of the nearest fine surface in the leaf: the mean of a curved sheet's crossings
/// lies on its hollow side. Not out of the leaf's box.
Vec3d Complex::onto_surface(int32_t leaf, Vec3d x) const {
  const int32_t end = end_cell(leaf);
  Vec3d nearest, normal;
  double least = 1e300;
  for (int32_t c = first_cell[at(leaf)]; c < end; ++c) {
    const Vec3d foot = lattice.between(samples[at(c)].point);
    if (const double d = norm2(foot - x); d < least) {
      least = d;
      nearest = foot;
      normal = samples[at(c)].normal;
    }
  }
  const Vec3d moved = x + dot(nearest - x, normal) * normal;
  const Vec3i corner = tree.corner(leaf);
  const int32_t extent = tree.extent(leaf);
  const Vec3d low = lattice.position(corner), size = lattice.position(corner + Vec3i{extent, extent, extent}) - low;
  for (int a = 0; a < 3; ++a)
    if (!(std::fabs(moved[a] - low[a] - 0.5 * size[a]) < 0.45 * size[a]))
      return x;
  return moved;
}

/// Dual vertex of the leaf, or of its pieces, from where the grid points are now.
void Complex::place(int32_t leaf) {
  Vec3d& dual_position = position[at(dual(leaf))];
  if (side[at(leaf)] == Side::crossed) {
    dual_position = onto_surface(leaf, mean_crossing(leaf));
    if (is_split(leaf))
      place_split(leaf);
    return;
  }
  // The lattice's own middle plane: seen from a smaller neighbour it is the rim of that neighbour's face.
  const int32_t extent = tree.extent(leaf), half = extent / 2;
  const Vec3i corner = tree.corner(leaf);
  dual_position = extent > 1 ? lattice.position(corner + Vec3i{half, half, half})
                             : 0.5 * (lattice.position(corner) + lattice.position(corner + Vec3i{1, 1, 1}));
}

void Complex::number_pieces(int threads) {
  const int64_t leaves = tree.size();
  split.assign(at(leaves), -1);
  std::vector<int32_t> extra(at(leaves), 0);
  par::for_n(leaves, threads, [&](int64_t i) {
    if (side[at(i)] != Side::crossed || tree.level[at(i)] > 0)
      return;
    const CellTopology t = topology(static_cast<int32_t>(i));
    if (t.split())
      extra[at(i)] = 1 + SplitCell(t).pieces + (t.chop >= 0);
  });
  const int32_t total = par::exclusive_scan(extra);
  const auto first = static_cast<int32_t>(position.size());
  position.resize(at(first + total));
  value.resize(at(first + total), lattice.isovalue);
  split_leaf_.assign(at(total), -1);
  for (int64_t i = 0; i < leaves; ++i) {
    const int32_t end = i + 1 < leaves ? extra[at(i + 1)] : total;
    if (end > extra[at(i)])
      split[at(i)] = first + extra[at(i)];
    for (int32_t k = extra[at(i)]; k < end; ++k)
      split_leaf_[at(k)] = static_cast<int32_t>(i);
  }
}

void Complex::place_split(int32_t leaf) {
  const SplitCell s(topology(leaf));
  const int32_t centre = split[at(leaf)];
  const auto vertex = [&](int c) { return grid_vertex[at(int64_t{8} * leaf + c)]; };
  const float* v = cells[at(first_cell[at(leaf)])].value;
  Vec3d middle;
  double mean = 0, spread = 0;
  for (int c = 0; c < 8; ++c) {
    middle += 0.125 * position[at(vertex(c))];
    mean += 0.125 * v[c];
    spread += 0.125 * std::fabs(double(v[c]) - lattice.isovalue);
  }
  position[at(centre)] = middle;
  if ((mean > lattice.isovalue) != s.topology.centre_inside)
    mean = lattice.isovalue + (s.topology.centre_inside ? spread : -spread);
  value[at(centre)] = static_cast<float>(mean);
  if ((value[at(centre)] > lattice.isovalue) != s.topology.centre_inside) // rounding to float
    value[at(centre)] = std::nextafter(lattice.isovalue, s.topology.centre_inside ? 1e30f : -1e30f);

  const auto place = [&](int32_t dual_vertex, const int32_t* corner, int n, int32_t apex) {
    Vec3d crossed, all = position[at(apex)];
    int crossings = 0;
    const auto edge = [&](int32_t a, int32_t b) {
      if (inside(a) == inside(b))
        return;
      crossed += crossing(a, b);
      ++crossings;
    };
    for (int i = 0; i < n; ++i) {
      all += position[at(corner[i])];
      edge(corner[i], corner[(i + 1) % n]);
      edge(corner[i], apex);
    }
    position[at(dual_vertex)] = crossings ? crossed / double(crossings) : all / double(n + 1);
  };
  for (const Patch& p : s.patch) {
    if (p.piece < 0)
      continue;
    int32_t corner[4];
    for (int i = 0; i < p.n; ++i)
      corner[i] = vertex(p.corner[i]);
    place(piece_dual(leaf, s, p), corner, p.n, centre);
    if (p.face < 0)
      place(centre + 1 + s.pieces, corner, p.n, vertex(s.topology.chop));
  }
}

} // namespace molmesh::contour
