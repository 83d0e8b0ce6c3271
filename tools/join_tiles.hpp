// join_tiles.hpp — densityjoin --tiles: the tiles of a density to the file that one run of hier2density writes.
#pragma once
#include "cli/run.hpp"
#include "cli/text.hpp"
#include "formats/vdb/tiles.hpp"
#include "tools/density_line.hpp"
#include "tools/options/densityjoin.hpp"
#include <string>

namespace molmesh {

inline Status join_tiles(const Options& o, cli::Run& r) {
  if (!o.piece.empty() || o.input != "-")
    fail(Status::usage, "--tiles excludes pieces and plans, found " + (o.piece.empty() ? o.input : o.piece[0]));
  if (o.combine != "sum" || o.band != "auto")
    fail(Status::usage, "--tiles puts parts of one density together, expected no --combine and --band with it");
  cli::OutputFile out(o.output, cli::OutputFile::Content::binary);
  formats::TileJoin all(o.resolved_threads());
  r.phase("read");
  for (const std::string& file : o.tiles) {
    cli::InputFile in(file);
    all.add(in.stream(), in.name());
  }
  all.check_complete();
  const Vec3i n = all.frame().points;
  r.counts["tiles"] = all.tiles();
  r.counts["atoms"] = all.info().atoms;
  r.counts["grid_points"] = std::vector{n.x, n.y, n.z};
  r.counts["spacing"] = all.frame().spacing;
  r.counts["blocks"] = all.blocks();
  r.counts["inside_blocks"] = all.inside_blocks();
  r.phase("write");
  all.write(out.stream());
  r.complete(out);
  r.made = cli::counted(static_cast<int64_t>(all.tiles()), "tile", "tiles") + " (" +
           cli::counted(all.info().atoms, "atom", "atoms") + ") joined, " + grid_words(all.frame());
  return Status::good;
}

} // namespace molmesh
