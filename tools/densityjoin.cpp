// densityjoin.cpp — several density grids (.vdb), each at its places, to one.
#include "tools/options/densityjoin.hpp"
#include "compose/assemble.hpp"
#include "formats/plan/plan.hpp"
#include "formats/vdb/vdb.hpp"
#include "tools/density_line.hpp"
#include "tools/join_tiles.hpp"
#include <algorithm>
#include <cstdio>
#include <memory>

using namespace molmesh;

namespace {

std::vector<formats::PlanPiece> read_pieces(const Options& o) {
  std::vector<formats::PlanPiece> pieces;
  if (o.piece.empty()) {
    cli::InputFile in(o.input);
    pieces = formats::read_plan(in.stream(), o.input == "-" ? "<stdin>" : in.name());
  } else if (o.input != "-") {
    fail(Status::usage, "--piece excludes a plan, found " + o.input);
  }
  for (const std::string& text : o.piece)
    pieces.push_back(formats::parse_piece(text, "--piece '" + text + "'"));
  if (pieces[0].subtract)
    fail_input(pieces[0].where + ": the first piece is subtracted, expected one to subtract from");
  for (const formats::PlanPiece& p : pieces) {
    if (p.file == "-" && (o.piece.empty() && o.input == "-"))
      fail_input(p.where + ": the plan is standard input, expected another file than -");
    if (cli::same_file(p.file, o.output) || cli::same_file(p.file, o.report))
      fail(Status::usage, p.where + ": " + p.file + " would be written over, expected another output");
  }
  return pieces;
}

/// Of each file, once.
std::vector<std::unique_ptr<compose::Ingredient>> read_files(const std::vector<formats::PlanPiece>& pieces,
                                                             int threads) {
  std::vector<std::unique_ptr<compose::Ingredient>> all;
  for (const formats::PlanPiece& p : pieces) {
    if (std::any_of(all.begin(), all.end(), [&](const auto& i) { return i->file == p.file; }))
      continue;
    cli::InputFile in(p.file);
    auto i = std::make_unique<compose::Ingredient>();
    formats::VdbExtras extras;
    i->grid = formats::read_vdb(in.stream(), in.name(), threads, &extras);
    i->tail = extras.tail;
    i->resampling_error = extras.resampling_error;
    i->surface = extras.surface;
    i->probe = extras.probe;
    i->file = p.file;
    all.push_back(std::move(i));
  }
  return all;
}

void report(cli::Run& r, const compose::Assembly& a) {
  const Vec3i n = a.grid.frame.points;
  r.counts["atoms"] = a.grid.info.atoms;
  r.counts["grid_points"] = std::vector{n.x, n.y, n.z};
  r.counts["spacing"] = a.grid.frame.spacing;
  r.counts["blocks"] = a.grid.corner.size();
  r.counts["inside_blocks"] = a.grid.inside.size();
  r.counts["copied"] = a.copied;
  r.counts["resampled"] = a.resampled;
  r.counts["shared_points"] = a.counts.shared_points;
  r.counts["tolerance"] = a.grid.info.tolerance;
  r.counts["largest_unknown"] = a.counts.largest_unknown;
  r.counts["resampling_error"] = a.resampling_error;
  if (a.resampled == 0)
    return;
  r.counts["resampling_distance"] = a.worst.distance;
  r.counts["resampling_distance_99"] = a.worst.distance_99;
  char text[200];
  std::snprintf(
      text, sizeof text, "%lld of %lld pieces resampled: 99 of 100 points of the surface move by less than %.2g Å",
      static_cast<long long>(a.resampled), static_cast<long long>(a.resampled + a.copied), a.worst.distance_99);
  r.note(text);
}

/// "sum of 4 pieces (2,960 atoms) on …"
std::string line(const compose::Assembly& a, std::span<const compose::Copy> copies, const compose::Options& c) {
  const int64_t less = std::count_if(copies.begin(), copies.end(), [](const auto& copy) { return copy.subtract; });
  const int64_t added = std::ssize(copies) - less;
  std::string s = added == 1 ? "" : c.combine == compose::Combine::max ? "union of " : "sum of ";
  s += cli::counted(added, "piece", "pieces");
  if (less > 0)
    s += " less " + grouped(less);
  s += " (" + cli::counted(a.grid.info.atoms, "atom", "atoms") + ") " + density_line(a.grid, c.threads);
  if (a.resampling_error > 0) {
    char text[80];
    std::snprintf(text, sizeof text, "; resampling errs by up to %.2g", a.resampling_error);
    s += text;
  }
  return s;
}

Status run(const Options& o, cli::Run& r) {
  if (!o.tiles.empty())
    return join_tiles(o, r);
  std::vector<double> band{0, 0};
  if (o.band != "auto") {
    band = cli::numbers("--band", o.band, 2);
    if (!(band[0] > 0 && band[0] < 1 && band[1] > 1))
      fail(Status::usage, "--band: found '" + o.band + "', expected auto or LO,HI with 0 < LO < 1 < HI");
  }
  compose::Options c;
  c.combine = o.combine == "max" ? compose::Combine::max : compose::Combine::sum;
  c.unknown = o.unknown;
  c.threads = o.resolved_threads();
  r.phase("read");
  const std::vector<formats::PlanPiece> pieces = read_pieces(o);
  cli::OutputFile out(o.output, cli::OutputFile::Content::binary);
  const auto files = read_files(pieces, c.threads);
  r.phase("join");
  std::vector<compose::Copy> copies;
  for (const formats::PlanPiece& p : pieces) {
    const auto of = std::find_if(files.begin(), files.end(), [&](const auto& f) { return f->file == p.file; });
    for (const Rigid& place : p.copies)
      copies.push_back({of->get(), place, p.subtract});
  }
  const double v = copies[0].of->grid.info.isovalue;
  compose::Assembly all = compose::assemble(copies, band[0] * v, band[1] * v, c);
  all.grid.info.creator = cli::creator(r.tool);
  report(r, all);
  r.phase("write");
  formats::write_vdb(out.stream(), all.grid, c.threads,
                     {all.tail, all.resampling_error, files[0]->surface, files[0]->probe, {}, 0});
  r.complete(out);
  r.made = line(all, copies, c);
  return Status::good;
}

} // namespace

int main(int argc, char** argv) {
  return cli::run_main<Options>("densityjoin", "Several density grids (.vdb), each at its places, to one", argc,
                                argv, describe, run);
}
