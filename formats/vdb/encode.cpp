// encode.cpp — BlockGrid to the bytes of an OpenVDB file (version 224, streamed), leaves compressed in parallel.
#include "formats/vdb/vdb.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <bit>
#include <blosc.h>
#include <cstring>
#include <ostream>
#include <random>
#include <string_view>

namespace molmesh::formats {
namespace {

/// Appends numbers and strings as OpenVDB lays them out: little-endian, strings after their length.
class Bytes {
public:
  template <class T>
  void number(T v) {
    const size_t at = bytes_.size();
    bytes_.resize(at + sizeof v);
    std::memcpy(&bytes_[at], &v, sizeof v);
  }
  void raw(const void* p, size_t n) { bytes_.append(static_cast<const char*>(p), n); }
  void string(std::string_view s) {
    number(static_cast<uint32_t>(s.size()));
    bytes_ += s;
  }
  void vec(Vec3i v) {
    for (int a = 0; a < 3; ++a)
      number(v[a]);
  }
  const std::string& str() const { return bytes_; }

private:
  std::string bytes_;
};

class MetadataWriter {
public:
  void add(std::string_view name, std::string_view type, const auto&... value) {
    ++count_;
    body_.string(name);
    body_.string(type);
    Bytes v;
    (v.number(value), ...);
    body_.string(v.str());
  }
  void add(std::string_view name, const std::string& value) {
    ++count_;
    body_.string(name);
    body_.string("string");
    body_.string(value);
  }
  void write(Bytes& out) const {
    out.number(count_);
    out.raw(body_.str().data(), body_.str().size());
  }

private:
  uint32_t count_ = 0;
  Bytes body_;
};

std::string fresh_uuid() {
  std::random_device random;
  std::string u = "xxxxxxxx-xxxx-4xxx-8xxx-xxxxxxxxxxxx"; // a random UUID, RFC 4122
  for (char& c : u)
    if (c == 'x')
      c = "0123456789abcdef"[random() % 16];
  return u;
}

void write_preamble(Bytes& out, const GridFrame& f, const FieldInfo& info) {
  out.number(int64_t{0x56444220});
  out.number(uint32_t{224}); // file version
  out.number(uint32_t{10});  // library version
  out.number(uint32_t{0});
  out.number(char{0}); // no offsets: a stream
  const std::string uuid = fresh_uuid();
  out.raw(uuid.data(), uuid.size());
  out.number(uint32_t{0}); // file metadata
  out.number(int32_t{1});  // grids
  out.string("density");
  out.string("Tree_float_5_4_3");
  out.string("");
  for (int i = 0; i < 3; ++i)
    out.number(int64_t{0});
  out.number(uint32_t{2 | 4}); // active values only, Blosc

  MetadataWriter m;
  m.add("name", std::string("density"));
  m.add("class", std::string("unknown"));
  m.add("molmesh_profile", "int32", int32_t{1});
  m.add("isovalue", "double", info.isovalue);
  m.add("decay", "double", info.decay);
  m.add("band_lower", "double", info.band_lower);
  m.add("band_upper", "double", info.band_upper);
  m.add("tolerance", "double", info.tolerance);
  m.add("inside_value", "double", info.inside_value);
  m.add("grid_points", "vec3i", f.points.x, f.points.y, f.points.z);
  m.add("grid_origin", "vec3i", f.lower.x, f.lower.y, f.lower.z);
  m.add("analyzed_points", "int64", info.analyzed_points);
  m.add("atoms", "int64", info.atoms);
  m.add("levels", info.levels);
  m.add("source", info.source);
  m.add("creator", info.creator);
  m.write(out);

  const double h = f.spacing;
  out.string("UniformScaleTranslateMap");
  for (const double t : {f.origin.x, f.origin.y, f.origin.z})
    out.number(t);
  for (const double v : {h, h, 1 / h, 1 / (h * h), 0.5 / h}) // scale, voxel size, inverses
    for (int a = 0; a < 3; ++a)
      out.number(v);
}

constexpr Vec3i shifted(Vec3i p, int bits) {
  return {p.x >> bits, p.y >> bits, p.z >> bits};
}

/// A leaf (its position in BlockGrid::corner) or an inside tile (leaf < 0).
struct Entry {
  Vec3i corner;
  int64_t leaf;
  uint64_t key; ///< the same order by one comparison, where the grid is not too wide for it
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

/// active(b): the mask of leaf b.
template <class Active>
void write_topology(Bytes& out, float inside_value, const std::vector<Entry>& entry, Active&& active) {
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
      return e - b == 4096 && std::all_of(b, e, [](const Entry& x) { return x.leaf < 0; });
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
        x->leaf < 0 ? lower.set_inside(i) : lower.set_child(i);
      }
      lower.write(out, inside_value);
      for (Iterator x = b; x != e; ++x)
        if (x->leaf >= 0)
          out.raw(active(x->leaf), 64);
    }
  }
}

