// preamble.cpp — one grid of floats named density, as a stream; its metadata is that of VDBv1.md.
#include "formats/vdb/preamble.hpp"
#include <random>

namespace molmesh::formats {
namespace {

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

} // namespace

void write_preamble(Bytes& out, const GridFrame& f, const FieldInfo& info, const VdbExtras& extras) {
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
  if (extras.tail.known()) {
    m.add("tail_log", "double", extras.tail.log);
    m.add("tail_decay", "double", extras.tail.decay);
    m.add("tail_radius", "double", extras.tail.radius);
    m.add("tail_depth", "double", extras.tail.depth);
  }
  if (extras.resampling_error > 0)
    m.add("resampling_error", "double", extras.resampling_error);
  if (extras.surface != "gaussian") {
    m.add("surface", extras.surface);
    if (extras.surface != "vdw")
      m.add("probe", "double", extras.probe);
  }
  if (!extras.tile.whole()) {
    m.add("tile", "int32", extras.tile.number);
    m.add("tiles", "int32", extras.tile.count);
    m.add("tile_digest", "int64", extras.tile_digest);
  }
  m.write(out);

  const double h = f.spacing;
  out.string("UniformScaleTranslateMap");
  for (const double t : {f.origin.x, f.origin.y, f.origin.z})
    out.number(t);
  for (const double v : {h, h, 1 / h, 1 / (h * h), 0.5 / h}) // scale, voxel size, inverses
    for (int a = 0; a < 3; ++a)
      out.number(v);
}

} // namespace molmesh::formats
