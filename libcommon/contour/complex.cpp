// complex.cpp — vertices of the complex: who owns which grid point, who the pieces of split cells are.
#include "contour/complex.hpp"
#include "contour/detail/at.hpp"
#include "contour/detail/complex_queries.hpp"
#include "geom/morton.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::contour {

using detail::at;

Complex::Complex(const Lattice& l, const Octree& t, const LargeArray<SurfaceCell>& c,
                 const LargeArray<SurfaceSample>& surface, int threads)
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
  number_pieces(threads);
  par::for_n(leaves, threads, [&](int64_t i) { place(static_cast<int32_t>(i)); });
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

std::vector<int32_t> Complex::leaves_at(const std::vector<uint8_t>& grid_vertex_flag, int threads) const {
  std::vector<uint8_t> touched(at(tree.size()), 0);
  par::for_n(tree.size(), threads, [&](int64_t leaf) {
    for (int c = 0; c < 8; ++c)
      touched[at(leaf)] |= grid_vertex_flag[at(grid_vertex[at(8 * leaf + c)])];
  });
  std::vector<int32_t> leaves;
  for (int32_t leaf = 0; leaf < tree.size(); ++leaf)
    if (touched[at(leaf)])
      leaves.push_back(leaf);
  return leaves;
}

int32_t Complex::piece_dual(int32_t leaf, const SplitCell& s, int f, int off) const {
  return detail::piece_dual(*this, leaf, s, f, off);
}

int32_t Complex::piece_dual(int32_t leaf, const SplitCell& s, const Patch& p) const {
  return detail::piece_dual(*this, leaf, s, p);
}

std::vector<uint8_t> Complex::lattice_classes() const {
  std::vector<uint8_t> of(position.size(), 0);
  std::fill(of.begin(), of.begin() + grid_vertices, uint8_t{1});
  for (int32_t leaf = 0; leaf < tree.size(); ++leaf) {
    const bool crossed = side[at(leaf)] == Side::crossed;
    of[at(dual(leaf))] = crossed ? uint8_t{0} : static_cast<uint8_t>(2 + tree.level[at(leaf)]);
    for (int c = 0; crossed && c < 8; ++c)
      of[at(grid_vertex[at(int64_t{8} * leaf + c)])] = 0;
  }
  return of;
}

} // namespace molmesh::contour
