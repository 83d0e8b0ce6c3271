// density2map.cpp — the sparse density grid (.vdb) as a dense map that other viewers read (CCP4/MRC, OpenDX).
#include "tools/options/density2map.hpp"
#include "base/grouped.hpp"
#include "cli/text.hpp"
#include "formats/map/map.hpp"
#include "formats/vdb/vdb.hpp"

using namespace molmesh;

namespace {

/// By the ending of the output's name.
std::string format_of(const Options& o) {
  const size_t name = o.output.rfind('/') + 1, dot = o.output.rfind('.');
  if (o.format != "auto")
    return o.format;
  const std::string ending = dot == std::string::npos || dot <= name ? "" : o.output.substr(dot);
  if (ending == ".dx")
    return "dx";
  if (ending.empty() || ending == ".map" || ending == ".ccp4" || ending == ".mrc")
    return "ccp4";
  fail(Status::usage,
       "-o: found " + o.output + ", expected a name that ends in one of .map, .ccp4, .mrc, .dx, or --format");
}

Status run(const Options& o, cli::Run& r) {
  const int threads = o.resolved_threads();
  const std::string format = format_of(o);
  cli::InputFile in(o.input);
  using Content = cli::OutputFile::Content;
  cli::OutputFile out(o.output, format == "dx" ? Content::text : Content::binary);
  r.phase("read");
  const BlockGrid grid = formats::read_vdb(in.stream(), in.name(), threads);
  r.counts["grid_points"] = std::vector{grid.frame.points.x, grid.frame.points.y, grid.frame.points.z};
  r.phase("write");
  (format == "dx" ? formats::write_dx : formats::write_ccp4)(out.stream(), grid, in.name());
  r.complete(out);
  const Vec3i n = grid.frame.points;
  r.made = grouped(n.x) + " × " + grouped(n.y) + " × " + grouped(n.z) + " points";
  return Status::good;
}

} // namespace

int main(int argc, char** argv) {
  return cli::run_main<Options>("density2map", "Density grid (.vdb) to a dense map for viewers (CCP4/MRC, OpenDX)",
                                argc, argv, describe, run);
}