/// A leaf: its masks [8] of active points and of inactive points inside, and the values of the active ones in
/// order.
struct LeafView {
  const uint64_t *active, *inside;
  const float* packed;
};

void write_leaf(Bytes& out, const LeafView& leaf, float inside_value) {
  size_t count = 0;
  std::array<uint64_t, 8> outside{};
  bool any_inside = false;
  for (size_t w = 0; w < 8; ++w) {
    count += static_cast<size_t>(std::popcount(leaf.active[w]));
    outside[w] = ~leaf.active[w] & ~leaf.inside[w];
    any_inside = any_inside || (~leaf.active[w] & leaf.inside[w]) != 0;
  }
  out.raw(leaf.active, 64);
  out.number(static_cast<int8_t>(any_inside ? 4 : 0));
  if (any_inside) {
    out.number(inside_value);
    out.raw(outside.data(), sizeof outside);
  }
  const size_t bytes = 4 * count;
  char compressed[4 * 512 + BLOSC_MAX_OVERHEAD];
  constexpr size_t worth_it = 128; // below, OpenVDB expects padding
  const int size = bytes < worth_it ? 0
                                    : blosc_compress_ctx(5, BLOSC_SHUFFLE, sizeof(float), bytes, leaf.packed,
                                                         compressed, bytes, BLOSC_LZ4_COMPNAME, 0, 1);
  if (size > 0) {
    out.number(static_cast<int64_t>(size));
    out.raw(compressed, static_cast<size_t>(size));
  } else {
    out.number(-static_cast<int64_t>(bytes)); // stored as it is
    out.raw(leaf.packed, bytes);
  }
}

/// corner(b) of n leaves, active(b): its mask, with_leaf(b, f): f(LeafView).
template <class Corner, class Active, class WithLeaf>
void write(std::ostream& out, const GridFrame& frame, const FieldInfo& info, const std::vector<Vec3i>& inside,
           int64_t n, int threads, Corner&& corner, Active&& active, WithLeaf&& with_leaf) {
  const auto inside_value = static_cast<float>(info.inside_value);
  std::vector<Entry> entry;
  entry.reserve(static_cast<size_t>(n) + inside.size());
  for (int64_t b = 0; b < n; ++b)
    entry.push_back({corner(b), b, 0});
  for (const Vec3i& c : inside)
    entry.push_back({c, -1, 0});
  set_keys(entry, frame);
  par::sort(entry, threads, depth_first);
  Bytes head;
  write_preamble(head, frame, info);
  write_topology(head, inside_value, entry, active);
  out.write(head.str().data(), static_cast<std::streamsize>(head.str().size()));

  std::erase_if(entry, [](const Entry& e) { return e.leaf < 0; });
  constexpr int64_t per_part = 256, parts_at_once = 64;
  const int64_t parts = (n + per_part - 1) / per_part;
  std::vector<Bytes> ready, next;
  for (int64_t first = 0; (first < parts || !ready.empty()) && out; first += parts_at_once) {
    next.assign(static_cast<size_t>(std::clamp<int64_t>(parts - first, 0, parts_at_once)), {});
    // One task writes what the last round compressed.
    par::for_n(static_cast<int64_t>(next.size()) + 1, threads, 1, [&](int64_t task) {
      if (task == 0) {
        for (const Bytes& b : ready)
          out.write(b.str().data(), static_cast<std::streamsize>(b.str().size()));
        return;
      }
      const int64_t begin = (first + task - 1) * per_part;
      for (int64_t i = begin; i < std::min(n, begin + per_part); ++i)
        with_leaf(entry[static_cast<size_t>(i)].leaf, [&](const LeafView& leaf) {
          write_leaf(next[static_cast<size_t>(task - 1)], leaf, inside_value);
        });
    });
    ready.swap(next);
  }
}

} // namespace

void write_vdb(std::ostream& out, const density::Band& band, int threads) {
  const auto block = [&](int64_t b) -> const density::BandBlock& { return band.block[static_cast<size_t>(b)]; };
  write(
      out, band.frame, band.info, band.inside, static_cast<int64_t>(band.block.size()), threads,
      [&](int64_t b) { return block(b).corner; }, [&](int64_t b) { return block(b).active.data(); },
      [&](int64_t b, auto&& use) {
        density::BlockValues room;
        use({block(b).active.data(), block(b).above.data(), density::active_values(block(b), room)});
      });
}

void write_vdb(std::ostream& out, const BlockGrid& grid, int threads) {
  write(
      out, grid.frame, grid.info, grid.inside, static_cast<int64_t>(grid.corner.size()), threads,
      [&](int64_t b) { return grid.corner[static_cast<size_t>(b)]; },
      [&](int64_t b) { return &grid.active[8 * static_cast<size_t>(b)]; },
      [&](int64_t b, auto&& use) {
        const float* value = &grid.value[512 * static_cast<size_t>(b)];
        const uint64_t* active = &grid.active[8 * static_cast<size_t>(b)];
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
        use({active, inside, packed});
      });
}

} // namespace molmesh::formats
