// map2density.cpp — a map of another program (CCP4/MRC, OpenDX, OpenVDB) at a level to a density grid (.vdb).
#include "tools/options/map2density.hpp"
#include "compose/from_map.hpp"
#include "formats/map/read_map.hpp"
#include "formats/openvdb/openvdb.hpp"
#include "formats/read_all.hpp"
#include "formats/vdb/vdb.hpp"
#include "tools/density_line.hpp"
#include <cstdio>

using namespace molmesh;

namespace {

compose::DenseMap read(const Options& o, cli::InputFile& in, compose::MapOptions& m) {
  std::string bytes = formats::read_all(in.stream(), in.name());
  if (!formats::is_vdb(bytes)) {
    if (!o.grid.empty())
      fail(Status::usage, "--grid: " + in.name() + " is no OpenVDB file, expected one");
    if (!o.level)
      fail(Status::usage, "--level: not given, expected the contour level");
    return formats::read_map(std::move(bytes), in.name(), o.resolved_threads());
  }
  formats::ForeignGrid grid = formats::read_openvdb(bytes, o.grid, in.name());
  if (!o.level && !grid.level_set)
    fail(Status::usage,
         "--level: not given, expected the contour level of grid " + grid.name + ", which is no level set");
  m.level = o.level.value_or(0);
  return std::move(grid.map);
}

/// Of the density that the new one shall join.
void take_lattice(const Options& o, compose::MapOptions& m) {
  if (o.spacing || o.isovalue != 1 || o.decay != 1)
    fail(Status::usage, "--like excludes --spacing, --isovalue and --decay, expected it alone");
  cli::InputFile in(o.like);
  const BlockGrid like = formats::read_vdb(in.stream(), in.name(), m.threads);
  m.spacing = like.frame.spacing;
  m.lattice = like.frame.origin;
  m.isovalue = like.info.isovalue;
  m.decay = like.info.decay;
}

std::string source_of(const std::string& file, double level) {
  char text[40];
  std::snprintf(text, sizeof text, " level %.9g", level);
  return file.substr(file.rfind('/') + 1) + text;
}

Status run(const Options& o, cli::Run& r) {
  compose::MapOptions m;
  m.level = o.level.value_or(0);
  m.spacing = o.spacing.value_or(0);
  m.isovalue = o.isovalue;
  m.decay = o.decay;
  m.threads = o.resolved_threads();
  if (!o.like.empty())
    take_lattice(o, m);
  cli::InputFile in(o.input);
  cli::OutputFile out(o.output, cli::OutputFile::Content::binary);
  r.phase("read");
  const compose::DenseMap map = read(o, in, m);
  r.counts["map_points"] = std::vector{map.points.x, map.points.y, map.points.z};
  r.phase("density");
  compose::MapCounts counts;
  BlockGrid grid = compose::from_map(map, m, counts);
  grid.info.creator = cli::creator(r.tool);
  grid.info.source = source_of(in.name(), m.level);
  const Vec3i n = grid.frame.points;
  r.counts["grid_points"] = std::vector{n.x, n.y, n.z};
  r.counts["spacing"] = grid.frame.spacing;
  r.counts["level"] = m.level;
  r.counts["least_value"] = counts.least;
  r.counts["most_value"] = counts.most;
  r.counts["slope_of_map"] = counts.slope_of_map;
  r.counts["interpolated"] = counts.interpolated;
  r.counts["wall_points"] = counts.wall_points;
  r.counts["blocks"] = grid.corner.size();
  r.counts["inside_blocks"] = grid.inside.size();
  if (counts.wall_points > 0)
    r.note("the contour reaches the map's walls: it is closed there");
  r.phase("write");
  formats::write_vdb(out.stream(), grid, m.threads);
  r.complete(out);
  r.made = grid.info.source + ' ' + density_line(grid, m.threads);
  return Status::good;
}

} // namespace

int main(int argc, char** argv) {
  return cli::run_main<Options>("map2density", "A map at a contour level to the density near its surface (.vdb)",
                                argc, argv, describe, run);
}
