// decode.cpp — OpenVDB file versions 222 to 224, as written by OpenVDB 2 to 10 to a file or a stream.
#include "formats/vdb/decode.hpp"
#include "base/error.hpp"
#include "base/shortest.hpp"
#include <array>
#include <bit>
#include <blosc.h>
#include <cmath>
#include <cstring>
#include <zlib.h>

namespace molmesh::formats::vdb {
namespace {

constexpr int64_t magic = 0x56444220;
constexpr uint32_t oldest = 222, newest = 224;
constexpr uint32_t compress_zip = 1, compress_active_mask = 2, compress_blosc = 4;
constexpr const char* float_tree = "Tree_float_5_4_3";

/// Reads forward and never past the end.
class Cursor {
public:
  Cursor(std::string_view bytes, const std::string& file) : left_(bytes), size_(bytes.size()), file_(file) {}
  [[noreturn]] void damaged() const {
    fail_input(file_ + ": R3: truncated or damaged, expected a whole OpenVDB file");
  }
  [[noreturn]] void refuse(const std::string& what) const { fail_input(file_ + ": " + what); }
  std::string_view take(uint64_t n) {
    if (n > left_.size())
      damaged();
    const std::string_view bytes = left_.substr(0, n);
    left_.remove_prefix(n);
    return bytes;
  }
  template <class T>
  T number() {
    T v;
    std::memcpy(&v, take(sizeof v).data(), sizeof v);
    return v;
  }
  std::string_view string() { return take(number<uint32_t>()); }
  const std::string_view& left() const { return left_; }
  size_t size() const { return size_; } ///< of all

private:
  std::string_view left_;
  size_t size_;
  const std::string& file_;
};

template <size_t Words>
struct Mask {
  std::array<uint64_t, Words> word;
  explicit Mask(Cursor& in) { std::memcpy(word.data(), in.take(8 * Words).data(), 8 * Words); }
  Mask() = default;
  bool on(size_t i) const { return word[i >> 6] >> (i & 63) & 1; }
  size_t count() const {
    size_t n = 0;
    for (const uint64_t w : word)
      n += static_cast<size_t>(std::popcount(w));
    return n;
  }
};

std::map<std::string, Metadata, std::less<>> metadata(Cursor& in) {
  std::map<std::string, Metadata, std::less<>> m;
  for (auto n = in.number<uint32_t>(); n > 0; --n) {
    const std::string_view name = in.string(), type = in.string();
    m[std::string(name)] = {std::string(type), in.string()};
  }
  return m;
}

/// n floats, compressed or not; skipped when out is null.
void values(Cursor& in, uint32_t compression, size_t n, float* out) {
  const size_t bytes = 4 * n;
  if (!(compression & (compress_zip | compress_blosc))) {
    const std::string_view raw = in.take(bytes);
    if (out)
      std::memcpy(out, raw.data(), bytes);
    return;
  }
  const auto size = in.number<int64_t>(); // of the compressed bytes; zero or negative: they are not compressed
  if (size <= 0) {
    if (uint64_t{0} - static_cast<uint64_t>(size) != bytes)
      in.damaged();
    const std::string_view raw = in.take(bytes);
    if (out)
      std::memcpy(out, raw.data(), bytes);
    return;
  }
  const std::string_view packed = in.take(static_cast<uint64_t>(size));
  if (!out)
    return;
  if (compression & compress_blosc) {
    constexpr size_t pad = 128; // OpenVDB fills shorter arrays up to this before Blosc sees them
    size_t unpacked = 0;
    if (blosc_cbuffer_validate(packed.data(), packed.size(), &unpacked) != 0)
      in.damaged();
    if (unpacked == bytes) {
      if (blosc_decompress_ctx(packed.data(), out, bytes, 1) != static_cast<int>(bytes))
        in.damaged();
    } else if (bytes < pad && unpacked == pad) {
      char buffer[pad];
      if (blosc_decompress_ctx(packed.data(), buffer, pad, 1) != static_cast<int>(pad))
        in.damaged();
      std::memcpy(out, buffer, bytes);
    } else {
      in.damaged();
    }
  } else {
    uLongf unpacked = bytes;
    if (uncompress(reinterpret_cast<Bytef*>(out), &unpacked, reinterpret_cast<const Bytef*>(packed.data()),
                   packed.size()) != Z_OK ||
        unpacked != bytes)
      in.damaged();
  }
}

/// The values of a node (OpenVDB's io::readCompressedValues): active ones as stored, inactive ones from at most two
/// values and a mask that selects between them. out null: skip.
template <size_t Words>
void node_values(Cursor& in, const FloatGrid& grid, const Mask<Words>& active, float* out) {
  constexpr size_t n = 64 * Words;
  enum : int8_t { background_only, minus_background, one, mask_only, mask_and_one, mask_and_two, all };
  const auto kind = in.number<int8_t>();
  if (kind < background_only || kind > all)
    in.damaged();
  float inactive[2] = {kind == background_only ? grid.background : -grid.background, grid.background};
  if (kind == one || kind == mask_and_one || kind == mask_and_two)
    inactive[0] = in.number<float>();
  if (kind == mask_and_two)
    inactive[1] = in.number<float>();
  Mask<Words> select{};
  if (kind == mask_only || kind == mask_and_one || kind == mask_and_two)
    select = Mask<Words>(in);
  const bool dense = kind == all || !(grid.compression & compress_active_mask);
  if (dense)
    return values(in, grid.compression, n, out);
  const size_t count = active.count();
  values(in, grid.compression, count, out);
  if (!out)
    return;
  // In place from the back: the packed values never overtake their destinations.
  size_t packed = count;
  for (size_t i = n; i-- > 0;)
    out[i] = active.on(i) ? out[--packed] : inactive[select.on(i)];
}

/// A node of many equal tiles takes few bytes. Files of bodies have far fewer tiles than this: those of 8 points
/// lie below a surface of leaves, which take over a hundred bytes each.
void add_tile(Cursor& in, FloatGrid& grid, const Tile& tile) {
  constexpr size_t some = size_t{1} << 18;
  if (grid.tile.size() >= some + in.size() / 4)
    in.refuse("R10: more tiles than a file of " + std::to_string(in.size()) +
              " bytes can enclose by active voxels");
  grid.tile.push_back(tile);
}

/// An internal node of 2^(3 log2) children of `edge` points each: its tiles, then its children's topology.
template <int Log2, class Child>
void internal_node(Cursor& in, FloatGrid& grid, Vec3i corner, int32_t edge, Child&& child) {
  constexpr size_t n = size_t{1} << 3 * Log2;
  const Mask<n / 64> has_child(in), active(in);
  std::vector<float> value(n);
  node_values(in, grid, active, value.data());
  const auto place = [&](size_t i) {
    const auto c = static_cast<int32_t>(i);
    constexpr int32_t low = (1 << Log2) - 1;
    return corner + edge * Vec3i{c >> 2 * Log2, c >> Log2 & low, c & low};
  };
  for (size_t i = 0; i < n; ++i)
    if (!has_child.on(i) && (active.on(i) || value[i] != grid.background))
      add_tile(in, grid, {place(i), edge, value[i], active.on(i)});
  for (size_t i = 0; i < n; ++i)
    if (has_child.on(i))
      child(place(i));
}

Vec3i root_corner(Cursor& in) {
  constexpr int32_t edge = 4096, limit = 1 << 30;
  Vec3i c;
  for (int a = 0; a < 3; ++a) {
    c[a] = in.number<int32_t>();
    if (c[a] % edge != 0 || c[a] < -limit || c[a] >= limit)
      in.damaged();
  }
  return c;
}

void tree(Cursor& in, FloatGrid& grid) {
  if (in.number<int32_t>() != 1)
    in.damaged(); // buffers
  grid.background = in.number<float>();
  const auto tiles = in.number<uint32_t>(), children = in.number<uint32_t>();
  for (uint32_t t = 0; t < tiles; ++t) {
    const Vec3i c = root_corner(in);
    const auto value = in.number<float>();
    const bool active = in.number<uint8_t>() != 0;
    if (active || value != grid.background)
      add_tile(in, grid, {c, 4096, value, active});
  }
  for (uint32_t t = 0; t < children; ++t)
    internal_node<5>(in, grid, root_corner(in), 128, [&](Vec3i c5) {
      internal_node<4>(in, grid, c5, 8, [&](Vec3i c4) {
        in.take(64); // the mask, repeated with the values
        grid.leaf.push_back({c4, {}});
      });
    });
  for (Leaf& leaf : grid.leaf) {
    const std::string_view before = in.left();
    const Mask<8> active(in);
    node_values(in, grid, active, nullptr);
    leaf.data = before.substr(0, before.size() - in.left().size());
  }
}

std::string number_text(double v) {
  return v != v ? "NaN" : shortest(v); // without a sign
}

void transform(Cursor& in, FloatGrid& grid) {
  const std::string_view map = in.string();
  const bool affine = map == "AffineMap";
  const bool translated = map == "UniformScaleTranslateMap" || map == "ScaleTranslateMap";
  if (!affine && !translated && map != "UniformScaleMap" && map != "ScaleMap")
    in.refuse("R9: transform '" + std::string(map.substr(0, 40)) + "', expected uniform voxels and a translation");
  double m[16] = {};
  if (affine) {
    for (double& v : m)
      v = in.number<double>();
  } else {
    if (translated)
      for (int a = 12; a < 15; ++a)
        m[a] = in.number<double>();
    for (int a = 0; a < 3; ++a)
      m[5 * a] = in.number<double>();
    in.take(12 * sizeof(double)); // voxel size and inverses
  }
  grid.spacing = m[0];
  grid.origin = {m[12], m[13], m[14]};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c)
      if (!(m[0] > 0) || !std::isfinite(m[0]) || m[4 * r + c] != (r == c ? m[0] : 0))
        in.refuse("R9: voxels are not uniform, expected one positive scale and a translation");
  if (!(grid.spacing >= least_spacing && grid.spacing <= largest_spacing))
    in.refuse("R9: voxels of " + number_text(grid.spacing) + " Å, expected 1e-6 to 1e6");
  for (int a = 0; a < 3; ++a)
    if (!(std::fabs(grid.origin[a]) <= largest_place))
      in.refuse("R9: a translation of " + number_text(grid.origin[a]) + " Å, expected at most 1e8 in magnitude");
}

} // namespace

