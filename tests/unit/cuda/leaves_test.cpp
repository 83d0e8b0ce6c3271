// leaves_test.cpp — the device's surface cells and leaves, run by the host: the same, bit by bit, as the host's;
// and both against leaves found the slow and obvious way.
#include "contour/octree/leaves.hpp"
#include "contour/octree/sized_nodes.hpp"
#include "cuda/contour/leaves.hpp"
#include "cuda/par/host.hpp"
#include "unit/contour/level_steps.hpp"
#include "unit/contour/sample_grid.hpp"
#include <catch2/catch.hpp>
#include <cstring>
#include <random>

using namespace molmesh;
using contour::BoxRequest;

namespace {

template <class T>
bool same(const LargeArray<T>& a, const LargeArray<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
bool same_blocks(const LargeArray<contour::OctreeView::Block>& a, const LargeArray<contour::OctreeView::Block>& b) {
  bool equal = a.size() == b.size();
  for (size_t i = 0; equal && i < a.size(); ++i)
    equal = a[i].key == b[i].key && a[i].first == b[i].first &&
            std::equal(a[i].start, a[i].start + 8, b[i].start) && std::equal(a[i].rank, a[i].rank + 8, b[i].rank);
  return equal;
}

struct Seen {
  int64_t cells = 0, leaves = 0, coarse = 0, cut = 0, clipped = 0;
};

/// Cells crossed by the values of their corners, one by one.
bool holds_all(const contour::Lattice& l, const contour::Surface& s) {
  size_t found = 0;
  bool right = true;
  Vec3i p;
  for (p.x = 0; p.x < l.cells.x; ++p.x)
    for (p.y = 0; p.y < l.cells.y; ++p.y)
      for (p.z = 0; p.z < l.cells.z; ++p.z) {
        float v[8];
        int in = 0;
        for (int c = 0; c < 8; ++c) {
          v[c] = l.value(p + contour::corner_step(c));
          in += v[c] > l.isovalue;
        }
        if (in == 0 || in == 8)
          continue;
        ++found;
        const auto at = std::lower_bound(s.cells.begin(), s.cells.end(), morton(p),
                                         [](const contour::SurfaceCell& c, uint64_t k) { return c.key < k; });
        right = right && at != s.cells.end() && at->key == morton(p) && std::memcmp(at->value, v, sizeof v) == 0;
      }
  return right && found == s.cells.size();
}

/// Every fine cell of the domain in one leaf, the one that find() tells; neighbours across a face differ by one
/// level at most, with it those across an edge by two, across a corner by three; no leaf beyond the domain.
bool is_balanced_octree(const contour::Octree& tree, Vec3i cells) {
  int64_t volume = 0;
  for (int32_t i = 0; i < tree.size(); ++i) {
    const Vec3i corner = tree.corner(i);
    const int32_t e = tree.extent(i);
    volume += int64_t{e} * e * e;
    if (corner.x + e > cells.x || corner.y + e > cells.y || corner.z + e > cells.z ||
        (i > 0 && tree.key[i] <= tree.key[static_cast<size_t>(i) - 1]))
      return false;
    for (const Vec3i p : {corner, corner + (e - 1) * Vec3i{1, 1, 1}, corner + Vec3i{e / 2, 0, e - 1}})
      if (tree.find(p) != i)
        return false;
  }
  for (int axes = 1; axes <= 3; ++axes) // a face, an edge, a corner
    if (test::most_steps(tree, axes) > axes)
      return false;
  return volume == int64_t{cells.x} * cells.y * cells.z;
}

void compare(const BlockGrid& grid, const BoxRequest& box, const contour::RefineOptions& options, Seen& seen,
             int threads = 1) {
  const contour::Lattice lattice(grid, box, options.outside, threads);
  const contour::Surface surface = contour::find_surface(lattice, threads);
  const contour::LeafList leaves = contour::select_leaves(lattice, surface, options, threads);
  cuda::HostBackend backend(threads);
  cuda::DeviceLeaves<cuda::HostBackend> selection(backend);
  selection.find_surface(lattice);
  selection.select_leaves(lattice, options);
  const contour::Surface device_surface = selection.surface_on_host();
  const contour::LeafList device = selection.leaves_on_host();
  CHECK(same(device_surface.cells, surface.cells));
  CHECK(same(device_surface.samples, surface.samples));
  CHECK(same(device.key, leaves.key));
  CHECK(same(device.level, leaves.level));
  CHECK(same_blocks(device.block, leaves.block));
  CHECK(same(device.large, leaves.large));
  CHECK(holds_all(lattice, surface));
  seen.cells += static_cast<int64_t>(surface.cells.size());
  seen.leaves += static_cast<int64_t>(leaves.key.size());
  for (const contour::SurfaceCell& c : surface.cells) {
    const auto after = std::upper_bound(leaves.key.begin(), leaves.key.end(), c.key);
    seen.coarse += leaves.level[after - leaves.key.begin() - 1] > 0;
  }
  seen.cut += lattice.view().any_cut;
  seen.clipped += lattice.cells.x % 8 != 0;
  CHECK(is_balanced_octree(contour::Octree(lattice.cells, contour::LeafList(leaves)), lattice.cells));
}

} // namespace

TEST_CASE("leaf selection: device and host the same on random densities, uniform and adapted, in any box") {
  std::mt19937_64 random(11);
  Seen seen;
  for (int trial = 0; trial < 40; ++trial) {
    const BlockGrid grid = test::random_grid(random, trial);
    BoxRequest box;
    if (trial % 5 == 1)
      box.kind = BoxRequest::tight;
    if (trial % 5 == 2)
      box = {BoxRequest::factor, 2.5, {}, {}};
    if (trial % 5 >= 3)
      box = {BoxRequest::corners, 0, {-1.3, -9, -7.5}, {9, trial % 5 == 3 ? 1.75 : 9, 8}};
    for (double adapt : {0.0, 0.3}) {
      CAPTURE(trial, adapt);
      compare(grid, box, {adapt, true, trial % 2 == 0}, seen);
      compare(grid, box, {adapt, trial % 4 == 1, true}, seen);
      const contour::Lattice lattice(grid, box, true, 1);
      const contour::SizedNodes sized =
          contour::sized_nodes(lattice.view(), {{{1, 0, 1}, 2, 1}, {{-3, 0, 0}, 3, 4}});
      compare(grid, box, {adapt, true, true, sized.divided, sized.loose, 1 + trial % 3}, seen);
    }
  }
  CHECK(seen.cells > 10000);
  CHECK(seen.cut > 10);
  CHECK(seen.clipped > 10);
}

TEST_CASE("leaf selection: surface cells merge, the same at any number of threads", "[slow]") {
  const BlockGrid grid = test::cube_grid(9, 0.32, [](Vec3d x) {
    return test::atom(x) + test::atom(x - Vec3d{2, 2.5, 1}) + test::atom(x - Vec3d{6, 6, 6});
  });
  for (BoxRequest box : {BoxRequest{}, BoxRequest{BoxRequest::factor, 6, {}, {}},
                         BoxRequest{BoxRequest::corners, 0, {-1.1, -9, -9}, {9, 1.77, 9}}})
    for (double adapt : {0.0, 0.1, 0.5})
      for (int threads : {1, 3}) {
        CAPTURE(int(box.kind), adapt, threads);
        Seen seen;
        compare(grid, box, {adapt, true, true}, seen, threads);
        CHECK((seen.coarse > 100) == (adapt > 0));
      }
}

TEST_CASE("leaf selection: a crossed cell with an inactive corner is bad input, named by its index") {
  BlockGrid grid = test::cube_grid(6, 0.5, test::atom);
  const contour::Lattice whole(grid, {}, true, 1);
  const contour::Surface surface = contour::find_surface(whole, 1);
  const Vec3i p = whole.base() + morton_point(surface.cells[surface.cells.size() / 2].key);
  const int64_t b = BlockIndex(grid).find(p);
  grid.active[8 * b + (slot(p) >> 6)] &= ~(uint64_t{1} << (slot(p) & 63));
  for (int threads : {1, 4}) {
    const contour::Lattice lattice(grid, {}, true, threads);
    CHECK_THROWS_WITH(contour::find_surface(lattice, threads), Catch::Contains("inactive corner"));
    cuda::HostBackend backend(threads);
    cuda::DeviceLeaves<cuda::HostBackend> selection(backend);
    CHECK_THROWS_WITH(selection.find_surface(lattice), Catch::Contains("inactive corner"));
  }
}
