// plan.hpp — what the programs tell before they work: sizes, memory, seconds, and the spacing that would fit.
#pragma once
#include "base/grouped.hpp"
#include "cli/plan.hpp"
#include "contour/plan.hpp"
#include "density/plan.hpp"
#include "formats/vdb/vdb.hpp"
#include "optimize/plan.hpp"
#include "tools/element_limit.hpp"
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace molmesh::plans {

/// A structure on a grid: what the chain's programs get.
struct Chain {
  density::GridSize size;
  contour::Leaves leaves;
  Chain at(double spacing) const {
    return {density::at_spacing(size, spacing), contour::at_spacing(leaves, size.spacing, spacing, size.smooth)};
  }
  contour::Plan mesh(contour::Options::Meshed meshed) const { return contour::plan(leaves, size.blocks, meshed); }
  optimize::Plan improvement(contour::Options::Meshed meshed, int threads) const {
    const contour::Plan m = mesh(meshed);
    optimize::Work work{m.elements, m.triangles};
    work.across = m.across;
    work.blocks = size.blocks;
    work.threads = threads;
    return optimize::plan(work);
  }
  /// Of density2tet and tetsmooth, the larger.
  int64_t memory(contour::Options::Meshed meshed, int threads) const {
    return std::max(mesh(meshed).memory, improvement(meshed, threads).memory);
  }
};

/// "--spacing 0.62 fits": the finest from h on, in steps of 3 %, whose need leaves a tenth of the limit, up to 20
/// Å.
template <class Need>
std::string fitting_spacing(double h, int64_t limit, Need need) {
  for (double s = h; s < std::max(2 * h, 20.); s *= 1.03)
    if (10 * need(s) <= 9 * limit) {
      char text[64];
      std::snprintf(text, sizeof text, "hier2density --spacing %.2g fits", std::max(s, 0.01) + 0.005 * s);
      return text;
    }
  return "no spacing fits";
}

/// Says before the work what a few bytes of input become: over 256 MB, and over a thousand times what came in.
inline void say_growth(const cli::Run& run, const std::string& what, int64_t memory, int64_t bytes_in) {
  if (memory > int64_t{256} << 20 && memory / 1000 > bytes_in)
    run.note(what + ", about " + cli::size_text(memory) +
             " of memory, from little: --plan tells more, --max-mem limits it");
}

inline void add_mesh(cli::Value& plan, const contour::Plan& p, double speed) {
  plan.add(
      {{"elements", p.elements}, {"points", p.points}, {"memory_bytes", p.memory}, {"seconds", p.seconds / speed}});
}

inline void add_improvement(cli::Value& plan, const optimize::Plan& p, double speed) {
  plan.add({{"elements", p.elements}, {"memory_bytes", p.memory}, {"seconds", p.seconds / speed}});
}

/// Of a plan's grid, or of the cubes that stand for it. meshed: both.
inline contour::Leaves leaves_of(const density::Plan& plan, contour::Options options) {
  if (plan.sample.empty())
    return contour::count_leaves(to_block_grid(plan.band, options.threads), options);
  contour::Leaves all;
  options.box.kind = contour::BoxRequest::corners;
  for (const density::PlanSample& s : plan.sample) {
    options.box.lower = s.low;
    options.box.upper = s.high;
    const BlockGrid grid = to_block_grid(s.band, options.threads);
    const auto inside = [&](float v) { return v > static_cast<float>(grid.info.isovalue); };
    if (std::any_of(grid.value.begin(), grid.value.end(), inside) &&
        !std::all_of(grid.value.begin(), grid.value.end(), inside)) // else no surface
      all.add(contour::count_leaves(grid, options), s.weight);
  }
  return all;
}

/// hier2density: with --plan writes what all three programs take and returns true. Throws Error(failed) where the
/// memory is too small.
inline bool density_is_planned(const cli::Common& o, const cli::PlanOptions& p, const density::Options& d,
                               const Hierarchy& h, const cli::Run& run) {
  using contour::Options;
  const auto atoms = static_cast<int64_t>(h.atom.size());
  const int64_t limit = p.memory_limit();
  if (!p.plan) { // a bound first: most runs need no plan
    density::GridSize most;
    most.active_points = int64_t(std::min(density::most_active_points(h) / (d.spacing * d.spacing), 1e17));
    const int64_t bound = density::cost(most, atoms).memory;
    if (d.grid_points == 0 && d.tile.whole()) {
      say_growth(run, "a density of up to " + grouped(most.active_points) + " points", bound, 50 * atoms);
      if (density::of_great_balls(h)) { // no count
        if (limit >= 0 && bound / 2 > limit)
          density::check_field(h, d); // what no spacing would change is said first
        cli::require_memory(p, bound / 2, "a density at " + cli::length_text(d.spacing), "a larger --spacing fits");
        return false;
      }
    }
    if (limit < 0 || (d.grid_points == 0 && bound <= limit))
      return false;
  }
  const density::Plan plan = density::quick_plan(h, d);
  const density::GridSize own = density::part_of(plan, d.tile);
  const density::Cost cost = density::cost(own, atoms);
  if (!p.plan) {
    cli::require_memory(p, cost.memory, "a density at " + cli::length_text(plan.size.spacing),
                        fitting_spacing(plan.size.spacing, limit, [&](double s) {
                          density::GridSize at = density::at_spacing(plan.counted, s);
                          at.active_points = int64_t(double(at.active_points) * own.active_points /
                                                     double(std::max<int64_t>(1, plan.size.active_points)));
                          return density::cost(at, atoms).memory;
                        }));
    return false;
  }
  const Vec3i n = plan.size.points;
  const cli::Speeds speeds = p.speeds();
  cli::Value v{{"atoms", atoms},
               {"spacing", plan.size.spacing},
               {"margin", plan.margin},
               {"grid_points", std::vector{n.x, n.y, n.z}},
               {"active_points", own.active_points},
               {"blocks", own.blocks},
               {"memory_bytes", cost.memory},
               {"seconds", cost.seconds / speeds.hier2density}};
  Options both;
  both.meshed = Options::both;
  both.threads = d.threads;
  const Chain counted{plan.counted, leaves_of(plan, both)};
  const Chain chain = counted.at(plan.size.spacing);
  for (const auto& [region, meshed] :
       {std::pair{"interior", Options::interior}, std::pair{"both", Options::both}}) {
    add_mesh(v["density2tet"][region], chain.mesh(meshed), speeds.density2tet);
    add_improvement(v["tetsmooth"][region], chain.improvement(meshed, d.threads), speeds.tetsmooth);
  }
  cli::write_plan(o, p, run, v);
  return true;
}

/// density2tet: as above. grid: unpacks the values; a mesh that is far too large is refused without them.
/// most_elements: --elements, 0 without.
template <class Unpack>
bool mesh_is_planned(const cli::Common& o, const cli::PlanOptions& p, const contour::Options& options,
                     const density::GridSize& size, int64_t most_elements, const cli::Run& run, Unpack grid) {
  const int64_t limit = p.memory_limit();
  const auto refuse = [&](const Chain& chain) {
    cli::require_memory(p, chain.mesh(options.meshed).memory, "a mesh at " + cli::length_text(size.spacing),
                        fitting_spacing(size.spacing, limit, [&](double s) {
                          return chain.at(s).memory(options.meshed, options.threads);
                        }));
  };
  const bool usual = !options.adapt && options.box.kind == contour::BoxRequest::automatic && !options.owners &&
                     options.sizes.empty() && most_elements == 0;
  Chain chain{size, contour::expected_leaves(size.spacing, size.active_points)};
  if (!p.plan) {
    if (options.box.kind == contour::BoxRequest::tight) { // as fine as the grid at all of the walls
      const Vec3i n = grid().frame.points;
      chain.leaves.all += 4. / 3 * (double(n.x) * n.y + double(n.y) * n.z + double(n.z) * n.x);
    }
    const int64_t expected = chain.mesh(options.meshed).memory;
    if (most_elements == 0)
      say_growth(run, "a mesh of up to " + grouped(chain.mesh(options.meshed).elements) + " elements", expected,
                 5 * size.active_points + 600 * size.blocks);
    if (limit < 0 || (usual && 2 * expected < limit))
      return false;
    if (usual && 2 * expected > 3 * limit)
      refuse(chain);
  }
  constexpr int64_t countable = 20'000'000;
  contour::Fit fit;
  if (most_elements > 0 && !p.plan) // the mesh is fitted later: no more than that it will be
    chain.leaves =
        chain.leaves.times(std::min(1., double(most_elements) / double(chain.mesh(options.meshed).elements)));
  else if (most_elements > 0)
    chain.leaves = (fit = planned_fit(grid(), options, most_elements)).leaves;
  else if (!p.plan || !usual || size.active_points <= countable)
    chain.leaves = contour::count_leaves(grid(), options);
  if (!p.plan) {
    refuse(chain);
    return false;
  }
  const cli::Speeds speeds = p.speeds();
  cli::Value v{{"spacing", size.spacing},
               {"active_points", size.active_points},
               {"blocks", size.blocks},
               {"leaves", std::llround(chain.leaves.all)}};
  if (most_elements > 0)
    v.add({{"adapt", fit.fineness.adapt}, {"layers", fit.fineness.layers}});
  add_mesh(v, chain.mesh(options.meshed), speeds.density2tet);
  add_improvement(v["tetsmooth"], chain.improvement(options.meshed, options.threads), speeds.tetsmooth);
  cli::write_plan(o, p, run, v);
  return true;
}

/// The grid that density2tet reads, after its plan; with --plan any grid.
inline BlockGrid planned_grid(const cli::Common& o, const cli::PlanOptions& p, const contour::Options& options,
                              std::unique_ptr<const formats::PackedVdb> packed, int64_t most_elements,
                              const cli::Run& run) {
  const density::GridSize size{packed->spacing(), {}, packed->active_points(), packed->blocks(), 0};
  std::optional<BlockGrid> grid;
  const auto unpack = [&]() -> const BlockGrid& {
    return grid ? *grid : grid.emplace(packed->unpack(options.threads));
  };
  if (!mesh_is_planned(o, p, options, size, most_elements, run, unpack))
    unpack();
  return grid ? std::move(*grid) : BlockGrid();
}

/// How a mesh is improved.
struct Improvement {
  int iterations;
  optimize::Effort effort;
  int threads;
};

/// tetsmooth: as above. grid: none without a density.
inline bool improvement_is_planned(const cli::Common& o, const cli::PlanOptions& p, const TetMesh& mesh,
                                   const BlockGrid* grid, const Improvement& how, const cli::Run& run) {
  const int64_t elements = std::ssize(mesh.tet);
  optimize::Work work{elements, std::ssize(mesh.tri)};
  if (p.plan) {
    work.low = optimize::count_low(mesh, how.threads);
    work.across = optimize::count_across(mesh, how.threads);
  }
  work.blocks = grid ? std::ssize(grid->corner) : 0;
  work.iterations = how.iterations;
  work.effort = how.effort;
  work.threads = how.threads;
  const optimize::Plan plan = optimize::plan(work);
  if (p.plan) {
    cli::Value v;
    v["elements_before"] = elements;
    add_improvement(v, plan, p.speeds().tetsmooth);
    cli::write_plan(o, p, run, v);
    return true;
  }
  const int64_t limit = p.memory_limit();
  char times[80];
  std::snprintf(times, sizeof times, "a mesh of %.2g million elements fits",
                limit > 0 ? 0.9e-6 * double(limit) / double(plan.memory) * double(elements) : 0);
  cli::require_memory(p, plan.memory, std::to_string(elements) + " elements", times);
  return false;
}

} // namespace molmesh::plans
