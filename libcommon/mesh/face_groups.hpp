// face_groups.hpp — groups the faces of tetrahedra and the triangles that lie on the same three points.
#pragma once
#include "mesh/tet_mesh.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <bit>

namespace molmesh {
namespace detail {

/// Tetrahedra and triangles in lists by the lowest points of their faces: a tetrahedron's three faces at its lowest
/// point, and the fourth at its second lowest.
struct FaceList {
  const LargeArray<Tet>& tet;
  const std::vector<Tri>& tri;

  int64_t tets() const { return static_cast<int64_t>(tet.size()); }
  int64_t cells() const { return tets() + static_cast<int64_t>(tri.size()); }
  /// f(lead, item) for cell i's items.
  template <class F>
  void items_of(int64_t i, F&& f) const {
    if (i >= tets()) {
      const Tri& t = tri[i - tets()];
      f(std::min(std::min(t[0], t[1]), t[2]), static_cast<uint32_t>(tets() + i));
      return;
    }
    const Tet& t = tet[i];
    const int32_t low = std::min(t[0], t[1]), high = std::max(t[0], t[1]), other_low = std::min(t[2], t[3]),
                  other_high = std::max(t[2], t[3]);
    f(std::min(low, other_low), static_cast<uint32_t>(2 * i));
    f(std::min(std::max(low, other_low), std::min(high, other_high)), static_cast<uint32_t>(2 * i + 1));
  }
  int faces_of(uint32_t item) const { return item >= 2 * tets() || item % 2 == 1 ? 1 : 3; }
  int32_t lead_of(uint32_t item) const {
    int32_t lead = 0;
    items_of(item < 2 * tets() ? item / 2 : item - tets(), [&](int32_t l, uint32_t i) {
      if (i == item)
        lead = l;
    });
    return lead;
  }
  /// f(lead, second, third point, face, whether sorting the points took an odd permutation).
  template <class F>
  void faces_of(uint32_t item, F&& f) const {
    if (item >= 2 * tets()) {
      Tri t = tri[item - 2 * tets()];
      std::sort(t.begin(), t.end());
      f(t[0], t[1], t[2], static_cast<uint32_t>(2 * tets() + item), false);
      return;
    }
    const Tet& t = tet[item / 2];
    const auto named = [&](size_t k) { return int64_t{t[k]} << 2 | int64_t(k); }; // its corner goes with a point
    const int64_t p = std::min(named(0), named(1)), q = std::max(named(0), named(1)),
                  r = std::min(named(2), named(3)), s = std::max(named(2), named(3));
    const int64_t a = std::min(p, r), x = std::max(p, r), y = std::min(q, s), d = std::max(q, s),
                  b = std::min(x, y), c = std::max(x, y);
    const bool odd = ((t[0] > t[1]) ^ (t[2] > t[3]) ^ (p > r) ^ (q > s) ^ (x > y)) != 0;
    const auto point = [](int64_t v) { return static_cast<int32_t>(v >> 2); };
    const auto opposite = [&](int64_t v) { return 4 * (item / 2) + static_cast<uint32_t>(v & 3); };
    if (item % 2 == 1) {
      f(point(b), point(c), point(d), opposite(a), odd);
      return;
    }
    f(point(a), point(c), point(d), opposite(b), !odd);
    f(point(a), point(b), point(d), opposite(c), odd);
    f(point(a), point(b), point(c), opposite(d), !odd);
  }
};

} // namespace detail

/// visit(faces, n, same_side) once for every three points that faces or triangles are on. faces: first those of
/// tetrahedra, 4 t + corner opposite, by ascending t, then 4 tets + triangle, ascending; below 2^32 all. same_side:
/// the first two are faces of tetrahedra, and these, if positive, lie on the same side of them. Calls come from
/// several threads and in any order, so visit writes to places of its faces alone. Transient memory 8 bytes a
/// tetrahedron. Same calls at any number of threads.
template <class Visit>
void for_each_face(const LargeArray<Tet>& tet, const std::vector<Tri>& tri, int64_t points, int threads,
                   Visit visit) {
  // Radix partition into ranges of points that fit a cache: count → scan → fill, chunk by chunk, so the order is
  // fixed.
  constexpr int64_t chunk = 1 << 16, range_items = 1 << 14, block = 4;
  const detail::FaceList list{tet, tri};
  const int64_t cells = list.cells(), chunks = (cells + chunk - 1) / chunk;
  int shift = 0;
  while (cells > 0 && ((points - 1) >> shift) + 1 > 1 + 2 * cells / range_items)
    ++shift;
  const int64_t ranges = cells > 0 ? ((points - 1) >> shift) + 1 : 0;
  std::vector<int64_t> place(size_t(ranges * chunks)); // [range][chunk]
  const auto each_item = [&](int64_t c, auto&& f) {
    for (int64_t i = c * chunk, end = std::min(cells, i + chunk); i < end; ++i)
      list.items_of(i, [&](int32_t lead, uint32_t item) { f(size_t(lead >> shift), item); });
  };
  par::for_n(chunks, threads, 1, [&](int64_t c) {
    std::vector<int64_t> count(static_cast<size_t>(ranges));
    each_item(c, [&](size_t r, uint32_t) { ++count[r]; });
    for (int64_t r = 0; r < ranges; ++r)
      place[r * chunks + c] = count[r];
  });
  const int64_t items = par::exclusive_scan(place);
  LargeArray<uint32_t> sorted(static_cast<size_t>(items));
  par::for_n(chunks, threads, 1, [&](int64_t c) {
    std::vector<uint32_t*> to(static_cast<size_t>(ranges));
    for (int64_t r = 0; r < ranges; ++r)
      to[r] = sorted.data() + place[r * chunks + c];
    each_item(c, [&](size_t r, uint32_t item) { *to[r]++ = item; });
  });

  struct Entry {
    uint64_t others; ///< the second and the third point
    uint32_t face;
    uint32_t next : 31, odd : 1; ///< 1 + place of the next on the same points, 0: none
  };
  par::for_n((ranges + block - 1) / block, threads, 1, [&](int64_t first_range) {
    std::vector<int32_t> start;
    LargeArray<Entry> by_lead;
    std::vector<uint32_t> last, heads, group;
    for (int64_t r = first_range * block, end = std::min(ranges, r + block); r < end; ++r) {
      const int64_t low = r << shift, width = std::min(points - low, int64_t{1} << shift);
      const uint32_t *const from_item = sorted.data() + place[r * chunks], *const to_item =
                                                                               sorted.data() +
                                                                               (r + 1 < ranges
                                                                                    ? place[(r + 1) * chunks]
                                                                                    : items);
      start.assign(size_t(width + 1), 0);
      for (const uint32_t* i = from_item; i < to_item; ++i)
        start[list.lead_of(*i) - low] += list.faces_of(*i);
      const int32_t most = *std::max_element(start.begin(), start.end());
      by_lead.resize(size_t(par::exclusive_scan(start)));
      for (const uint32_t* i = from_item; i < to_item; ++i)
        list.faces_of(*i, [&](int32_t lead, int32_t second, int32_t third, uint32_t face, bool odd) {
          by_lead[start[lead - low]++] = {uint64_t(uint32_t(second)) << 32 | uint32_t(third), face, 0, odd};
        });
      // 1 + place of the last entry met on the same points, by open addressing; those of leads before count as
      // free.
      last.assign(std::bit_ceil(2 * size_t(most)), 0);
      group.resize(size_t(most));
      uint32_t from = 0;
      for (int64_t lead = 0; lead < width; ++lead) { // filling moved each start to its end
        const auto to = static_cast<uint32_t>(start[lead]);
        const size_t mask = std::bit_ceil(2 * size_t(to - from)) - 1;
        heads.clear();
        for (uint32_t k = from; k < to; ++k) {
          const uint64_t others = by_lead[k].others;
          size_t slot = size_t((others ^ others >> 32) * 0x9E3779B97F4A7C15u >> 32) & mask;
          while (last[slot] > from && by_lead[last[slot] - 1].others != others)
            slot = (slot + 1) & mask;
          if (last[slot] > from)
            by_lead[last[slot] - 1].next = k + 1;
          else
            heads.push_back(k);
          last[slot] = k + 1;
        }
        for (const uint32_t head : heads) {
          int n = 0;
          for (uint32_t k = head + 1; k > 0; k = by_lead[k - 1].next)
            group[n++] = by_lead[k - 1].face;
          const bool pair = n > 1 && group[1] < 4 * list.tets();
          visit(static_cast<const uint32_t*>(group.data()), n,
                pair && by_lead[head].odd == by_lead[by_lead[head].next - 1].odd);
        }
        from = to;
      }
    }
  });
}

} // namespace molmesh
