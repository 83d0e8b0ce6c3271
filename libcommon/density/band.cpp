// band.cpp — corners of band cells by row masks, with cursors along the sorted blocks instead of look-ups.
#include "density/band.hpp"
#include "density/block_kernel.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <bit>

namespace molmesh::density {
namespace {

constexpr Mask filled(uint64_t word) {
  Mask m{};
  for (uint64_t& w : m)
    w = word;
  return m;
}
constexpr Mask none = filled(0), all = filled(~uint64_t{0});

Vec3i neighbor(Vec3i corner, int n) {
  return corner + 8 * Vec3i{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
}

/// Finds the 27 blocks around corners that come in ascending order.
class Cursors {
public:
  enum : int64_t { outside = -1, inside = -2 };
  /// first: the lowest corner that will be asked for.
  Cursors(const KnownBlocks& b, Vec3i first) : b_(b) {
    for (int row = 0; row < 9; ++row) {
      const Vec3i at = neighbor(first, 3 * row);
      known_[row] = std::lower_bound(b.known.begin(), b.known.end(), at,
                                     [](const KnownCorner& k, Vec3i c) { return k.corner < c; }) -
                    b.known.begin();
      inside_[row] = std::lower_bound(b.inside.begin(), b.inside.end(), at) - b.inside.begin();
    }
  }
  /// around[27]: position in `known`, or a side.
  void find(Vec3i corner, int64_t* around) {
    for (int row = 0; row < 9; ++row) {
      Vec3i at = neighbor(corner, 3 * row);
      int64_t &k = known_[row], &i = inside_[row];
      const auto known_end = static_cast<int64_t>(b_.known.size()),
                 inside_end = static_cast<int64_t>(b_.inside.size());
      while (k < known_end && b_.known[static_cast<size_t>(k)].corner < at)
        ++k;
      while (i < inside_end && b_.inside[static_cast<size_t>(i)] < at)
        ++i;
      int64_t next_k = k, next_i = i;
      for (int z = 0; z < 3; ++z, at.z += 8) {
        int64_t& to = around[3 * row + z];
        to = outside;
        if (next_k < known_end && b_.known[static_cast<size_t>(next_k)].corner == at)
          to = next_k++;
        else if (next_i < inside_end && b_.inside[static_cast<size_t>(next_i)] == at)
          to = inside, ++next_i;
      }
    }
  }

private:
  const KnownBlocks& b_;
  int64_t known_[9], inside_[9];
};

/// Points of a block that face neighbor n.
constexpr std::array<Mask, 27> make_layers() {
  std::array<Mask, 27> layer{};
  for (int n = 0; n < 27; ++n)
    for (int s = 0; s < 512; ++s) {
      const int p[3] = {s >> 6, s >> 3 & 7, s & 7}, d[3] = {n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
      bool on = true;
      for (int a = 0; a < 3; ++a)
        on = on && (d[a] == 0 || p[a] == (d[a] < 0 ? 0 : 7));
      if (on)
        layer[static_cast<size_t>(n)][static_cast<size_t>(s >> 6)] |= uint64_t{1} << (s & 63);
    }
  return layer;
}

/// True when every point of `layer` has its bit in `in`.
bool covers(const Mask& in, const Mask& layer) {
  uint64_t left = 0;
  for (size_t w = 0; w < 8; ++w)
    left |= layer[w] & ~in[w];
  return left == 0;
}

/// Active points of a block. Cells that reach beyond the grid are none.
Mask active_points(const KnownBlocks& b, const GridFrame& frame, Vec3i corner, const int64_t* around) {
  const uint64_t *below[27], *above[27];
  for (int n = 0; n < 27; ++n) {
    const KnownBlock* k = around[n] >= 0 ? b.known[static_cast<size_t>(around[n])].block : nullptr;
    below[n] = (k ? k->below : around[n] == Cursors::inside ? none : all).data();
    above[n] = (k ? k->above : around[n] == Cursors::inside ? all : none).data();
  }
  const Vec3i last = frame.lower + frame.points - Vec3i{1, 1, 1};
  const auto cell_in = [&](int axis, int i) { // between points i - 1 and i of the block
    const int at = corner[axis] + i - 1;
    return at >= frame.lower[axis] && at < last[axis];
  };
  uint16_t in_z = 0;
  for (int k = 0; k < 9; ++k)
    in_z |= static_cast<uint16_t>(cell_in(2, k) << k);
  uint16_t cells[81];
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j)
      cells[9 * i + j] = cell_in(0, i) && cell_in(1, j) ? in_z : uint16_t{0};
  Mask mask;
  band_points(below, above, cells, mask.data());
  return mask;
}

constexpr int64_t grain = 512; // blocks that share cursors

bool in_grid(const GridFrame& frame, Vec3i corner) {
  for (int a = 0; a < 3; ++a)
    if (corner[a] + 8 <= frame.lower[a] || corner[a] >= int64_t{frame.lower[a]} + frame.points[a])
      return false;
  return true;
}

/// Positions of the blocks of a slab among sorted ones.
struct Range {
  int64_t begin, end;
};
Range known_in(const KnownBlocks& b, Slab slab) {
  const auto at = [&](int32_t x) {
    return std::partition_point(b.known.begin(), b.known.end(),
                                [x](const KnownCorner& k) { return k.corner.x < x; }) -
           b.known.begin();
  };
  return {at(slab.begin), at(slab.end)};
}
Range inside_in(const KnownBlocks& b, Slab slab) {
  const auto at = [&](int32_t x) {
    return std::partition_point(b.inside.begin(), b.inside.end(), [x](Vec3i c) { return c.x < x; }) -
           b.inside.begin();
  };
  return {at(slab.begin), at(slab.end)};
}

} // namespace

void KnownBlocks::append(const KnownBlocks& more) {
  known.insert(known.end(), more.known.begin(), more.known.end());
  inside.insert(inside.end(), more.inside.begin(), more.inside.end());
}

std::vector<Vec3i> blocks_missing_from_band(const KnownBlocks& b, Slab slab, const GridFrame& frame, int threads) {
  static constexpr std::array<Mask, 27> layer = make_layers();
  const Slab wide{slab.begin - 8, slab.end + 8};
  const Range known = known_in(b, wide), inside = inside_in(b, wide);
  const int64_t known_parts = (known.end - known.begin + grain - 1) / grain,
                inside_parts = (inside.end - inside.begin + grain - 1) / grain;
  std::vector<std::vector<Vec3i>> part(static_cast<size_t>(known_parts + inside_parts));
  const auto wanted = [&](Vec3i c) { return c.x >= slab.begin && c.x < slab.end && in_grid(frame, c); };
  par::for_n(known_parts, threads, 1, [&](int64_t p) {
    const int64_t begin = known.begin + p * grain, end = std::min(known.end, begin + grain);
    Cursors cursors(b, b.known[static_cast<size_t>(begin)].corner);
    int64_t around[27];
    for (int64_t i = begin; i < end; ++i) {
      const Vec3i corner = b.known[static_cast<size_t>(i)].corner;
      const KnownBlock& k = *b.known[static_cast<size_t>(i)].block;
      cursors.find(corner, around);
      for (int d = 0; d < 27; ++d)
        if (around[d] < 0 &&
            !covers(around[d] == Cursors::inside ? k.above : k.below, layer[static_cast<size_t>(d)]) &&
            wanted(neighbor(corner, d)))
          part[static_cast<size_t>(p)].push_back(neighbor(corner, d));
    }
  });
  // Opposite sides next to each other.
  par::for_n(inside_parts, threads, 1, [&](int64_t p) {
    const int64_t begin = inside.begin + p * grain, end = std::min(inside.end, begin + grain);
    Cursors cursors(b, b.inside[static_cast<size_t>(begin)]);
    int64_t around[27];
    for (int64_t i = begin; i < end; ++i) {
      const Vec3i corner = b.inside[static_cast<size_t>(i)];
      cursors.find(corner, around);
      for (int d = 0; d < 27; ++d)
        if (const Vec3i c = neighbor(corner, d); around[d] == Cursors::outside && in_grid(frame, c))
          for (const Vec3i both : {c, corner})
            if (wanted(both))
              part[static_cast<size_t>(known_parts + p)].push_back(both);
    }
  });
  std::vector<Vec3i> missing;
  for (const std::vector<Vec3i>& v : part)
    missing.insert(missing.end(), v.begin(), v.end());
  par::sort(missing, threads);
  missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
  return missing;
}

void append_slab(const KnownBlocks& b, Slab slab, Band& band, int threads) {
  const Range known = known_in(b, slab), inside = inside_in(b, slab);
  const int64_t n = known.end - known.begin, parts = (n + grain - 1) / grain;
  std::vector<Mask> mask(static_cast<size_t>(n));
  std::vector<int64_t> count(static_cast<size_t>(parts)), points(static_cast<size_t>(parts));
  par::for_n(parts, threads, 1, [&](int64_t p) {
    Cursors cursors(b, b.known[static_cast<size_t>(known.begin + p * grain)].corner);
    int64_t around[27];
    for (int64_t i = p * grain; i < std::min(n, (p + 1) * grain); ++i) {
      const Vec3i corner = b.known[static_cast<size_t>(known.begin + i)].corner;
      cursors.find(corner, around);
      Mask& m = mask[static_cast<size_t>(i)];
      m = active_points(b, band.frame, corner, around);
      count[static_cast<size_t>(p)] += m != none;
      for (const uint64_t w : m)
        points[static_cast<size_t>(p)] += std::popcount(w);
    }
  });
  const int64_t blocks = par::exclusive_scan(count), active = par::exclusive_scan(points);
  const size_t first = band.block.size();
  band.block.resize(first + static_cast<size_t>(blocks));
  band.active_points += active;
  LargeArray<float>& value = band.storage.emplace_back(static_cast<size_t>(active) + 16);
  par::for_n(parts, threads, 1, [&](int64_t p) {
    BandBlock* to = band.block.data() + first + count[static_cast<size_t>(p)];
    float* packed = value.data() + points[static_cast<size_t>(p)];
    for (int64_t i = p * grain; i < std::min(n, (p + 1) * grain); ++i) {
      const Mask& m = mask[static_cast<size_t>(i)];
      if (m == none)
        continue;
      const KnownCorner& k = b.known[static_cast<size_t>(known.begin + i)];
      *to++ = {k.corner, m, k.block->above, packed};
      packed += pack_active(k.block->value, m.data(), packed);
    }
  });
  const auto middle = static_cast<std::ptrdiff_t>(band.inside.size());
  band.inside.insert(band.inside.end(), b.inside.begin() + inside.begin, b.inside.begin() + inside.end);
  const auto known_inside = static_cast<std::ptrdiff_t>(band.inside.size());
  for (int64_t i = 0; i < n; ++i)
    if (const KnownCorner& k = b.known[static_cast<size_t>(known.begin + i)];
        mask[static_cast<size_t>(i)] == none && (k.block->above[0] & 1))
      band.inside.push_back(k.corner);
  std::inplace_merge(band.inside.begin() + middle, band.inside.begin() + known_inside, band.inside.end());
}

BlockGrid to_block_grid(const Band& band, int threads) {
  const size_t n = band.block.size();
  BlockGrid grid;
  grid.frame = band.frame;
  grid.info = band.info;
  grid.inside = band.inside;
  grid.corner.resize(n);
  grid.value.resize(512 * n);
  grid.active.resize(8 * n);
  par::for_n(static_cast<int64_t>(n), threads, grain, [&](int64_t i) {
    const auto b = static_cast<size_t>(i);
    const BandBlock& block = band.block[b];
    grid.corner[b] = block.corner;
    const float* packed = block.value;
    for (size_t s = 0; s < 512; ++s) {
      const uint64_t bit = uint64_t{1} << (s & 63);
      grid.value[512 * b + s] = block.active[s >> 6] & bit  ? *packed++
                                : block.above[s >> 6] & bit ? static_cast<float>(band.info.inside_value)
                                                            : 0.0f;
    }
    std::copy(block.active.begin(), block.active.end(), &grid.active[8 * b]);
  });
  return grid;
}

} // namespace molmesh::density
