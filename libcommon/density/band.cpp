// band.cpp — corners of band cells by row masks: ten points a row, one bit each.
#include "density/band.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <bit>

namespace molmesh::density {
namespace {

/// Points of a block that are below and above the band: bit 8·j + k of word i.
struct Classes {
  std::array<uint64_t, 8> below{}, above{};
};

class Band {
public:
  Band(const BlockGrid& grid, int threads) : grid_(grid), index_(grid), classes_(grid.corner.size()) {
    par::for_n(static_cast<int64_t>(classes_.size()), threads, 64, [&](int64_t i) {
      const auto b = static_cast<size_t>(i);
      for (size_t s = 0; s < 512; ++s) {
        const double v = grid.value[512 * b + s];
        classes_[b].below[s >> 6] |= uint64_t{v < grid.info.band_lower} << (s & 63);
        classes_[b].above[s >> 6] |= uint64_t{v > grid.info.band_upper} << (s & 63);
      }
    });
    all_below_.below.fill(~uint64_t{0});
    all_above_.above.fill(~uint64_t{0});
  }
  bool known(Vec3i corner) const { return index_.find(corner) >= 0; }
  const Classes& classes(Vec3i corner) const {
    const int64_t b = index_.find(corner);
    return b >= 0 ? classes_[static_cast<size_t>(b)] : b == BlockIndex::inside ? all_above_ : all_below_;
  }
  std::array<uint64_t, 8> active(Vec3i corner) const;

private:
  const BlockGrid& grid_;
  BlockIndex index_;
  std::vector<Classes> classes_;
  Classes all_below_, all_above_;
};

/// Rows of the 10³ points around a block, along z: bit k + 1 is point k.
using Rows = std::array<std::array<uint16_t, 10>, 10>;

std::array<uint64_t, 8> Band::active(Vec3i corner) const {
  const Classes* around[27];
  for (int n = 0; n < 27; ++n)
    around[n] = &classes(corner + 8 * Vec3i{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1});
  Rows below, above;
  const auto byte = [](uint64_t word, int j) { return static_cast<uint16_t>(word >> 8 * j & 0xff); };
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) {
      const Classes* const* row = &around[9 * ((i + 7) / 8) + 3 * ((j + 7) / 8)];
      const auto w = static_cast<size_t>((i + 7) % 8);
      const int bj = (j + 7) % 8;
      const auto join = [&](auto part) {
        return static_cast<uint16_t>(byte(part(row[0]), bj) >> 7 | byte(part(row[1]), bj) << 1 |
                                     (byte(part(row[2]), bj) & 1) << 9);
      };
      const auto si = static_cast<size_t>(i), sj = static_cast<size_t>(j);
      below[si][sj] = join([w](const Classes* c) { return c->below[w]; });
      above[si][sj] = join([w](const Classes* c) { return c->above[w]; });
    }
  // Cell (i,j,k), corners up to (i+1,j+1,k+1), of the 9³ around; those beyond the grid are none.
  const Vec3i lo = grid_.frame.lower, hi = lo + grid_.frame.points; // one past the last point
  uint16_t inside_z = 0;
  for (int k = 0; k < 9; ++k)
    if (const int z = corner.z + k - 1; z >= lo.z && z + 1 < hi.z)
      inside_z |= static_cast<uint16_t>(1u << k);
  std::array<std::array<uint16_t, 9>, 9> cell;
  for (size_t i = 0; i < 9; ++i)
    for (size_t j = 0; j < 9; ++j) {
      const int x = corner.x + static_cast<int>(i) - 1, y = corner.y + static_cast<int>(j) - 1;
      const bool in = x >= lo.x && x + 1 < hi.x && y >= lo.y && y + 1 < hi.y;
      const auto all = [&](const Rows& r) {
        const int four = r[i][j] & r[i + 1][j] & r[i][j + 1] & r[i + 1][j + 1];
        return four & four >> 1;
      };
      cell[i][j] = static_cast<uint16_t>(in ? ~(all(below) | all(above)) & inside_z : 0);
    }
  std::array<uint64_t, 8> mask{};
  for (size_t i = 0; i < 8; ++i)
    for (size_t j = 0; j < 8; ++j) {
      const int four = cell[i][j] | cell[i + 1][j] | cell[i][j + 1] | cell[i + 1][j + 1];
      mask[i] |= static_cast<uint64_t>((four | four >> 1) & 0xff) << 8 * j;
    }
  return mask;
}

} // namespace

std::vector<Vec3i> blocks_missing_from_band(const BlockGrid& grid, int threads) {
  const Band band(grid, threads);
  std::vector<Vec3i> candidate;
  const auto add_unknown_around = [&](Vec3i corner) {
    for (int n = 0; n < 27; ++n)
      if (const Vec3i c = corner + 8 * Vec3i{n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1}; !band.known(c))
        candidate.push_back(c);
  };
  for (const Vec3i& c : grid.corner)
    add_unknown_around(c);
  for (const Vec3i& c : grid.inside)
    add_unknown_around(c);
  par::sort(candidate, threads);
  candidate.erase(std::unique(candidate.begin(), candidate.end()), candidate.end());
  std::vector<char> needed(candidate.size());
  par::for_n(static_cast<int64_t>(candidate.size()), threads, 64, [&](int64_t i) {
    const auto mask = band.active(candidate[static_cast<size_t>(i)]);
    needed[static_cast<size_t>(i)] = std::any_of(mask.begin(), mask.end(), [](uint64_t w) { return w != 0; });
  });
  std::vector<Vec3i> missing;
  for (size_t i = 0; i < candidate.size(); ++i)
    if (needed[i])
      missing.push_back(candidate[i]);
  return missing;
}

void keep_band(BlockGrid& grid, int threads, int64_t& active_points) {
  const auto n = static_cast<int64_t>(grid.corner.size());
  std::vector<int64_t> kept(grid.corner.size());
  {
    const Band band(grid, threads);
    grid.active.resize(8 * grid.corner.size());
    par::for_n(n, threads, 64, [&](int64_t i) {
      const auto b = static_cast<size_t>(i);
      const auto mask = band.active(grid.corner[b]);
      std::copy(mask.begin(), mask.end(), &grid.active[8 * b]);
      for (size_t s = 0; s < 512; ++s)
        if (!(mask[s >> 6] >> (s & 63) & 1)) {
          float& v = grid.value[512 * b + s];
          v = v > grid.info.isovalue ? static_cast<float>(grid.info.inside_value) : 0.0f;
        }
      for (const uint64_t w : mask)
        kept[b] += std::popcount(w);
    });
  }
  active_points = 0;
  size_t to = 0;
  for (size_t b = 0; b < kept.size(); ++b) {
    if (kept[b] == 0) {
      if (grid.value[512 * b] != 0)
        grid.inside.push_back(grid.corner[b]);
      continue;
    }
    active_points += kept[b];
    grid.corner[to] = grid.corner[b];
    std::copy_n(&grid.value[512 * b], 512, &grid.value[512 * to]);
    std::copy_n(&grid.active[8 * b], 8, &grid.active[8 * to]);
    ++to;
  }
  grid.corner.resize(to);
  grid.value.resize(512 * to);
  grid.active.resize(8 * to);
  std::erase_if(grid.inside,
                [&](Vec3i c) { return std::binary_search(grid.corner.begin(), grid.corner.end(), c); });
  par::sort(grid.inside, threads);
}

} // namespace molmesh::density
