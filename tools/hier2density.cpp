// hier2density.cpp — molecular hierarchy (.hier) to the sparse density grid near its surface (.vdb).
#include "tools/options/hier2density.hpp"
#include "cli/progress.hpp"
#include "cuda/density/density.hpp"
#include "density/density.hpp"
#include "density/tail.hpp"
#include "distance/distance.hpp"
#include "formats/hier/hier.hpp"
#include "formats/vdb/leaves.hpp"
#include "formats/vdb/vdb.hpp"
#include "par/par.hpp"
#include "tools/density_line.hpp"
#include "tools/density_report.hpp"
#include "tools/device_report.hpp"
#include "tools/elements_spacing.hpp"
#include "tools/plan.hpp"
#include "tools/tile.hpp"
#include <optional>

using namespace molmesh;

namespace {

density::Options density_options(const Options& o) {
  density::Options d;
  const std::vector<double> band = cli::numbers("--band", o.band, 2);
  if (!(band[0] > 0 && band[0] < 1 && band[1] > 1))
    fail(Status::usage, "--band: found '" + o.band + "', expected LO,HI with 0 < LO < 1 < HI");
  if (o.grid > 0 && o.grid < 4)
    fail(Status::usage, "--grid: found " + std::to_string(o.grid) + ", expected 4 or more");
  if (o.grid > 0 && o.spacing)
    fail(Status::usage, "--spacing excludes --grid, expected one of them");
  if (o.elements > 0 && (o.grid > 0 || o.spacing))
    fail(Status::usage, "--elements excludes --spacing and --grid, expected one of them");
  if (o.elements == 0 && o.region != "interior")
    fail(Status::usage, "--region: found " + o.region + " without --elements, expected both or neither");
  d.spacing = o.spacing.value_or(0.5);
  d.grid_points = o.grid;
  if (o.margin != "auto") {
    d.margin = decimal(o.margin).value_or(-1);
    if (!(d.margin >= 0))
      fail(Status::usage, "--margin: found '" + o.margin + "', expected auto or a number >= 0");
  }
  d.decay = o.decay.value_or(1);
  d.isovalue = o.isovalue.value_or(1);
  d.band_lower = band[0] * d.isovalue;
  d.band_upper = band[1] * d.isovalue;
  d.tolerance = o.tolerance;
  d.full_search = o.search == "full";
  d.atoms = o.atoms == "all"      ? density::AtomSearch::all
            : o.atoms == "kdtree" ? density::AtomSearch::kdtree
                                  : density::AtomSearch::bvh;
  if (o.on_device() && d.atoms == density::AtomSearch::kdtree)
    fail(Status::usage, "--atoms: found kdtree, expected bvh or all with --mode cuda");
  d.threads = o.resolved_threads();
  d.tile = tile_of(o.tile, o.on_device());
  return d;
}

/// Of a surface that is none of a density.
std::optional<distance::Body> body_of(const Options& o) {
  using distance::Surface;
  const auto refuse = [&](const char* option, bool given, const char* expected) {
    if (given)
      fail(Status::usage, std::string(option) + " is given with --surface " + o.surface + ", expected " + expected);
  };
  refuse("--probe", o.probe && o.surface != "ses" && o.surface != "sas", "--surface ses or sas");
  if (o.surface == "gaussian")
    return {};
  const char* const gaussian = "--surface gaussian";
  refuse("--decay", o.decay.has_value(), gaussian);
  refuse("--isovalue", o.isovalue.has_value(), gaussian);
  refuse("--search full", o.search == "full", gaussian);
  refuse("--atoms", o.atoms != "bvh", gaussian);
  refuse("--plan", o.plan, gaussian);
  refuse("--mode cuda", o.on_device(), "--mode omp: distances are computed on the host");
  return distance::Body{o.surface == "ses"   ? Surface::solvent_excluded
                        : o.surface == "sas" ? Surface::solvent_accessible
                                             : Surface::van_der_waals,
                        o.probe.value_or(1.4)};
}

Status run(const Options& o, cli::Run& r) {
  density::Options d = density_options(o);
  const std::optional<distance::Body> body = body_of(o);
  cli::InputFile in(o.input);
  std::optional<cli::OutputFile> out;
  if (!o.plan)
    out.emplace(o.output, cli::OutputFile::Content::binary);
  r.phase("read");
  Hierarchy h;
  par::start_threads_during(o.resolved_threads(), [&] { h = formats::read_hier(in.stream(), in.name()); });
  if (o.on_device() && !h.body.empty())
    fail(Status::mode_unavailable, in.name() + ": found bodies without atoms, expected --mode omp or seq for them");
  if (body && !h.body.empty())
    fail_input(in.name() + ": found bodies without atoms, expected --surface gaussian for them");
  if (o.elements > 0)
    d.spacing = spacing_of_elements(h, body, d, o.elements, o.region, r);
  if (!body && plans::density_is_planned(o, o, d, h, r))
    return Status::good;
  formats::Leaves leaves(o.resolved_threads());
  d.take = [&](const FieldInfo& info, std::span<const BandBlocks> runs) {
    r.phase("write");
    leaves.add(runs, static_cast<float>(info.inside_value));
    r.phase("density");
  };
  r.phase("density");
  density::Counts counts;
  Band band;
  {
    cli::Progress progress("density", "nodes", o.quiet);
    d.progress = [&progress](int64_t done, int64_t total) { progress(done, total); };
    if (body) {
      band = distance::compute(h, *body, d, counts);
    } else if (o.on_device()) {
      cuda::DeviceReport device;
      band = cuda::compute_density(h, d, counts, device);
      r.counts["device"] = device_value(device);
    } else {
      band = density::compute(h, d, counts);
    }
  }
  band.info.creator = cli::creator(r.tool);
  report(r, band, leaves, counts);
  r.phase("write");
  formats::VdbExtras extras;
  if (!body) // of a density alone
    extras.tail = density::tail(h, d.decay, d.isovalue, band.frame);
  extras.surface = o.surface;
  extras.probe = body ? body->probe : 0;
  extras.tile = d.tile;
  extras.tile_digest = d.tile.whole() ? 0 : digest_of(h, d);
  formats::write_vdb(out->stream(), band.frame, band.info, band.inside, leaves, extras);
  r.complete(*out);
  r.made = cli::counted(band.info.atoms, "atom", "atoms") + ' ' + grid_words(band.frame) + "; " +
           kept_words(counts.search.active_points);
  return Status::good;
}

} // namespace

int main(int argc, char** argv) {
  return cli::run_main<Options>("hier2density",
                                "Molecular hierarchy (.hier) to the density near its surface (.vdb)", argc, argv,
                                describe, run);
}
