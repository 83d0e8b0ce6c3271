// complex.cpp — vertices of the complex: grid points, dual vertices, split cells.
#include "contour/complex.hpp"
#include "contour/detail/at.hpp"
#include "geom/morton.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::contour {

using detail::at;
namespace {

constexpr double least_share = 0.02; // of an edge between its end and a crossing

Vec3i corner_step(int c) {
  return {c & 1, c >> 1 & 1, c >> 2};
}

} // namespace

SplitCell::SplitCell(const CellTopology& t) : topology(t) {
  const auto add = [this](int face, std::initializer_list<int> corners) {
    Patch p{face, static_cast<int>(corners.size()), {-1, -1, -1, -1}, 0};
    std::copy(corners.begin(), corners.end(), p.corner);
    const bool chopped = topology.chop >= 0 && face >= 0 &&
                         std::find(corners.begin(), corners.end(), topology.chop) != corners.end();
    p.piece = chopped ? -1 : pieces++;
    patch.push_back(p);
  };
  for (int f = 0; f < 6; ++f) {
    const int* c = face_corner[f];
    if (t.diagonal[f] == Diagonal::none) {
      add(f, {c[0], c[1], c[2], c[3]});
    } else {
      const int s = t.diagonal[f] == Diagonal::even ? 0 : 1;
      add(f, {c[s], c[s + 1], c[(s + 2) % 4]});
      add(f, {c[(s + 2) % 4], c[(s + 3) % 4], c[s]});
    }
  }
  if (t.chop >= 0) {
    // The three neighbours, turned so that the cut is counter-clockwise seen from the chopped corner.
    const int k = t.chop, x = k ^ 1, y = k ^ 2, z = k ^ 4;
    const bool even = ((k & 1) + (k >> 1 & 1) + (k >> 2)) % 2 == 0;
    if (even)
      add(-1, {x, z, y});
    else
      add(-1, {x, y, z});
  }
}

Complex::Complex(const Lattice& l, const Octree& t, const std::vector<SurfaceCell>& c,
                 const std::vector<SurfaceSample>& surface, int threads)
    : lattice(l), tree(t), cells(c), samples(surface) {
  const int32_t leaves = tree.size();
  first_cell.assign(at(leaves), -1);
  side.resize(at(leaves));
  par::for_n(leaves, threads, [&](int64_t i) {
    const uint64_t key = tree.key[at(i)], end = key + (uint64_t{1} << 3 * tree.level[at(i)]);
    const auto first = std::lower_bound(cells.begin(), cells.end(), key,
                                        [](const SurfaceCell& s, uint64_t k) { return s.key < k; });
    if (first != cells.end() && first->key < end) {
      first_cell[at(i)] = static_cast<int32_t>(first - cells.begin());
      side[at(i)] = Side::crossed;
    } else {
      side[at(i)] = lattice.inside(tree.corner(static_cast<int32_t>(i))) ? Side::inside : Side::outside;
    }
  });
  number_grid_vertices(threads);
  keep_distance(threads);
  place_duals(threads);
}

int32_t Complex::leaf_of(int32_t vertex) const {
  const int32_t leaf = vertex - dual0, pieces = leaf - tree.size();
  if (leaf < 0 || pieces >= static_cast<int32_t>(split_leaf_.size()))
    return -1;
  return pieces < 0 ? leaf : split_leaf_[at(pieces)];
}

CellTopology Complex::topology(int32_t leaf) const {
  const SurfaceCell& cell = cells[at(first_cell[at(leaf)])];
  double v[8];
  for (int c = 0; c < 8; ++c)
    v[c] = double(cell.value[c]) - double(lattice.isovalue);
  return cell_topology(v);
}

int32_t Complex::end_cell(int32_t leaf) const {
  const uint64_t end = tree.key[at(leaf)] + (uint64_t{1} << 3 * tree.level[at(leaf)]);
  auto c = first_cell[at(leaf)];
  while (at(c) < cells.size() && cells[at(c)].key < end)
    ++c;
  return c;
}

