// optimize.cpp — the order of passes: settle on the surface, raise the goal by steps, release the guard at the very
// end.
#include "optimize/optimize.hpp"
#include "base/error.hpp"
#include "isosurface/reference_surface.hpp"
#include "optimize/schedule/schedule.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace molmesh::optimize {
namespace {

// Of the labels that are curved; of all where none is: nothing is bound to these then, but they have a size.
std::vector<uint8_t> curved_triangles(const DynamicMesh& m, const TetMesh& mesh) {
  if (std::none_of(m.labels.begin() + 1, m.labels.end(), [](const Label& l) { return l.curved(); }))
    return std::vector<uint8_t>(mesh.tri.size(), 1);
  std::vector<uint8_t> take(mesh.tri.size());
  for (size_t t = 0; t < mesh.tri.size(); ++t)
    for (const Label& l : m.labels)
      if (l.name == mesh.boundary[t] && l.curved())
        take[t] = 1;
  return take;
}

// The goal rises by steps: what is far below it gets room before its neighbors ask for it. The guard is released
// late, when few elements are left; where the surface has features far smaller than the grid, points may leave it
// at the very end. Recovery brings them back to the isosurface; to a surface that came in nothing does.
const Guard kept, released{Guard::widest_unbent, 0.24, 1, 0}, lifted{180, 1e3, 1, 0.15},
    hardly_lifted{80, 0.24, 1, 0.15, 0.02};
struct Stage {
  double share; // of the goal's sine
  int effort;
  double cell;
  bool worst_first;
  const Guard& guard;
  double least_step = finest_step; // where many elements are below the goal
};
const Stage stages[] = {
    {0.35, 0, 1, true, kept, 0.1}, {0.6, 0, 1, true, kept, 0.1}, {0.8, 1, 1, true, kept, 0.1},
    {0.9, 1, 2, true, kept, 0.1},  {1, 1, 2, false, kept, 0.03}, {1, 1, 8, true, kept},
    {0.8, 1, 8, true, released},   {1, 1, 8, false, released},   {0.5, 1, 32, true, lifted},
    {1, 1, 32, true, released},    {0.97, 1, 32, true, lifted},  {1, 1, 32, false, released},
    {0.97, 1, 32, true, lifted},
};
constexpr size_t refresh_offset = 4;
// Where that many elements are below the goal the first rounds take them in the mesh's order and search for places
// by coarse steps alone: the rounds after find what is left to finer ones. Not without a density, where the surface
// that came in hardly gives way: TetGen's mesh of 1TII came to 14.9 degrees, not 17.3.
constexpr int64_t many_elements = 16384;
// From this round on elements longer than parts, as a far box has, are worked on too, on one thread: they are few.
constexpr size_t lattice_outgrown = 8;
// What settling and straightening spoil takes this many rounds to heal: with fewer they may spoil nothing.
constexpr int rounds_to_heal = 8;
// Where two cells a part leave fewer than this, first passes take one: a single part would be one thread's work.
constexpr int64_t fewest_parts = 8;

// The surface is made to fit in the first rounds, while elements may still be bad: what stands on it is healed
// later, but a bent triangle between good elements has nowhere to go.
constexpr size_t straighten_first = 1, straighten_last = 4;
constexpr double straighten_share = 0.1;
const Guard straight{40, 0.24, 0.5, 0};

// Points off the isosurface come back where that can be mended; every repetition has other parts, and none of them
// where none is left. Efforts begin anew after each that brings one back, and a large mesh has many of these.
// Of many points the first ones bring most back, in smaller parts: more of these at once, and less to put by for
// each.
constexpr int recoveries = 32, recoveries_of_many = 4;
// What is tried, one after the other while nothing comes back.
struct Attempt {
  int effort; // Pass::effort
  const Guard& guard = released;
  double cell = 0.5;
  float at_first = 1; // Pass::at_first
};
const Guard widened{70, 0.24, 1, 0};
const Attempt via_70{5, widened, 1, 0.7F}, via_50{5, widened, 1, 0.5F}, wider_3{3, widened, 1},
    wider_5{5, widened, 1};
// Last by way of a lower goal.
const std::vector<Attempt> attempts{{1}, {2}, {3}, {4}, {4, widened}, {5}, via_70, via_50};
// Where the mesh ends in the surface, which then must not bend as it likes, a wider guard comes last, in larger
// parts, either order of the worst for both efforts; before that points come back by way of a lower goal.
const std::vector<Attempt> attempts_at_end{{1},    {2}, {3},     {4},     via_70,  via_70, via_50,
                                           via_50, {5}, wider_3, wider_5, wider_5, wider_3};

Pass pass_of(const Attempt& attempt, float goal) {
  Pass pass;
  pass.goal = goal;
  pass.effort = attempt.effort;
  pass.cell = attempt.cell;
  pass.guard = attempt.guard;
  pass.at_first = attempt.at_first;
  return pass;
}

float goal_of(const Options& o) {
  return static_cast<float>(std::max(angle_quality(std::min(o.min_dihedral, Options::most_min_dihedral)),
                                     angle_quality(std::max(o.max_dihedral, Options::least_max_dihedral))));
}

// Of the last elements below the goal.
const std::vector<Attempt> healing{{2}, {5}, {5, released, 1}, {5, widened, 1}};

} // namespace

