// surface_cells.cpp — one pass over the blocks; walls that cut the grid get a pass of their own.
#include "contour/surface_cells.hpp"
#include "contour/cube.hpp"
#include "error.hpp"
#include "geom/morton.hpp"
#include "par/par.hpp"
#include <array>

namespace molmesh::contour {
namespace {

/// The 9³ values at and just beyond a block.
struct Neighbourhood {
  std::array<float, 729> value;
  Neighbourhood(const Lattice& lattice, Vec3i corner) {
    const BlockGrid& grid = lattice.grid();
    for (int n = 0; n < 8; ++n) {
      const Vec3i step{n & 1, n >> 1 & 1, n >> 2};
      const int64_t block = lattice.index().find(corner + 8 * step);
      const float constant = block == BlockIndex::inside ? static_cast<float>(grid.info.inside_value) : 0.0f;
      const float* v = block < 0 ? nullptr : grid.value.data() + 512 * block;
      for (int i = 0; i < (step.x ? 1 : 8); ++i)
        for (int j = 0; j < (step.y ? 1 : 8); ++j)
          for (int k = 0; k < (step.z ? 1 : 8); ++k)
            at(i + 8 * step.x, j + 8 * step.y, k + 8 * step.z) = v ? v[i << 6 | j << 3 | k] : constant;
    }
  }
  float& at(int i, int j, int k) { return value[static_cast<size_t>(81 * i + 9 * j + k)]; }
};

bool crossed(const float value[8], float isovalue) {
  int inside = 0;
  for (int c = 0; c < 8; ++c)
    inside += value[c] > isovalue;
  return inside != 0 && inside != 8;
}

} // namespace

std::vector<SurfaceCell> surface_cells(const Lattice& lattice, int threads) {
  const BlockGrid& grid = lattice.grid();
  const Vec3i cells = lattice.cells, base = lattice.base();
  const auto within = [&](Vec3i p) {
    return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < cells.x && p.y < cells.y && p.z < cells.z;
  };
  const auto on_cut = [&](Vec3i p) {
    for (int a = 0; a < 3; ++a)
      if ((lattice.cuts(a, 0) && p[a] == 0) || (lattice.cuts(a, 1) && p[a] == cells[a] - 1))
        return true;
    return false;
  };
  const auto blocks = static_cast<int64_t>(grid.corner.size());
  std::vector<std::vector<SurfaceCell>> found(static_cast<size_t>(blocks));
  par::for_n(blocks, threads, 16, [&](int64_t b) {
    const Vec3i corner = grid.corner[static_cast<size_t>(b)];
    Neighbourhood near(lattice, corner);
    std::vector<SurfaceCell>& out = found[static_cast<size_t>(b)];
    SurfaceCell cell;
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 8; ++j)
        for (int k = 0; k < 8; ++k) {
          for (int c = 0; c < 8; ++c)
            cell.value[c] = near.at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
          if (!crossed(cell.value, lattice.isovalue))
            continue;
          const Vec3i p = corner + Vec3i{i, j, k}, q = p - base;
          if (!within(q) || on_cut(q))
            continue;
          for (int c = 0; c < 8; ++c)
            if (!is_active(grid, lattice.index(), p + corner_step(c)))
              fail_input(
                  "the density at index " + std::to_string(p.x) + " " + std::to_string(p.y) + " " +
                  std::to_string(p.z) +
                  ": the surface crosses a cell with an inactive corner, expected every band cell in the grid");
          cell.key = morton(q);
          out.push_back(cell);
        }
  });
  std::vector<SurfaceCell> all;
  size_t total = 0;
  for (const auto& f : found)
    total += f.size();
  all.reserve(total);
  for (auto& f : found) {
    all.insert(all.end(), f.begin(), f.end());
    std::vector<SurfaceCell>().swap(f);
  }
  if (lattice.cuts())
    for (int a = 0; a < 3; ++a)
      for (int side = 0; side < 2; ++side) {
        if (!lattice.cuts(a, side))
          continue;
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        Vec3i p;
        p[a] = side ? cells[a] - 1 : 0;
        for (p[b] = 0; p[b] < cells[b]; ++p[b])
          for (p[c] = 0; p[c] < cells[c]; ++p[c]) {
            SurfaceCell cell;
            cell.key = morton(p);
            for (int k = 0; k < 8; ++k)
              cell.value[k] = lattice.value(p + corner_step(k));
            if (crossed(cell.value, lattice.isovalue))
              all.push_back(cell);
          }
      }
  par::sort(all, threads, [](const SurfaceCell& x, const SurfaceCell& y) { return x.key < y.key; });
  // A cell at two cut walls was met twice.
  all.erase(std::unique(all.begin(), all.end(),
                        [](const SurfaceCell& x, const SurfaceCell& y) { return x.key == y.key; }),
            all.end());
  return all;
}

} // namespace molmesh::contour