void Complex::number_grid_vertices(int threads) {
  // A grid point belongs to the last of the eight octants around it whose leaf has the point as a corner: leaf and
  // corner as one number, 8·leaf + corner.
  const auto owner = [&](int32_t leaf, int c) {
    const Vec3i p = tree.corner(leaf) + tree.extent(leaf) * corner_step(c);
    for (int octant = 7; octant >= 0; --octant) {
      const int32_t other = octant == (7 ^ c) ? leaf : tree.find(p - corner_step(7 ^ octant));
      if (other < 0)
        continue;
      const Vec3i q = p - tree.corner(other);
      const int32_t s = tree.extent(other) - 1;
      if (((q.x | q.y | q.z) & s) == 0)
        return 8 * other + ((q.x ? 1 : 0) | (q.y ? 2 : 0) | (q.z ? 4 : 0));
    }
    return 8 * leaf + c;
  };
  const int64_t leaves = tree.size();
  std::vector<int32_t> owned(at(8 * leaves)), first(at(leaves));
  par::for_n(leaves, threads, [&](int64_t i) {
    for (int c = 0; c < 8; ++c) {
      owned[at(8 * i + c)] = owner(static_cast<int32_t>(i), c);
      first[at(i)] += owned[at(8 * i + c)] == 8 * i + c;
    }
  });
  grid_vertices = par::exclusive_scan(first);
  dual0 = grid_vertices;
  grid_vertex.resize(at(8 * leaves));
  point.resize(at(grid_vertices));
  position.resize(at(grid_vertices + leaves));
  value.assign(at(grid_vertices + leaves), lattice.isovalue);
  par::for_n(leaves, threads, [&](int64_t i) {
    int32_t id = first[at(i)];
    const auto leaf = static_cast<int32_t>(i);
    for (int c = 0; c < 8; ++c) {
      if (owned[at(8 * i + c)] != 8 * i + c)
        continue;
      const Vec3i p = tree.corner(leaf) + tree.extent(leaf) * corner_step(c);
      grid_vertex[at(8 * i + c)] = id;
      point[at(id)] = p;
      position[at(id)] = lattice.position(p);
      value[at(id)] = lattice.value(p);
      ++id;
    }
  });
  par::for_n(leaves, threads, [&](int64_t i) {
    for (int c = 0; c < 8; ++c)
      if (const int32_t o = owned[at(8 * i + c)]; o != 8 * i + c)
        grid_vertex[at(8 * i + c)] = grid_vertex[at(o)];
  });
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

void Complex::place_duals(int threads) {
  const int64_t leaves = tree.size();
  split.assign(at(leaves), -1);
  std::vector<int32_t> extra(at(leaves), 0);
  par::for_n(leaves, threads, [&](int64_t i) {
    const auto leaf = static_cast<int32_t>(i);
    const int32_t extent = tree.extent(leaf);
    Vec3d& dual_position = position[at(dual(leaf))];
    if (side[at(i)] != Side::crossed) {
      // The lattice's own middle plane: seen from a smaller neighbour it is the rim of that neighbour's face.
      const Vec3i corner = tree.corner(leaf), half{extent / 2, extent / 2, extent / 2};
      dual_position = extent > 1 ? lattice.position(corner + half)
                                 : 0.5 * (lattice.position(corner) + lattice.position(corner + Vec3i{1, 1, 1}));
      return;
    }
    dual_position = onto_surface(leaf, mean_crossing(leaf));
    if (extent > 1)
      return;
    const CellTopology t = topology(leaf);
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
  par::for_n(leaves, threads, [&](int64_t i) {
    if (split[at(i)] >= 0)
      place_split(static_cast<int32_t>(i));
  });
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

int32_t Complex::piece_dual(int32_t leaf, const SplitCell& s, int f, int off) const {
  for (const Patch& p : s.patch)
    if (p.face == f && (off < 0 || p.corner[1] == off))
      return piece_dual(leaf, s, p);
  return -1; // every face has its patches
}

/// On a coarse edge whose ends have moved: the distances to the surface say about where, the tangent plane at the
/// nearer of the ends' nearest samples more exactly.
Vec3d Complex::moved_crossing(int32_t a, int32_t b) const {
  const Vec3d pa = position[at(a)], along = position[at(b)] - pa;
  const double da = distance[at(a)], db = distance[at(b)];
  double share = da != 0 && db != 0 ? da / (da - db) : 0.5;
  const Vec3d x = pa + share * along;
  const SurfaceSample* nearest = nullptr;
  for (int32_t v : {a, b})
    if (const int32_t k = nearest_[at(v)]; k >= 0) {
      const SurfaceSample& s = samples[at(k)];
      if (!nearest || norm2(lattice.between(s.point) - x) < norm2(lattice.between(nearest->point) - x))
        nearest = &s;
    }
  if (nearest)
    if (const double slope = dot(along, nearest->normal); std::fabs(slope) > 0.3 * norm(along))
      share = dot(lattice.between(nearest->point) - pa, nearest->normal) / slope;
  return pa + std::clamp(share, least_share, 1 - least_share) * along;
}

Vec3d Complex::crossing(int32_t a, int32_t b) const {
  Vec3d pa = position[at(a)], pb = position[at(b)];
  float va = value[at(a)], vb = value[at(b)];
  if (a < grid_vertices && b < grid_vertices) {
    Vec3i qa = point[at(a)], qb = point[at(b)];
    const auto length = [&] {
      return std::max({std::abs(qa.x - qb.x), std::abs(qa.y - qb.y), std::abs(qa.z - qb.z)});
    };
    if (length() > 1 && (moved_[at(a)] || moved_[at(b)]))
      return moved_crossing(a, b);
    const bool in = inside(a);
    while (length() > 1) { // one sign change along the edge: halve
      const Vec3i middle{(qa.x + qb.x) / 2, (qa.y + qb.y) / 2, (qa.z + qb.z) / 2};
      const float v = lattice.value(middle);
      ((v > lattice.isovalue) == in ? qa : qb) = middle;
      ((v > lattice.isovalue) == in ? va : vb) = v;
    }
    if (qa == point[at(a)] && qb == point[at(b)]) {
      const double da = distance[at(a)], db = distance[at(b)];
      if (da != 0 && db != 0)
        return pa + std::clamp(da / (da - db), least_share, 1 - least_share) * (pb - pa);
    } else {
      pa = lattice.position(qa);
      pb = lattice.position(qb);
    }
  }
  return pa + crossing_share(va, vb, lattice.isovalue) * (pb - pa);
}

} // namespace molmesh::contour
