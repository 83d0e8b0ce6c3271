// group_by_key.hpp — groups items with equal keys: faces of tetrahedra, half edges, equal points.
#pragma once
#include "par/par.hpp"
#include <cstdint>
#include <vector>

namespace molmesh {

/// Keys compare by `lead`, then `rest`.
struct GroupKey {
  int32_t lead; ///< in [0, leads), spread evenly
  uint64_t rest;
  bool operator==(const GroupKey&) const = default;
};

/// visit(items, n) once for every set of n equal keys among key(0) … key(count - 1), count < 2^32; `items` points
/// to their indices, ascending. Calls come from several threads and in any order, so visit writes to places of its
/// items alone. O(count) for bounded groups per lead; transient memory 4 bytes an item. Same calls at any number of
/// threads.
template <class Key, class Visit>
void for_each_group(int64_t count, int64_t leads, int threads, Key key, Visit visit) {
  // Radix partition into ranges of leads that fit a cache: count → scan → fill, chunk by chunk, so the order is
  // fixed.
  constexpr int64_t chunk = 1 << 17, range_items = 1 << 15;
  const int64_t chunks = (count + chunk - 1) / chunk;
  int shift = 0;
  while (count > 0 && ((leads - 1) >> shift) + 1 > 1 + count / range_items)
    ++shift;
  const int64_t ranges = count > 0 ? ((leads - 1) >> shift) + 1 : 0;
  const auto range_of = [&](int64_t i) { return int64_t{key(i).lead} >> shift; };
  std::vector<int64_t> place(static_cast<size_t>(ranges * chunks)); // [range][chunk]
  const auto at = [&](int64_t r, int64_t c) -> int64_t& { return place[r * chunks + c]; };
  par::for_n(chunks, threads, 1, [&](int64_t c) {
    for (int64_t i = c * chunk, end = std::min(count, i + chunk); i < end; ++i)
      ++at(range_of(i), c);
  });
  par::exclusive_scan(place);
  std::vector<int64_t> begin(static_cast<size_t>(ranges + 1), count);
  for (int64_t r = 0; r < ranges; ++r)
    begin[r] = at(r, 0);
  LargeArray<uint32_t> item(static_cast<size_t>(count));
  par::for_n(chunks, threads, 1, [&](int64_t c) {
    for (int64_t i = c * chunk, end = std::min(count, i + chunk); i < end; ++i)
      item[at(range_of(i), c)++] = static_cast<uint32_t>(i);
  });

  struct Entry {
    uint64_t rest;
    uint32_t item;
    bool operator<(const Entry& o) const { return rest != o.rest ? rest < o.rest : item < o.item; }
  };
  par::for_n(ranges, threads, 1, [&](int64_t r) {
    const int64_t first = begin[r], size = begin[r + 1] - first;
    const int64_t low = r << shift, width = std::min(leads - low, int64_t{1} << shift);
    std::vector<int32_t> start(static_cast<size_t>(width + 1));
    std::vector<Entry> sorted(static_cast<size_t>(size));
    uint32_t* const mine = item.data() + first;
    for (int64_t k = 0; k < size; ++k)
      ++start[key(mine[k]).lead - low];
    par::exclusive_scan(start);
    for (int64_t k = 0; k < size; ++k) {
      const GroupKey full = key(mine[k]);
      sorted[start[full.lead - low]++] = {full.rest, mine[k]};
    }
    for (int64_t lead = 0, from = 0; lead < width; ++lead) { // filling moved each start to its end
      const int64_t to = start[lead];
      std::sort(sorted.begin() + from, sorted.begin() + to);
      for (int64_t k = from; k < to; ++k)
        mine[k] = sorted[k].item;
      while (from < to) {
        int64_t end = from + 1;
        while (end < to && sorted[end].rest == sorted[from].rest)
          ++end;
        visit(const_cast<const uint32_t*>(mine + from), static_cast<int>(end - from));
        from = end;
      }
    }
  });
}

} // namespace molmesh
