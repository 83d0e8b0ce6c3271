// density2tet.cpp — density grid (.vdb) to a conforming tetrahedral mesh (.vtu).
#include "tools/options/density2tet.hpp"
#include "base/memory.hpp"
#include "contour/contour.hpp"
#include "cuda/contour/contour.hpp"
#include "formats/vdb/vdb.hpp"
#include "formats/vtu/vtu.hpp"
#include "tools/contour_options.hpp"
#include "tools/device_report.hpp"
#include "tools/domains.hpp"
#include "tools/element_limit.hpp"
#include "tools/foreseen_phases.hpp"
#include "tools/mesh_line.hpp"
#include "tools/plan.hpp"
#include "tools/sizes.hpp"
#include <memory>
#include <optional>

using namespace molmesh;

namespace {

/// What --mode auto is. The device makes the same mesh, but later where it has to page.
void choose_mode(Options& o, const formats::PackedVdb& grid, const contour::Options& options, const cli::Run& run) {
  if (o.mode != "auto")
    return;
  o.mode = "omp";
  const contour::Plan plan =
      contour::plan(contour::expected_leaves(grid.spacing(), grid.active_points()), grid.blocks(), options.meshed);
  if (o.plan || !contour::is_sooner_on_device(plan, options.threads))
    return;
  lift_memory_limit();
  if (cuda::device_memory() > plan.memory) {
    o.mode = "cuda";
    run.note("mode cuda: " + cuda::device_name());
  } else {
    limit_memory(options.threads);
  }
}

Status run_tool(Options& o, cli::Run& run) {
  check_regions(o.regions, o.hier, o.region, !o.size.empty());
  contour::Options options = contour_options(o);

  run.phase("read");
  cli::InputFile input(o.input);
  std::optional<cli::OutputFile> output;
  if (!o.plan)
    output.emplace(o.output, cli::OutputFile::Content::binary);
  run.show_phases(foreseen_phases());
  auto packed = std::make_unique<const formats::PackedVdb>(input.stream(), input.name());
  choose_mode(o, *packed, options, run);
  std::unique_ptr<const Domains> domains;
  if (!o.hier.empty()) {
    const Hierarchy h = read_structure(o.hier, packed->info());
    options.sizes = size_balls(o.size, h, packed->spacing());
    if (o.regions != "molecule") {
      domains = std::make_unique<const Domains>(
          h, o.hier, o.regions, label::Options{packed->info().decay, packed->info().isovalue, options.threads});
      options.owners = domains->owners();
    }
  }
  const BlockGrid grid = plans::planned_grid(o, o, options, std::move(packed), o.elements, run);
  if (o.plan)
    return Status::good;
  contour::Summary summary;
  const auto of_input = [&](auto work) {
    try {
      return work();
    } catch (const Error& e) {
      fail(e.status, (e.status == Status::usage ? "" : input.name() + ": ") + e.what(), e.quantities);
    }
  };
  const auto make = [&](const contour::Options& with) {
    summary = {};
    const auto phase = [&](const std::string& p) { run.phase(p); };
    cuda::DeviceReport device;
    TetMesh made = of_input([&] {
      return o.on_device() ? cuda::contour_mesh(grid, with, summary, phase, device)
                           : contour::contour(grid, with, summary, phase);
    });
    if (o.on_device())
      run.counts["device"] = device_value(device);
    if (domains) {
      run.phase("divide");
      run.counts["regions"] = domains->divide(made);
    }
    return made;
  };
  std::string cost;
  TetMesh mesh;
  if (o.elements > 0) {
    run.phase("fit");
    const auto counter = of_input([&] { return std::make_unique<const contour::LeafCounter>(grid, options); });
    mesh = limited_mesh(*counter, grid, options, o.elements, run, cost, make);
  } else {
    mesh = make(options);
  }
  run.counts["points"] = mesh.point.size();
  run.counts["tetrahedra"] = mesh.tet.size();
  run.counts["triangles"] = mesh.tri.size();
  run.counts["adapt"] = summary.adapt;
  run.counts["halvings"] = summary.halvings;
  run.counts["leaves"] = summary.leaves;
  run.counts["surface_cells"] = summary.surface_cells;
  run.counts["split_cells"] = summary.split_cells;
  run.counts["restored_points"] = summary.restored_points;
  run.counts["relaxed_points"] = summary.relaxed_points;
  run.counts["face_points"] = summary.face_points;
  run.counts["edge_points"] = summary.edge_points;
  run.counts["divided_edges"] = 0; // none are; version 1 of the report keeps its keys
  run.counts["molecule_volumes"] = summary.molecule_volumes;
  run.counts["cavity_volumes"] = summary.cavity_volumes;
  run.counts["dropped_parts"] = summary.dropped_parts;
  run.counts["filled_cavities"] = summary.filled_cavities;
  if (mesh.sphere)
    run.counts["sphere"] = sphere_value(*mesh.sphere);

  if (summary.dropped_parts > 0)
    run.note("dropped parts of the molecule: " + std::to_string(summary.dropped_parts) +
             " (--drop-below), kept: " + std::to_string(summary.molecule_volumes.size()));
  if (summary.halvings > 0)
    run.note(std::string("bodies only a few grid spacings wide: cells of ") +
             (summary.halvings > 1 ? "a quarter" : "half") +
             " the spacing were used, so that they keep their volume; for more of their shape, give hier2density a "
             "smaller --spacing");

  run.phase("write");
  mesh.creator = cli::creator("density2tet");
  formats::write_vtu(output->stream(), mesh);
  run.complete(*output);
  run.end_phase();
  if (!run.quiet)
    run.made = cli::counted(std::ssize(mesh.tet), "tetrahedron", "tetrahedra") + ", " +
               (summary.molecule_volumes.empty()
                    ? ""
                    : cli::counted(std::ssize(summary.molecule_volumes), "body", "bodies") + ", ") +
               cli::counted(std::ssize(summary.cavity_volumes), "closed cavity", "closed cavities") + ", " + cost +
               mesh_line(mesh, options.threads) + (mesh.sphere ? ", within " + sphere_text(*mesh.sphere) : "");
  return Status::good;
}

} // namespace

int main(int argc, char** argv) {
  return cli::run_main<Options>(
      "density2tet", "Meshes the surface of a density grid (.vdb), its inside and its surroundings (.vtu).", argc,
      argv, describe, run_tool);
}
