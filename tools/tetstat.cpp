// tetstat.cpp — validity and quality of a tetrahedral mesh (.vtu), for people or as JSON.
#include "tools/options/tetstat.hpp"
#include "formats/tetstat/bodies.hpp"
#include "formats/tetstat/tetstat.hpp"
#include "tools/structure_labels.hpp"
#include <optional>
#include <ostream>

using namespace molmesh;

namespace {

/// bodies: where it is given and the mesh is valid, the list in place of distributions.
formats::MeshReport report(const std::string& path, const Options& o, cli::Run& run,
                           std::optional<formats::BodyList>* bodies = nullptr) {
  const int threads = o.resolved_threads();
  run.phase("read");
  cli::InputFile input(path);
  formats::MeshNotes notes;
  TetMesh mesh =
      read_mesh(run, input, o.mesh, bodies ? formats::CellArrays::keep : formats::CellArrays::drop, notes);
  run.phase("validity");
  Validity validity = check_validity(mesh, threads);
  bool uncrossed = false;
  if (o.crossings) {
    run.phase("crossings");
    const size_t faults = validity.faults.size();
    add_crossings(validity, mesh, threads);
    uncrossed = !validity.region.empty() && validity.faults.size() == faults;
  }
  run.phase("quality");
  if (bodies && validity.valid() && !o.hierarchy.empty())
    label_surface(mesh, o.hierarchy, threads, run);
  if (bodies && validity.valid()) {
    *bodies = formats::list_bodies(mesh, input.name(), threads);
    (*bodies)->uncrossed = uncrossed;
  }
  formats::MeshReport r = formats::report_mesh(mesh, input.name(), notes, std::move(validity),
                                               {o.min_dihedral, o.max_dihedral}, threads);
  r.uncrossed = uncrossed;
  return r;
}

Status run_tool(const Options& o, cli::Run& run) {
  if (o.compare == "-" && o.input == "-")
    fail(Status::usage, "--compare: standard input can be one of the two meshes, not both");
  if (o.bodies && !o.compare.empty())
    fail(Status::usage, "--bodies excludes --compare");
  if (!o.bodies && !o.hierarchy.empty())
    fail(Status::usage, "--hier: found without --bodies, expected both");
  if (o.hierarchy == "-" && o.input == "-")
    fail(Status::usage, "both inputs are standard input, expected at most one");
  cli::OutputFile output(o.output);
  std::optional<formats::BodyList> bodies;
  std::optional<formats::MeshReport> before;
  if (!o.compare.empty())
    before = report(o.compare, o, run);
  const formats::MeshReport mesh = report(o.input, o, run, o.bodies ? &bodies : nullptr);
  run.phase("write");
  if (bodies) {
    output.stream() << (o.json ? formats::bodies_json(*bodies) : formats::bodies_text(*bodies));
  } else if (o.json) {
    output.stream() << (before ? formats::compare_json(*before, mesh) : formats::tetstat_json(mesh));
  } else {
    output.stream() << (before ? formats::compare_text(*before, mesh) : formats::tetstat_text(mesh));
  }
  run.complete(output);
  run.counts["points"] = mesh.points;
  run.counts["tets"] = mesh.tets;
  run.counts["triangles"] = mesh.triangles;
  run.counts["faults"] = mesh.validity.faults.size();
  return mesh.validity.valid() && mesh.good() ? Status::good : Status::below_quality;
}

} // namespace

int main(int argc, char** argv) {
  return cli::run_main<Options>("tetstat", "Validity and quality of a tetrahedral mesh (.vtu).", argc, argv,
                                describe, run_tool);
}
