// encode.cpp — an OpenVDB file (version 224, streamed): its tree, and its leaves in the order of the tree.
#include "formats/vdb/leaves.hpp"
#include "formats/vdb/preamble.hpp"
#include "formats/vdb/vdb.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <ostream>

namespace molmesh::formats {
namespace {

constexpr Vec3i shifted(Vec3i p, int bits) {
  return {p.x >> bits, p.y >> bits, p.z >> bits};
}

struct Entry {
  Vec3i corner;
  const Leaves::Leaf* leaf; ///< null: a tile, inside
  uint64_t key;             ///< the same order by one comparison, where the grid is not too wide for it
};

/// OpenVDB's depth-first order: by root child (4096 points), then lower node (128), then leaf (8).
bool depth_first(const Entry& a, const Entry& b) {
  if (a.key != b.key)
    return a.key < b.key;
  for (const int bits : {12, 7, 3})
    if (const Vec3i p = shifted(a.corner, bits), q = shifted(b.corner, bits); !(p == q))
      return p < q;
  return false;
}

void set_keys(std::vector<Entry>& entry, const GridFrame& frame) {
  const Vec3i root = shifted(frame.lower, 12), end = shifted(frame.lower + frame.points, 12);
  constexpr int root_bits = 12; // and 5 and 4 for the nodes below: 63 in all
  for (int axis = 0; axis < 3; ++axis)
    if (end[axis] - root[axis] >= 1 << root_bits)
      return;
  for (Entry& e : entry) {
    const auto append = [&e](Vec3i p, int bits) {
      for (int axis = 0; axis < 3; ++axis)
        e.key = e.key << bits | (static_cast<uint32_t>(p[axis]) & ((1u << bits) - 1));
    };
    append(shifted(e.corner, 12) - root, root_bits);
    append(shifted(e.corner, 7), 5);
    append(shifted(e.corner, 3), 4);
  }
}

template <int Log2>
struct Node {
  static constexpr size_t n = size_t{1} << 3 * Log2;
  std::array<uint64_t, n / 64> child{}, outside{};
  bool any_inside = false;
  Node() { outside.fill(~uint64_t{0}); }
  static size_t offset(Vec3i corner, int bits) {
    constexpr int32_t low = (1 << Log2) - 1;
    const Vec3i p = shifted(corner, bits);
    return static_cast<size_t>((p.x & low) << 2 * Log2 | (p.y & low) << Log2 | (p.z & low));
  }
  void set_child(size_t i) { child[i >> 6] |= uint64_t{1} << (i & 63); }
  void set_inside(size_t i) {
    outside[i >> 6] &= ~(uint64_t{1} << (i & 63));
    any_inside = true;
  }
  void write(Bytes& out, float inside_value) const {
    const std::array<uint64_t, n / 64> no_active{};
    out.raw(child.data(), sizeof child);
    out.raw(no_active.data(), sizeof no_active);
    out.number(static_cast<int8_t>(any_inside ? 4 : 0)); // a mask chooses between a value and the background
    if (any_inside) {
      out.number(inside_value);
      out.raw(outside.data(), sizeof outside);
    }
    out.number(int64_t{0}); // no active values
  }
};

using Iterator = std::vector<Entry>::const_iterator;
Iterator end_of(Iterator begin, Iterator end, int bits) {
  const Vec3i p = shifted(begin->corner, bits);
  return std::find_if(begin, end, [&](const Entry& e) { return !(shifted(e.corner, bits) == p); });
}

void write_topology(Bytes& out, float inside_value, const std::vector<Entry>& entry, std::ostream& stream) {
  constexpr size_t at_once = size_t{1} << 20;
  out.number(int32_t{1});  // buffers
  out.number(0.0f);        // background
  out.number(uint32_t{0}); // root tiles
  uint32_t roots = 0;
  for (Iterator r = entry.begin(); r != entry.end(); r = end_of(r, entry.end(), 12))
    ++roots;
  out.number(roots);
  for (Iterator r = entry.begin(), root_end; r != entry.end(); r = root_end) {
    root_end = end_of(r, entry.end(), 12);
    const Vec3i root = shifted(r->corner, 12);
    out.vec({root.x * 4096, root.y * 4096, root.z * 4096});
    Node<5> upper;
    const auto wholly_inside = [](Iterator b, Iterator e) {
      return e - b == 4096 && std::all_of(b, e, [](const Entry& x) { return !x.leaf; });
    };
    for (Iterator b = r, e; b != root_end; b = e) {
      e = end_of(b, root_end, 7);
      const size_t i = Node<5>::offset(b->corner, 7);
      wholly_inside(b, e) ? upper.set_inside(i) : upper.set_child(i);
    }
    upper.write(out, inside_value);
    for (Iterator b = r, e; b != root_end; b = e) {
      e = end_of(b, root_end, 7);
      if (wholly_inside(b, e))
        continue;
      Node<4> lower;
      for (Iterator x = b; x != e; ++x) {
        const size_t i = Node<4>::offset(x->corner, 3);
        x->leaf ? lower.set_child(i) : lower.set_inside(i);
      }
      lower.write(out, inside_value);
      for (Iterator x = b; x != e; ++x)
        if (x->leaf)
          out.raw(x->leaf->bytes, Leaves::Leaf::mask_size);
      if (out.str().size() >= at_once)
        out.flush(stream);
    }
  }
}

/// In large pieces: gathered by all threads, while one writes those gathered before.
void write_leaves(std::ostream& out, const std::vector<Entry>& entry, int threads) {
  constexpr int64_t a_piece = 256, pieces_at_once = 32;
  const auto n = static_cast<int64_t>(entry.size()), pieces = (n + a_piece - 1) / a_piece;
  std::vector<std::string> ready(pieces_at_once), next(pieces_at_once);
  int64_t gathered = 0;
  for (int64_t first = 0; (first < pieces || gathered > 0) && out; first += pieces_at_once) {
    const int64_t now = std::clamp<int64_t>(pieces - first, 0, pieces_at_once);
    par::for_n(now + 1, threads, 1, [&](int64_t task) {
      if (task == 0) {
        for (int64_t i = 0; i < gathered; ++i) {
          const std::string& piece = ready[i];
          out.write(piece.data(), static_cast<std::streamsize>(piece.size()));
        }
        return;
      }
      std::string& piece = next[task - 1];
      piece.clear();
      const int64_t begin = (first + task - 1) * a_piece;
      for (int64_t i = begin; i < std::min(n, begin + a_piece); ++i) {
        const Leaves::Leaf* const l = entry[i].leaf;
        piece.append(l->bytes, l->size);
      }
    });
    gathered = now;
    ready.swap(next);
  }
}

} // namespace

void write_vdb(std::ostream& out, const GridFrame& frame, const FieldInfo& info, const std::vector<Vec3i>& inside,
               const Leaves& leaves, const VdbExtras& extras) {
  std::vector<Entry> entry;
  entry.reserve(leaves.size() + inside.size());
  for (const Leaves::Run& run : leaves.runs())
    for (const Leaves::Leaf& l : run)
      entry.push_back({l.corner, &l, 0});
  for (const Vec3i& c : inside)
    entry.push_back({c, nullptr, 0});
  set_keys(entry, frame);
  par::sort(entry, leaves.threads(), depth_first);
  Bytes head;
  write_preamble(head, frame, info, extras);
  write_topology(head, static_cast<float>(info.inside_value), entry, out);
  head.flush(out);
  std::erase_if(entry, [](const Entry& e) { return !e.leaf; });
  write_leaves(out, entry, leaves.threads());
}

void write_vdb(std::ostream& out, const BlockGrid& grid, int threads, const VdbExtras& extras) {
  Leaves leaves(threads);
  leaves.add(grid);
  write_vdb(out, grid.frame, grid.info, grid.inside, leaves, extras);
}

} // namespace molmesh::formats
