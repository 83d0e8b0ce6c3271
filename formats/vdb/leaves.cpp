// leaves.cpp — a leaf of an OpenVDB file: its mask, what inactive points hold, the active values through Blosc.
#include "formats/vdb/leaves.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <bit>
#include <blosc.h>
#include <cstring>

namespace molmesh::formats {

Leaves::Leaf Leaves::encode(const View& view, float inside_value, par::Arena<char>& to) {
  size_t count = 0;
  std::array<uint64_t, 8> outside{};
  bool any_inside = false;
  for (size_t w = 0; w < 8; ++w) {
    count += static_cast<size_t>(std::popcount(view.active[w]));
    outside[w] = ~view.active[w] & ~view.inside[w];
    any_inside = any_inside || (~view.active[w] & view.inside[w]) != 0;
  }
  constexpr size_t head = 2 * Leaf::mask_size + sizeof(int8_t) + sizeof(float) + sizeof(int64_t);
  char *const begin = to.take(head + 4 * 512 + BLOSC_MAX_OVERHEAD), *at = begin;
  const auto put = [&at](const auto& v) {
    std::memcpy(at, &v, sizeof v);
    at += sizeof v;
  };
  std::memcpy(at, view.active, Leaf::mask_size);
  at += Leaf::mask_size;
  put(static_cast<int8_t>(any_inside ? 4 : 0)); // a mask chooses between a value and the background
  if (any_inside) {
    put(inside_value);
    put(outside);
  }
  const size_t bytes = 4 * count;
  constexpr size_t worth_it = 128; // below, OpenVDB expects padding
  char* const values = at + sizeof(int64_t);
  const int size = bytes < worth_it ? 0
                                    : blosc_compress_ctx(5, BLOSC_SHUFFLE, sizeof(float), bytes, view.packed,
                                                         values, bytes, BLOSC_LZ4_COMPNAME, 0, 1);
  put(size > 0 ? int64_t{size} : -static_cast<int64_t>(bytes)); // negative: stored as it is
  if (size <= 0)
    std::memcpy(values, view.packed, bytes);
  const auto all = static_cast<size_t>(values - begin) + (size > 0 ? static_cast<size_t>(size) : bytes);
  to.keep(all);
  return {view.corner, static_cast<uint32_t>(all), begin};
}

size_t Leaves::size() const {
  size_t n = 0;
  for (const Run& run : runs_)
    n += run.size();
  return n;
}

template <class Work>
void Leaves::for_parts(size_t parts, Work&& work) {
  par::for_n(static_cast<int64_t>(parts), threads_, 1, [&](int64_t part) {
    const auto make = [] { return std::make_unique<par::Arena<char>>(); };
    bytes_.with(make, [&](par::Arena<char>& arena) { work(static_cast<size_t>(part), arena); });
  });
}

void Leaves::add(std::span<const BandBlocks> runs, float inside_value) {
  std::vector<size_t> first(1);
  for (const BandBlocks& run : runs)
    first.push_back(first.back() + run.size());
  Run& leaf = runs_.emplace_back(first.back());
  constexpr size_t at_once = 128;
  for_parts((leaf.size() + at_once - 1) / at_once, [&](size_t part, par::Arena<char>& arena) {
    const size_t begin = part * at_once, end = std::min(leaf.size(), begin + at_once);
    auto r = static_cast<size_t>(std::upper_bound(first.begin(), first.end(), begin) - first.begin()) - 1;
    for (size_t n = begin; n < end; ++n) {
      while (n >= first[r + 1])
        ++r;
      const BandBlock& b = runs[r][n - first[r]];
      BlockValues room;
      leaf[n] = encode({b.corner, b.active.data(), b.above.data(), active_values(b, room)}, inside_value, arena);
    }
  });
}

void Leaves::add(const BlockGrid& grid) {
  const size_t n = grid.corner.size();
  Run& leaf = runs_.emplace_back(n);
  constexpr size_t at_once = 256;
  for_parts((n + at_once - 1) / at_once, [&](size_t part, par::Arena<char>& arena) {
    for (size_t b = part * at_once; b < std::min(n, (part + 1) * at_once); ++b) {
      const float* const value = &grid.value[512 * b];
      const uint64_t* const active = &grid.active[8 * b];
      float packed[512];
      uint64_t inside[8] = {};
      size_t count = 0;
      for (size_t s = 0; s < 512; ++s) {
        const uint64_t bit = uint64_t{1} << (s & 63);
        if (active[s >> 6] & bit)
          packed[count++] = value[s];
        else if (value[s] != 0)
          inside[s >> 6] |= bit;
      }
      leaf[b] = encode({grid.corner[b], active, inside, packed}, static_cast<float>(grid.info.inside_value), arena);
    }
  });
}

} // namespace molmesh::formats
