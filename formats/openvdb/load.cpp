// load.cpp — the one source that includes the OpenVDB library.
#include "formats/openvdb/load.hpp"
#include "base/error.hpp"
#ifdef MOLMESH_OPENVDB
#include <exception>
#include <istream>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <streambuf>

namespace molmesh::formats {
namespace {

struct View : std::streambuf {
  explicit View(std::string_view b) {
    char* const p = const_cast<char*>(b.data());
    setg(p, p, p + b.size());
  }
  pos_type seekoff(off_type by, std::ios_base::seekdir from, std::ios_base::openmode) override {
    char* const base = from == std::ios_base::beg ? eback() : from == std::ios_base::cur ? gptr() : egptr();
    if (by < eback() - base || by > egptr() - base)
      return pos_type(off_type(-1));
    setg(eback(), base + by, egptr());
    return gptr() - eback();
  }
  pos_type seekpos(pos_type to, std::ios_base::openmode mode) override {
    return seekoff(off_type(to), std::ios_base::beg, mode);
  }
};

Vec3d vec(const openvdb::Vec3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// Dense over the active voxels' box and one voxel round it.
template <class Grid>
ForeignGrid dense(const Grid& grid, const std::string& file) {
  openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  const auto active = static_cast<double>(grid.activeVoxelCount());
  if (box.empty())
    fail_input(file + ": V4: no active voxel, expected some");
  if (!grid.transform().isLinear())
    fail_input(file + ": V3: a transform that is not linear, expected an affine one");
  box.expand(1);
  double n = 1;
  ForeignGrid out;
  for (int a = 0; a < 3; ++a) {
    n *= double(box.max()[a]) - box.min()[a] + 1;
    out.map.points[a] = box.max()[a] - box.min()[a] + 1;
  }
  constexpr double least = 1 << 27, of_active = 64;
  if (n > std::max(least, of_active * active))
    fail_input(file + ": V4: active voxels lie scattered over " + std::to_string(n) +
               " voxels, expected at most 64 times their number");
  out.level_set = grid.getGridClass() == openvdb::GRID_LEVEL_SET;
  out.name = grid.getName();
  const auto place = [&](const openvdb::Coord& c) { return vec(grid.indexToWorld(c)); };
  out.map.origin = place(box.min());
  for (int a = 0; a < 3; ++a) {
    openvdb::Coord next = box.min();
    next[a] += 1;
    out.map.axis[a] = place(next) - out.map.origin;
  }
  if (!(std::abs(out.map.volume_of_cell()) > 0) || !std::isfinite(out.map.volume_of_cell()))
    fail_input(file + ": V3: voxels of no volume");
  out.map.value.resize(static_cast<size_t>(n));
  const auto from = grid.getConstAccessor();
  const float sign = out.level_set ? -1 : 1;
  openvdb::Coord c;
  for (c.z() = box.min().z(); c.z() <= box.max().z(); ++c.z())
    for (c.y() = box.min().y(); c.y() <= box.max().y(); ++c.y()) {
      float* to = &out.map.value[out.map.index(0, c.y() - box.min().y(), c.z() - box.min().z())];
      for (c.x() = box.min().x(); c.x() <= box.max().x(); ++c.x()) {
        const auto v = static_cast<float>(from.getValue(c));
        if (!std::isfinite(v))
          fail_input(file + ": V4: a value that is not finite");
        *to++ = sign * v;
      }
    }
  return out;
}

} // namespace

ForeignGrid load_openvdb(std::string_view bytes, const std::string& name, const std::string& file) {
  openvdb::initialize();
  openvdb::GridPtrVecPtr grids;
  try {
    View view(bytes);
    std::istream in(&view);
    grids = openvdb::io::Stream(in, false).getGrids();
  } catch (const std::exception&) {
    fail_input(file + ": V1: truncated or damaged, expected a whole OpenVDB file");
  }
  std::string names;
  openvdb::GridBase::Ptr found;
  int fitting = 0;
  for (const openvdb::GridBase::Ptr& g : *grids) {
    names += (names.empty() ? "" : ", ") + g->getName() + " (" + g->valueType() + ")";
    const bool numbers = g->isType<openvdb::FloatGrid>() || g->isType<openvdb::DoubleGrid>();
    if (name.empty() ? numbers : g->getName() == name) {
      ++fitting;
      found = g;
    }
  }
  if (fitting != 1)
    fail_input(file + ": V2: grids " + (names.empty() ? "none" : names) + ", expected one " +
               (name.empty() ? "of type float or double, or a name that tells which" : "named " + name));
  if (const auto g = openvdb::gridPtrCast<openvdb::FloatGrid>(found))
    return dense(*g, file);
  if (const auto g = openvdb::gridPtrCast<openvdb::DoubleGrid>(found))
    return dense(*g, file);
  fail_input(file + ": V2: grid " + found->getName() + " of type " + found->valueType() +
             ", expected float or double");
}

} // namespace molmesh::formats
#else
namespace molmesh::formats {

ForeignGrid load_openvdb(std::string_view, const std::string&, const std::string& file) {
  fail(Status::mode_unavailable, file +
                                     ": an OpenVDB file of another program, which this map2density, built without "
                                     "the OpenVDB library, cannot read");
}

} // namespace molmesh::formats
#endif