Result improve(TetMesh& mesh, const BlockGrid* density, const Options& options,
               const std::function<void(const std::string&)>& phase, const FlowPass& flow) {
  const auto begin = [&](const char* name) {
    if (phase)
      phase(name);
  };
  Result result;
  begin("adjacency");
  auto work = std::make_shared<DynamicMesh>(build(mesh, density ? 180 : options.sharp, options.threads));
  DynamicMesh& m = *work;
  result.before = result.after = measure_angles(m, options.threads);
  if (options.iterations == 0 || mesh.tet.empty())
    return result;

  begin("target");
  std::unique_ptr<Isosurface> isosurface;
  std::unique_ptr<Target> input_surface;
  if (density)
    isosurface = std::make_unique<Isosurface>(*density, options.threads);
  else
    input_surface = std::make_unique<ReferenceSurface>(mesh, curved_triangles(m, mesh));
  if (density && runs_against(m, *isosurface, options.threads))
    fail_input("most of the surface runs against the isosurface, expected the lower region's inside in its own");
  const Target* target = density ? static_cast<const Target*>(isosurface.get()) : input_surface.get();
  const double h = target->spacing(), edge = mean_surface_edge(m, options.threads); // 4 h and more in merged cells
  Schedule schedule(m, target, std::clamp(21 * edge, 32 * h, 256 * h), options.threads);
  const float goal = goal_of(options);
  // For better elements than by default no point leaves the isosurface.
  const float usual = std::min(goal, goal_of({}));

  const auto settle = [&](float floor) {
    result.counts += schedule.settle(floor, kept);
    isosurface->set_offset(isosurface->offset() + chord_offset(m, *isosurface, options.threads));
    result.counts += schedule.settle(floor, kept);
  };

  begin("improve");
  const float at_first = schedule.worst();
  // Angles count, where needles would let them fall further.
  const float no_worse = std::min(
      goal, static_cast<float>(std::min(angle_quality(result.before.min), angle_quality(result.before.max))));
  const bool heals = options.iterations >= rounds_to_heal;
  const bool small = schedule.parts_at_surface(2) < fewest_parts;
  const bool many = density && schedule.below(goal) >= many_elements;
  double cell_of_all = 0;
  for (int round = 0; round < options.iterations && schedule.worst() < goal; ++round) {
    const Stage& stage = stages[std::min<size_t>(size_t(round), std::size(stages) - 1)];
    Pass pass;
    const auto rising = static_cast<float>(stage.share * stage.share * (stage.guard.lift > 0 ? usual : goal));
    pass.goal = rising;
    pass.effort = stage.effort;
    pass.cell = stage.cell;
    pass.worst_first = stage.worst_first;
    pass.least_step = many ? stage.least_step : finest_step;
    pass.in_mesh_order = pass.least_step > finest_step;
    pass.guard = density || stage.guard.lift == 0 ? stage.guard : hardly_lifted;
    pass.yield = round == 0 ? 0.25f : 1.f; // clusters far smaller than the grid have to go as a whole
    if (stage.guard.lift > 0)
      schedule.find_crowded(Schedule::everywhere);
    int64_t done = 0;
    if (flow) {
      done = flow(m, isosurface.get(), pass);
      result.counts.moves += done;
    }
    if (size_t(round) == lattice_outgrown)
      cell_of_all = schedule.cell_of_all(stage.cell);
    for (const double cell : {small ? std::min(stage.cell, 1.) : stage.cell, stage.cell, cell_of_all}) {
      if (cell == 0)
        continue;
      pass.cell = cell;
      const Counts c = schedule.run(pass);
      result.counts += c;
      done += c.total();
    }
    if (density && heals && size_t(round) >= straighten_first && size_t(round) <= straighten_last) {
      pass.goal = static_cast<float>(straighten_share * straighten_share * goal);
      pass.guard = straight;
      result.counts += schedule.straighten(pass);
    }
    ++result.rounds;
    if (density && round == 0) { // not before: what is squeezed between surface and grid is gone now
      settle(heals ? 1 : no_worse);
      schedule.find_crowded(Schedule::guarded); // nearer to the target, fewer are
    }
    if (density) {
      if (size_t(round) + 1 == refresh_offset)
        isosurface->set_offset(isosurface->offset() + chord_offset(m, *isosurface, options.threads));
      const float floor = size_t(round) < refresh_offset ? rising : goal;
      result.counts += schedule.settle(heals ? floor : std::max(floor, no_worse), kept);
    }
    if (done == 0 && size_t(round) + 1 >= std::size(stages))
      break;
  }
  if (density && result.rounds == 0) // good enough as it came, and to stay so
    settle(std::min(goal, at_first));
  const std::vector<Attempt>& all = schedule.ends_in_surface() ? attempts_at_end : attempts;
  size_t idle = 0;
  for (int repeat = 0; density && repeat < recoveries && idle < all.size(); ++repeat) {
    const Attempt& attempt = all[idle];
    Pass pass = pass_of(attempt, usual);
    pass.worst_first = repeat % 2 == 0;
    if (many && repeat < recoveries_of_many) // what goes wrong is taken back: parts are small
      pass.cell = 0.35;
    const Counts c = schedule.recover(pass);
    idle = c.total() > 0 ? std::min<size_t>(idle, 1) : idle + 1;
    result.counts += c;
  }
  for (int repeat = 0; density && goal > usual && repeat < 4; ++repeat) { // recovery has mended to the usual goal
    Pass pass = pass_of({1, released, 8}, goal);
    pass.worst_first = repeat % 2 == 0;
    const Counts c = schedule.run(pass);
    result.counts += c;
    if (c.total() == 0)
      break;
  }
  if (heals)
    for (const Attempt& attempt : healing)
      result.counts += schedule.heal(pass_of(attempt, goal));
  if (result.counts.total() == 0 || schedule.worst() < at_first) { // the file that came in, in its own order
    result.in_vain = result.counts.total() > 0;
    result.counts = {};
    m = DynamicMesh(); // two at a time are too much memory
    if (density)
      result.fidelity = measure_fidelity(build(mesh, 180, options.threads), *isosurface, options.threads);
    return result;
  }
  begin("result");
  mesh = extract(m, options.threads, &result.across, std::move(mesh));
  result.rest = [work = std::move(work), surface = std::shared_ptr<Isosurface>(std::move(isosurface)),
                 threads = options.threads](Result& r) {
    r.after = measure_angles(*work, threads);
    if (surface)
      r.fidelity = measure_fidelity(*work, *surface, threads);
  };
  if (!options.measure_later)
    result.measure();
  return result;
}

} // namespace molmesh::optimize