FloatGrid decode(std::string_view bytes, std::string_view name, const std::string& file) {
  Cursor in(bytes, file);
  if (bytes.empty())
    in.refuse("R1: empty, expected an OpenVDB file");
  if (bytes.size() < sizeof magic || in.number<int64_t>() != magic)
    in.refuse("R1: not an OpenVDB file (it does not start with ' BDV')");
  if (const auto version = in.number<uint32_t>(); version < oldest || version > newest)
    in.refuse("R2: OpenVDB file version " + std::to_string(version) + ", expected 222 to 224");
  in.take(2 * sizeof(uint32_t) + 1 + 36); // library version, grid offsets or not, UUID
  metadata(in);
  for (auto grids = in.number<int32_t>(); grids > 0; --grids) {
    const std::string_view unique = in.string(), type = in.string(), parent = in.string();
    const auto start = in.number<int64_t>();
    in.number<int64_t>();
    const auto end = in.number<int64_t>();
    const bool wanted = unique.substr(0, unique.find('\x1e')) == name; // a suffix tells grids of one name apart
    if (wanted && type != float_tree)
      in.refuse("R4: grid '" + std::string(name) + "' is a " + std::string(type.substr(0, 60)) + ", expected " +
                float_tree);
    if (wanted && !parent.empty())
      in.refuse("R4: grid '" + std::string(name) + "' is an instance, expected a tree");
    if (!wanted && start > 0) { // written to a seekable file: positions are known
      if (end < static_cast<int64_t>(bytes.size() - in.left().size()))
        in.damaged();
      in.take(static_cast<uint64_t>(end) - (bytes.size() - in.left().size()));
      continue;
    }
    FloatGrid grid;
    grid.bytes = bytes.size();
    grid.compression = in.number<uint32_t>();
    grid.metadata = metadata(in);
    if (type != float_tree || !parent.empty())
      in.refuse("R4: grid '" + std::string(name) + "' comes after one of another type, expected it first");
    transform(in, grid);
    tree(in, grid);
    if (wanted)
      return grid;
  }
  in.refuse("R4: no grid '" + std::string(name) + "'");
}

void decode_leaf(const FloatGrid& grid, const Leaf& leaf, const std::string& file, float* value, uint64_t* active) {
  Cursor in(leaf.data, file);
  const Mask<8> mask(in);
  std::memcpy(active, mask.word.data(), sizeof mask.word);
  node_values(in, grid, mask, value);
}

} // namespace molmesh::formats::vdb
