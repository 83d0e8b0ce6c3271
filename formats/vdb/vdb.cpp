// vdb.cpp — the rules that make a decoded OpenVDB file a BlockGrid (VDBv1.md).
#include "formats/vdb/vdb.hpp"
#include "base/error.hpp"
#include "formats/read_all.hpp"
#include "formats/vdb/decode.hpp"
#include "par/pages.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <istream>

namespace molmesh::formats {
namespace {

constexpr int32_t tile_edge = 128; // points: the largest cube the writer makes a tile

template <class T>
constexpr const char* type_name = nullptr;
template <>
constexpr const char* type_name<int32_t> = "int32";
template <>
constexpr const char* type_name<int64_t> = "int64";
template <>
constexpr const char* type_name<double> = "double";
template <>
constexpr const char* type_name<Vec3i> = "vec3i";

/// R1 to R4 and R9 are in decode.cpp.
class Reader {
public:
  Reader(const vdb::FloatGrid& in, const std::string& file, int threads)
      : in_(in), file_(file), threads_(threads) {}
  BlockGrid read(bool whole);
  FieldInfo info() {
    read_info();
    read_extras();
    refuse_tile();
    return grid_.info;
  }
  VdbExtras extras;

private:
  [[noreturn]] void refuse(const std::string& what) const { fail_input(file_ + ": " + what); }
  std::string_view bytes(const char* name, const char* type) const;
  std::string text(const char* name) const { return std::string(bytes(name, "string")); }
  template <class T>
  T meta(const char* name) const;
  double number(const char* name) const;
  int64_t count(const char* name) const;
  void read_info();
  void read_extras();
  void check_tail() const;
  double optional(const char* name) const { return in_.metadata.contains(name) ? number(name) : 0; }
  void read_frame();
  void read_leaves();
  void read_tiles();
  void check_slots(size_t b) const;
  void refuse_tile() const;
  void check_tile() const;

