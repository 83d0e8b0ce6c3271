// tetsmooth.cpp — tetrahedral mesh (.vtu) to a better one: every element good enough to solve on.
#include "tools/options/tetsmooth.hpp"
#include "base/give_back_memory.hpp"
#include "cuda/optimize/optimize.hpp"
#include "formats/hier/hier.hpp"
#include "formats/vdb/vdb.hpp"
#include "formats/vtu/vtu.hpp"
#include "mesh/attribute_transfer.hpp"
#include "mesh/partition.hpp"
#include "mesh/same_source.hpp"
#include "mesh/worst_elements.hpp"
#include "molecule/hierarchy.hpp"
#include "optimize/optimize.hpp"
#include "tools/device_report.hpp"
#include "tools/domains.hpp"
#include "tools/mesh_line.hpp"
#include "tools/optimization_report.hpp"
#include "tools/plan.hpp"
#include "tools/structure_labels.hpp"
#include <optional>
#include <utility>

using namespace molmesh;

namespace {

Status run_tool(const Options& o, cli::Run& run) {
  const int threads = o.resolved_threads();
  run.phase("read");
  std::optional<cli::InputFile> density, structure;
  if (!o.density.empty())
    density.emplace(o.density);
  if (!o.hier.empty())
    structure.emplace(o.hier);
  cli::InputFile input(o.input);
  std::optional<cli::OutputFile> output;
  if (!o.plan)
    output.emplace(o.output, cli::OutputFile::Content::binary);
  run.show_phases();
  std::optional<BlockGrid> grid;
  if (density)
    grid = formats::read_vdb(density->stream(), density->name(), threads);
  std::optional<Hierarchy> hierarchy;
  if (structure)
    hierarchy = formats::read_hier(structure->stream(), structure->name());
  formats::MeshNotes notes;
  TetMesh mesh = read_mesh(run, input, o.mesh, formats::CellArrays::keep, notes);
  if (grid)
    require_same_source(mesh, !notes.isovalue_missing, grid->info, density->name());
  if (plans::improvement_is_planned(o, o, mesh, grid ? &*grid : nullptr, {o.iterations, o.chosen(), threads}, run))
    return Status::good;
  const std::string level = formats::region_level(mesh);
  const AttributeTransfer arrays(mesh);
  run.counts.add({{"elements_before", mesh.tet.size()}, {"points_before", mesh.point.size()}});
  optimize::Options options;
  options.iterations = o.iterations;
  options.threads = threads;
  options.effort = o.chosen();
  options.coarsen = o.coarsen;
  options.min_dihedral = o.min_dihedral;
  options.max_dihedral = o.max_dihedral;
  if (mesh.creator.rfind("density2tet", 0) == 0)
    options.sharp = 180;  // an isosurface is smooth: folds of its first mesh are no features
  if (run.shows_phases()) // it has to be counted
    options.progress = [&](double share) { run.share(share); };
  if (hierarchy && grid && !level.empty()) {
    require_same_atoms(*hierarchy, structure->name(), mesh);
    const Domains domains(*hierarchy, structure->name(), level, {grid->info.decay, grid->info.isovalue, threads});
    options.interfaces = domains.interfaces(mesh, grid->frame, structure->name());
  } else if (!level.empty() && o.iterations > 0) {
    run.note("regions of level " + level +
             ": their interfaces are kept where they are; --density and --hier put them "
             "where shares are equal");
  }
  optimize::Result result;
  try {
    const auto phase = [&](const std::string& p) { run.phase(p); };
    cuda::DeviceReport device;
    result = o.on_device() ? cuda::improve_mesh(mesh, grid ? &*grid : nullptr, options, phase, device)
                           : optimize::improve(mesh, grid ? &*grid : nullptr, options, phase);
    if (o.on_device())
      run.counts["device"] = device_value(device);
  } catch (const Error& e) {
    fail(e.status, input.name() + ": " + e.what(), e.quantities);
  }
  give_back_memory(); // of the mesh that operations changed, twice the result's
  run.phase("partition");
  mesh.part = partition(mesh, o.parts, threads, std::move(result.across));
  const optimize::Counts& c = result.counts;
  run.counts.add({{"elements", mesh.tet.size()},
                  {"points", mesh.point.size()},
                  {"rounds", result.rounds},
                  {"moves", c.moves},
                  {"edge_removals", c.edge_removals},
                  {"surface_flips", c.surface_flips},
                  {"face_swaps", c.face_swaps},
                  {"contractions", c.contractions},
                  {"splits", c.splits},
                  {"hand_overs", 0}, // none are; version 1 of the report keeps its keys
                  {"nestings", c.cavity_shrinks},
                  {"quality_before", angles_value(result.before)},
                  {"quality_after", angles_value(result.after)}});
  if (o.coarsen)
    run.counts["removed_points"] = result.removed;
  if (grid && o.iterations > 0)
    run.counts["surface"] = fidelity_value(result.fidelity);
  if (grid && o.iterations > 0 && !level.empty())
    run.counts["interfaces"] = {{"points", result.fidelity.interface_points},
                                {"points_off", result.fidelity.interface_points_off}};
  if (result.rejected)
    run.note("as it came: the worst element was worse after " + std::to_string(result.rounds) + " rounds");
  else if (grid && o.iterations > 0 && 2 * result.fidelity.points_off > result.fidelity.points)
    run.note("off the isosurface: " + std::to_string(result.fidelity.points_off) + " of " +
             std::to_string(result.fidelity.points) + " surface points: too thin, or another density?");
  else if (grid && o.iterations > 0 && missing_share(result.fidelity) >= 0.01)
    run.note("the isosurface encloses " + percent(missing_share(result.fidelity)) +
             " more: parts thinner than the grid are lost, which a density on a finer one keeps");
  if (size_t(o.parts) > mesh.tet.size() && o.parts != Options().parts)
    run.note("--parts: one for each of the " + std::to_string(mesh.tet.size()) + " elements, there are no more");
  arrays.put_into(mesh, threads);
  if (!arrays.empty())
    run.note("carried from the nearest element before: " + arrays.names());
  mesh.creator = cli::creator("tetsmooth");
  run.phase("write");
  formats::write_vtu(output->stream(), mesh);
  run.complete(*output);
  if (run.verbose)
    run.note("dihedral angles " + optimize::text(result.before) + "; now " + optimize::text(result.after));
  if (!run.quiet)
    run.made = cli::counted(std::ssize(mesh.tet), "tetrahedron", "tetrahedra") + ", " + mesh_line(mesh, threads) +
               (grid && o.iterations > 0
                    ? ", " + cli::counted(result.fidelity.points_off, "point", "points") + " off the isosurface"
                    : "");
  const AngleLimits limits{o.min_dihedral, o.max_dihedral};
  if (limits.hold(result.after.min) && limits.hold(result.after.max))
    return Status::good;
  run.note("below the quality asked for: " + std::to_string(count_beyond(mesh, limits, threads)) +
           " elements beyond it, dihedral angles " + range_text(result.after.min, result.after.max));
  for (const WorstTet& t : worst_tets(mesh, limits, 10, threads))
    run.note(described(t) + (hierarchy ? ", nearest to " + nearest_name(*hierarchy, t.centre) : ""));
  return Status::below_quality;
}

} // namespace

int main(int argc, char** argv) {
  return cli::run_main<Options>("tetsmooth", "Improves a tetrahedral mesh (.vtu): swaps, contracts, moves, splits.",
                                argc, argv, describe, run_tool);
}