  const vdb::FloatGrid& in_;
  const std::string& file_;
  const int threads_;
  BlockGrid grid_;
  float inside_value_ = 0;
};

std::string_view Reader::bytes(const char* name, const char* type) const {
  const auto m = in_.metadata.find(name);
  if (m == in_.metadata.end())
    refuse(std::string("R6: no metadata '") + name + "', expected one of type " + type);
  if (m->second.type != type)
    refuse(std::string("R6: metadata '") + name + "' has type " + m->second.type.substr(0, 40) + ", expected " +
           type);
  return m->second.bytes;
}

template <class T>
T Reader::meta(const char* name) const {
  const std::string_view b = bytes(name, type_name<T>);
  T v;
  if (b.size() != sizeof v)
    refuse(std::string("R6: metadata '") + name + "' has a wrong size");
  std::memcpy(&v, b.data(), sizeof v);
  return v;
}

double Reader::number(const char* name) const {
  const auto v = meta<double>(name);
  if (!std::isfinite(v))
    refuse(std::string("R7: ") + name + " is not finite");
  return v;
}

int64_t Reader::count(const char* name) const {
  const auto v = meta<int64_t>(name);
  if (v < 0)
    refuse(std::string("R7: ") + name + " is negative");
  return v;
}

void Reader::read_info() {
  FieldInfo& i = grid_.info;
  if (!in_.metadata.contains("molmesh_profile"))
    refuse("R5: no molmesh_profile: not written by hier2density");
  if (const auto profile = meta<int32_t>("molmesh_profile"); profile != 1)
    refuse("R5: molmesh_profile " + std::to_string(profile) + ", expected 1");
  i.isovalue = number("isovalue");
  i.decay = number("decay");
  i.band_lower = number("band_lower");
  i.band_upper = number("band_upper");
  i.tolerance = number("tolerance");
  i.inside_value = number("inside_value");
  inside_value_ = static_cast<float>(i.inside_value);
  if (!(i.isovalue > 0 && i.decay > 0 && i.tolerance > 0))
    refuse("R7: isovalue, decay and tolerance must be positive");
  if (!(i.band_lower <= i.isovalue && i.isovalue <= i.band_upper))
    refuse("R7: the band does not hold the isovalue, expected band_lower <= isovalue <= band_upper");
  if (!(i.inside_value > i.isovalue))
    refuse("R7: inside_value is not above the isovalue");
  i.analyzed_points = count("analyzed_points");
  i.atoms = count("atoms");
  i.levels = text("levels");
  i.source = text("source");
  i.creator = text("creator");
}

void Reader::read_extras() {
  extras.tail = {optional("tail_log"), optional("tail_decay"), optional("tail_radius"), optional("tail_depth")};
  extras.resampling_error = optional("resampling_error");
  extras.probe = optional("probe");
  if (in_.metadata.contains("surface"))
    extras.surface = text("surface");
  if (!(extras.tail.decay >= 0 && extras.tail.radius >= 0 && extras.tail.depth >= 0 &&
        extras.resampling_error >= 0))
    refuse("R7: tail_decay, tail_radius, tail_depth and resampling_error must not be negative");
  if (!in_.metadata.contains("tiles"))
    return;
  extras.tile = {meta<int32_t>("tile"), meta<int32_t>("tiles")};
  extras.tile_digest = meta<int64_t>("tile_digest");
  if (!(1 <= extras.tile.number && extras.tile.number <= extras.tile.count))
    refuse("R12: tile " + std::to_string(extras.tile.number) + " of " + std::to_string(extras.tile.count) +
           ", expected 1 to their number");
}

// A density that falls over far more than its grid asks for the work of a far larger one.
void Reader::check_tail() const {
  if (!extras.tail.known())
    return;
  const GridFrame& f = grid_.frame;
  constexpr double least_value = 1e-30, most = 100, least_decay = 1e-9;
  const double across = norm(f.spacing * to_double(f.points)), reach = extras.tail.distance(least_value);
  if (extras.tail.decay >= least_decay && reach <= most * (across + 1 / std::sqrt(extras.tail.decay)))
    return;
  char distance[40] = "no finite number of";
  if (std::isfinite(reach))
    std::snprintf(distance, sizeof distance, "%g", reach);
  refuse("R7: the density falls to 1e-30 over " + std::string(distance) +
         " Å by tail_log, tail_decay, tail_radius and tail_depth, expected at most 100 times the grid");
}

void Reader::read_frame() {
  GridFrame& f = grid_.frame;
  f.points = meta<Vec3i>("grid_points");
  f.lower = meta<Vec3i>("grid_origin");
  constexpr int32_t limit = 1 << 29;
  for (int a = 0; a < 3; ++a)
    if (f.points[a] < 2 || f.points[a] > limit || f.lower[a] < -limit || f.lower[a] > limit)
      refuse("R8: grid of " + std::to_string(f.points[a]) + " points from index " + std::to_string(f.lower[a]) +
             ", expected 2 to 2^29 points and an index within 2^29");
  f.spacing = in_.spacing;
  f.origin = in_.origin;
  for (int a = 0; a < 3; ++a)
    for (const double index : {double(f.lower[a]), double(f.lower[a]) + f.points[a]})
      if (!(std::fabs(f.origin[a] + f.spacing * index) <= vdb::largest_place))
        refuse("R9: the grid's box reaches beyond 1e8 Å from the origin, expected it within");
}

/// An inactive value must be 0 or inside_value, an active one finite and within the grid's box.
void Reader::check_slots(size_t b) const {
  const Vec3i lo = grid_.frame.lower, corner = grid_.corner[b];
  const Vec3i hi = lo + grid_.frame.points; // one past
  const bool whole = corner.x >= lo.x && corner.y >= lo.y && corner.z >= lo.z && corner.x + 8 <= hi.x &&
                     corner.y + 8 <= hi.y && corner.z + 8 <= hi.z;
  for (int s = 0; s < 512; ++s) {
    const float v = grid_.value[512 * b + static_cast<size_t>(s)];
    if (grid_.active[8 * b + static_cast<size_t>(s >> 6)] >> (s & 63) & 1) {
      const Vec3i p = corner + within_block(s);
      if (!std::isfinite(v))
        refuse("R11: an active value that is not finite");
      if (!whole && (p.x < lo.x || p.y < lo.y || p.z < lo.z || p.x >= hi.x || p.y >= hi.y || p.z >= hi.z))
        refuse("R11: an active point outside the grid's box");
    } else if (v != 0 && v != inside_value_) {
      refuse("R11: inactive value " + std::to_string(v) + ", expected 0 or inside_value");
    }
  }
}

void Reader::read_leaves() {
  std::vector<vdb::Leaf> leaf = in_.leaf;
  par::sort(leaf, threads_, [](const vdb::Leaf& a, const vdb::Leaf& b) { return a.corner < b.corner; });
  const auto same = [](const vdb::Leaf& a, const vdb::Leaf& b) { return a.corner == b.corner; };
  if (std::adjacent_find(leaf.begin(), leaf.end(), same) != leaf.end())
    refuse("R3: a leaf occurs twice");
  const size_t n = leaf.size();
  grid_.corner.resize(n);
  par::resize_pages(grid_.value, 512 * n, threads_);
  par::resize_pages(grid_.active, 8 * n, threads_);
  par::for_n(static_cast<int64_t>(n), threads_, 256, [&](int64_t i) {
    const auto b = static_cast<size_t>(i);
    grid_.corner[b] = leaf[b].corner;
    vdb::decode_leaf(in_, leaf[b], file_, &grid_.value[512 * b], &grid_.active[8 * b]);
    check_slots(b);
    const uint64_t* word = &grid_.active[8 * b];
    if (std::all_of(word, word + 8, [](uint64_t w) { return w == 0; }))
      refuse("R11: a leaf without active points");
  });
}

void Reader::read_tiles() {
  if (in_.background != 0)
    refuse("R10: background " + std::to_string(in_.background) + ", expected 0");
  // Each line of inside points along an axis ends in active ones, and |V|² ≤ |X||Y||Z| of the projections (Loomis
  // and Whitney 1949): no more blocks than this can be enclosed, and a small file cannot ask for much memory.
  // In a tile the lines across it may end at its sides; then each of its layers is a plane of such lines.
  const double enclosed = std::pow(0.5 * static_cast<double>(in_.leaf.size()), extras.tile.whole() ? 1.5 : 2);
  // And not more than the file's size allows: bodies have far fewer blocks inside than bytes in their file.
  const double most = static_cast<double>(in_.bytes) / 2 + (1 << 20);
  double inside = 0;
  for (const vdb::Tile& t : in_.tile) {
    if (t.active)
      refuse("R10: an active tile, expected active voxels only");
    if (t.value != inside_value_)
      refuse("R10: tile of " + std::to_string(t.value) + ", expected 0 or inside_value");
    if (t.edge > tile_edge)
      refuse("R10: inside tile of " + std::to_string(t.edge) + " points, expected 8 or 128");
    inside += std::pow(t.edge / 8, 3);
    if (inside > enclosed || inside > most)
      refuse("R10: more inside blocks than the active ones can enclose");
  }
  grid_.inside.reserve(static_cast<size_t>(inside));
  for (const vdb::Tile& t : in_.tile)
    for (int32_t x = 0; x < t.edge; x += 8)
      for (int32_t y = 0; y < t.edge; y += 8)
        for (int32_t z = 0; z < t.edge; z += 8)
          grid_.inside.push_back(t.corner + Vec3i{x, y, z});
  par::sort(grid_.inside, threads_);
  if (std::adjacent_find(grid_.inside.begin(), grid_.inside.end()) != grid_.inside.end())
    refuse("R3: an inside tile occurs twice");
}

void Reader::refuse_tile() const {
  if (!extras.tile.whole())
    refuse("R12: tile " + std::to_string(extras.tile.number) + " of " + std::to_string(extras.tile.count) +
           ", expected the whole density: densityjoin joins tiles");
}

void Reader::check_tile() const {
  const Slab slab = slab_of(grid_.frame, extras.tile);
  for (const std::vector<Vec3i>* const blocks : {&grid_.corner, &grid_.inside})
    for (const Vec3i& c : *blocks)
      if (!slab.contains(c))
        refuse("R12: a block at index " + std::to_string(c[slab.axis]) + " of axis " + "xyz"[slab.axis] +
               ", expected those of the tile, " + std::to_string(slab.begin) + " to " +
               std::to_string(slab.end - 1));
}

/// whole: no tile.
BlockGrid Reader::read(bool whole) {
  read_info();
  read_extras();
  if (whole)
    refuse_tile();
  read_frame();
  check_tail();
  read_tiles();
  read_leaves();
  for (const Vec3i& c : grid_.inside) // both ascending
    if (std::binary_search(grid_.corner.begin(), grid_.corner.end(), c))
      refuse("R3: a leaf within an inside tile");
  if (!extras.tile.whole())
    check_tile();
  return std::move(grid_);
}

} // namespace

struct PackedVdb::Content {
  std::string file, bytes;
  vdb::FloatGrid grid; ///< points into bytes
};

PackedVdb::PackedVdb(std::istream& in, const std::string& file) {
  auto c = std::make_unique<Content>();
  c->file = file;
  c->bytes = read_all(in, file);
  c->grid = vdb::decode(c->bytes, "density", file);
  content_ = std::move(c);
}

PackedVdb::~PackedVdb() = default;

double PackedVdb::spacing() const {
  return content_->grid.spacing;
}

int64_t PackedVdb::blocks() const {
  return static_cast<int64_t>(content_->grid.leaf.size());
}

int64_t PackedVdb::active_points() const {
  int64_t n = 0;
  for (const vdb::Leaf& leaf : content_->grid.leaf)
    for (size_t i = 0; i < 8; ++i) {
      uint64_t word;
      std::memcpy(&word, leaf.data.data() + 8 * i, sizeof word);
      n += std::popcount(word);
    }
  return n;
}

FieldInfo PackedVdb::info() const {
  return Reader(content_->grid, content_->file, 1).info();
}

BlockGrid PackedVdb::unpack(int threads, VdbExtras* extras) const {
  Reader reader(content_->grid, content_->file, threads);
  BlockGrid grid = reader.read(true);
  if (extras)
    *extras = reader.extras;
  return grid;
}

BlockGrid read_tile(std::istream& in, const std::string& file, int threads, VdbExtras& extras) {
  const std::string bytes = read_all(in, file);
  const vdb::FloatGrid decoded = vdb::decode(bytes, "density", file);
  Reader reader(decoded, file, threads);
  BlockGrid grid = reader.read(false);
  extras = reader.extras;
  return grid;
}

BlockGrid read_vdb(std::istream& in, const std::string& file, int threads, VdbExtras* extras) {
  return PackedVdb(in, file).unpack(threads, extras);
}

} // namespace molmesh::formats
