// optimize.cpp — the tables of rounds and searches, and the loops over them.
#include "optimize/optimize.hpp"
#include "base/error.hpp"
#include "base/give_back_memory.hpp"
#include "isosurface/reference_surface.hpp"
#include "optimize/acceptance/faults.hpp"
#include "optimize/mesh/target_size.hpp"
#include "optimize/schedule/schedule.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace molmesh::optimize {
namespace {

// Triangles with curved labels, or all triangles if no label is curved: nothing is bound to these then, but they
// have a size.
std::vector<uint8_t> curved_triangles(const DynamicMesh& m, const TetMesh& mesh) {
  if (std::none_of(m.labels.begin() + 1, m.labels.end(), [](const Label& l) { return l.curved(); }))
    return std::vector<uint8_t>(mesh.tri.size(), 1);
  std::vector<uint8_t> take(mesh.tri.size());
  for (size_t t = 0; t < mesh.tri.size(); ++t)
    for (const Label& l : m.labels)
      if (l.name == mesh.boundary[t] && l.curved() && !l.target)
        take[t] = 1;
  return take;
}

// Interfaces of a mesh with domains get targets of their own, which the result keeps alive.
std::vector<std::shared_ptr<const Target>> set_interface_targets(DynamicMesh& m, const TetMesh& mesh,
                                                                 const Options& options) {
  std::vector<std::shared_ptr<const Target>> targets;
  for (size_t l = 1; l < m.labels.size() && m.order.last_domain > molmesh::Region::cavity; ++l) {
    Label& label = m.labels[l];
    if (!label.curved() || label.name <= Boundary::box_z1)
      continue;
    const auto given = options.interfaces.find(label.name);
    if (given != options.interfaces.end()) {
      targets.push_back(given->second);
    } else {
      std::vector<uint8_t> take(mesh.tri.size());
      for (size_t t = 0; t < take.size(); ++t)
        take[t] = mesh.boundary[t] == label.name;
      targets.push_back(std::make_shared<ReferenceSurface>(mesh, take));
    }
    label.target = targets.back().get();
  }
  return targets;
}

// The goal rises by steps: what is far below it gets room before its neighbors ask for it. The guard is relaxed
// late, when few elements are left; where the surface has features far smaller than the grid, points may leave it
// at the very end. Searches bring them back to the isosurface; to a surface that came in nothing does.
const Guard strict, relaxed{Guard::widest_unbent, 0.24, 1, 0}, may_leave_surface{180, 1e3, 1, 0.15},
    may_leave_slightly{80, 0.24, 1, 0.15, 0.02}, within_a_tenth{180, 1e3, 1, 0.1, 0.1}, bent{70, 0.24, 1, 0};

struct Round {
  double goal_share; // of the goal's sine
  bool merges_and_splits;
  double cell; // of the schedule
  bool worst_first;
  const Guard& guard;
  double least_step = finest_step; // where many elements are below the goal; a coarser one: not thorough
  bool fits_surface = false;       // bent triangles are made to fit after it
};
// The surface is made to fit while elements may still be bad: what stands on it is repaired later, but a bent
// triangle between good elements has nowhere to go. Merges and splits come when few elements are left: they
// cost most, and less than one in thirty helps. The last round is repeated.
const std::vector<Round> rounds_to_good{
    {0.35, false, 1, true, strict, 0.1},
    {0.6, false, 1, true, strict, 0.1, true},
    {0.8, false, 1, true, strict, 0.1, true},
    {0.9, false, 2, true, strict, 0.1, true},
    {1, false, 2, false, strict, 0.03, true},
    {1, true, 8, true, strict},
    {0.8, true, 8, true, relaxed},
    {1, true, 8, false, relaxed},
    {0.5, true, 32, true, may_leave_surface},
    {1, true, 32, true, relaxed},
    {0.97, true, 32, true, may_leave_surface},
    {1, true, 32, false, relaxed},
    {0.97, true, 32, true, may_leave_surface},
};
// To 15° and 155°, which is not much more than density2tet's elements have.
const std::vector<Round> rounds_to_fair{
    {1, false, 1, true, strict, 0.1}, {1, true, 1, true, strict, 0.1, true}, {1, true, 2, true, relaxed, 0.1, true},
    {1, true, 8, true, relaxed},      {1, true, 8, false, within_a_tenth},   {1, true, 32, true, within_a_tenth},
};

// Where few elements are left below the promise, as beside features that a wall cuts. Then they are searched for.
const std::vector<Round> rounds_to_promise{{1, true, 32, true, may_leave_surface},
                                           {1, true, 32, false, may_leave_surface}};

// How an effort keeps its promise.
struct Course {
  double min_dihedral, max_dihedral; // degrees aimed at, more than is promised
  const std::vector<Round>& rounds;
  size_t rounds_to_coarsening;  // before it
  size_t rounds_to_offset;      // after this one points are put further out, for what chords enclose less
  size_t most_elements;         // below the goal that are searched for; 0: none but for the promise, and no points
  double last_min_dihedral = 0; // where many are searched for: of a last search for those that miss the promise
};
const Course to_fair{16.5, 154.4, rounds_to_fair, 2, 1, 0}, to_good{26, 138.5, rounds_to_good, 4, 4, 64},
    to_best{30.65, 129.4, rounds_to_good, 4, 4, 1024, 29.4};

const Course& course_of(Effort effort) {
  return effort == Effort::fast ? to_fair : effort == Effort::good ? to_good : to_best;
}

// Where that many elements are below the goal the first rounds take them in the mesh's order and search for places
// by coarse steps alone: the rounds after find what is left to finer ones. Not without a density, where the surface
// that came in hardly gives way: TetGen's mesh of 1TII came to 14.9 degrees, not 17.3.
constexpr int64_t many_elements = 16384;
// From this round on elements longer than parts, as a far box has, are worked on too, on one thread: they are few.
constexpr size_t lattice_outgrown = 8;
// Where two cells a part leave fewer than this, first passes take one: a single part would be one thread's work.
constexpr int64_t fewest_parts = 8;
// Below the goal, where the promise is missed.
constexpr size_t few_elements = 64;

// Time is bounded by a multiple of the elements, whatever the mesh. A look takes about ten nanoseconds. Most
// meshes need less than half of these, and a pressed plate of cubes, which can be repaired, four fifths.
constexpr int64_t looks_at_element = 6'000, looks_at_some = 25'000, looks_for_points = 20'000;
// Operations that are done earn looks, so many of them: most meshes need one an element at most, but in a plate
// that is far thinner than its elements are long there is always one more to do.
constexpr int64_t earn_at_element = 4, earn_at_some = 2'000;

constexpr double fitting_share = 0.1; // of the goal's sine
const Guard fitting{40, 0.24, 0.5, 0};

// Coarsening: elements may fall to this share of the goal's sine, sizes on the surface are those of triangles that
// are off by so many spacings (the guard keeps them nearer), and after some times little is left to remove.
constexpr double coarsening_share = 0.5, coarsening_tolerance = 0.2;
constexpr int coarsenings = 3, wide_searches = 3;
constexpr double wider = 8; // are the cubes of these
const Guard coarse{32, 0.1, 0.5, 0};

// Points off the isosurface come back where elements can be repaired after. Rows are tried in turn while nothing
// comes back, each time in other parts, and none of them where no point is left. After a point has come back, all
// but the first begin anew, and a large mesh has many of these.
constexpr int searches = 32;
constexpr double share_of_rounds = 0.7; // of the time, where points are off; searches take the rest
// Of many points the first searches bring most back, in smaller parts: more of these at once, and less to save for
// each.
constexpr int searches_of_many = 4;
constexpr double size_of_many = 0.35;

using enum Moves;
constexpr Scope of_points = Scope::points, of_elements = Scope::elements;
const Strategy first{of_points, bold, relaxed}, climb{of_points, necks, relaxed, 0.5, 1, 300},
    walk{of_points, bending, relaxed, 0.5, 1, 2000, 3000}, via_70{of_points, bending, bent, 1, 0.7F, 2000, 3000},
    via_50{of_points, bending, bent, 1, 0.5F, 2000, 3000};
// A surface that may bend soon gives way. A wider guard brings back what is left, and last a lower goal.
const std::vector<Strategy> for_points{first,
                                       {of_points, bending, relaxed, 0.5, 1, 300},
                                       {of_points, bending, bent, 0.5, 1, 300},
                                       {of_points, bending, bent, 0.5, 1, 2000},
                                       walk,
                                       via_70,
                                       via_50};
// Where the mesh ends in the surface, which then must not bend as it likes, a wider guard comes last, in larger
// parts, either measure of the deficit first for both; before that points come back by way of a lower goal.
const Strategy wide_climb{of_points, necks, bent, 1, 1, 300}, wide_walk{of_points, bending, bent, 1, 1, 2000, 3000};
const std::vector<Strategy> for_points_at_end{first,     climb,     {of_points, bending, relaxed, 0.5, 1, 2000},
                                              via_70,    via_70,    via_50,
                                              via_50,    walk,      wide_climb,
                                              wide_walk, wide_walk, wide_climb};
// For the last elements below the goal.
const Strategy quick{of_elements, bold, relaxed, 0.5, 1, 300},
    longer{of_elements, bold, relaxed, 0.5, 1, 300, 1000};
const std::vector<Strategy> for_elements{
    quick, longer, {of_elements, bold, relaxed, 1, 1, 300, 1000}, {of_elements, bold, bent, 1, 1, 300, 1000}};
// Many of them, most of which are above the promise, are not worth the last two rows, which take most of the time.
// Those that miss it are searched for in larger parts too, where elements give way that are above it.
const std::vector<Strategy> for_many_elements{quick, longer},
    for_promise{quick, longer, {of_elements, bold, relaxed, 1, 1, 300}};

float goal_of(double min_dihedral, double max_dihedral) {
  return static_cast<float>(std::max(angle_quality(min_dihedral), angle_quality(max_dihedral)));
}

float goal_of(const Course& c) {
  return goal_of(c.min_dihedral, c.max_dihedral);
}

float goal_of(const Options& o) {
  return std::max(goal_of(course_of(o.effort)), goal_of(std::min(o.min_dihedral, Options::most_min_dihedral),
                                                        std::max(o.max_dihedral, Options::least_max_dihedral)));
}

float share_of(double share, float goal) {
  return static_cast<float>(share * share * goal);
}

/// The tables applied to one mesh.
class Improvement {
public:
  /// has_interfaces: with targets of their own.
  Improvement(DynamicMesh& m, const Target& target, Isosurface* isosurface, bool has_interfaces,
              const Options& options, Result& result)
      : m_(m), target_(target), isosurface_(isosurface), options_(options), course_(course_of(options.effort)),
        result_(result),
        // Edges of four spacings and more are those of merged cells.
        schedule_(
            m, &target,
            std::clamp(21 * mean_surface_edge(m, options.threads), 32 * target.spacing(), 256 * target.spacing()),
            options.threads, !isosurface && !has_interfaces),
        goal_(goal_of(options)), usual_(std::min(goal_, goal_of(to_good))), at_first_(schedule_.worst()),
        // Angles count, where needles would let them fall further.
        no_worse_(std::min(goal_, static_cast<float>(std::min(angle_quality(result.before.min),
                                                              angle_quality(result.before.max))))),
        repairs_(options.iterations >= std::ssize(course_.rounds)),
        small_(schedule_.parts_at_surface(2) < fewest_parts),
        many_(isosurface && schedule_.below(goal_) >= many_elements) {
    schedule_.allow(looks_at_some + looks_at_element * elements_);
    schedule_.let_earn(earn_at_some + earn_at_element * elements_);
  }

  /// False where nothing is better than it came. A flow knows one target.
  bool run(const FlowPass& flow) {
    if (options_.coarsen) {
      run_rounds(flow, 0, course_.rounds_to_coarsening);
      coarsen();
      run_rounds(flow, course_.rounds_to_coarsening);
    } else {
      run_rounds(flow);
    }
    search();
    if (options_.coarsen) {
      search_widely();
      put_further_out();
    }
    return result_.counts.total() > 0 && !is_worse();
  }

private:
  /// Vertices go in the middle of the rounds: elements are good enough then to give way, and rounds repair what is
  /// left. With fewer rounds than all no element falls under the goal.
  void coarsen() {
    Pass pass = pass_of({repairs_ ? coarsening_share : 1, false, 2, true, coarse});
    const Pass repair = pass_of({0.8, false, 2, true, strict, 0.1});
    for (int k = 0; k < coarsenings; ++k) {
      const std::vector<float> size =
          target_sizes(m_, &target_, coarsening_tolerance * target_.spacing(), options_.threads);
      int64_t removed = 0;
      for (int shift = 0; shift < 2; ++shift)
        removed += count(schedule_.coarsen(pass, size));
      result_.removed += removed;
      count(schedule_.run(repair));
      if (removed == 0)
        break;
    }
    if (isosurface_) {
      offset_points();
      count(schedule_.project(at_least(share_of(0.5, usual_)), strict));
    }
  }

  /// Coarse triangles enclose less: their points are put further out than those of fine ones.
  void put_further_out() {
    for (int k = 0; isosurface_ && k < 2; ++k) {
      isosurface_->set_offset(isosurface_->offset() +
                              chord_offset(m_, *isosurface_, options_.threads, most_coarse_offset));
      count(schedule_.project(at_least(FaultCount::share * usual_), strict));
    }
  }

  /// Far from the surface coarse elements are long: what searches look at is too small for them.
  void search_widely() {
    for (int k = 0; repairs_ && k < wide_searches && schedule_.worst() < FaultCount::share * goal_; ++k)
      search_elements(for_elements, course_.most_elements, goal_, wider);
  }

  void run_rounds(const FlowPass& flow, size_t from = 0, size_t to = SIZE_MAX) {
    double cell_of_all = 0;
    tell_progress();
    for (size_t k = from; k < std::min(size_t(options_.iterations), to) && schedule_.worst() < goal_; ++k) {
      const Round& round = course_.rounds[std::min(k, course_.rounds.size() - 1)];
      Pass pass = pass_of(round);
      // No other follows that would aim higher.
      if (!repairs_ && k + 1 == size_t(options_.iterations) && round.guard.lift == 0) {
        pass.goal = goal_;
        pass.merges_and_splits = true;
      }
      // Clusters far smaller than the grid have to go as a whole.
      pass.tiny_share = k == 0 && repairs_ ? 0.25f : 1.f;
      const float goal = pass.goal;
      if (round.guard.lift > 0)
        schedule_.watch_crossings(Schedule::everywhere);
      int64_t done = flow ? flow(m_, isosurface_, pass) : 0;
      result_.counts.moves += done;
      if (k == lattice_outgrown)
        cell_of_all = schedule_.cell_of_all(round.cell);
      for (const double cell : {small_ ? std::min(round.cell, 1.) : round.cell, round.cell, cell_of_all})
        if (cell > 0) {
          pass.cell = cell;
          done += count(schedule_.run(pass));
          tell_progress();
        }
      if (isosurface_ && repairs_ && round.fits_surface) {
        pass.goal = share_of(fitting_share, goal_);
        pass.guard = fitting;
        count(schedule_.fit_surface(pass));
      }
      ++result_.rounds;
      if (isosurface_)
        project_after(k, goal);
      if (done == 0 && k + 1 >= course_.rounds.size())
        break;
    }
    if (isosurface_ && from == 0 && result_.rounds == 0) // good enough as it came, and to stay so
      project_with_offset(std::min(goal_, at_first_));
  }

  // Where the rounds have done all they can.
  void search() {
    if (course_.most_elements == 0)
      return keep_promise();
    if (!(repairs_ || schedule_.worst() >= goal_))
      return;
    if (isosurface_) {
      schedule_.allow(looks_for_points * elements_);
      search_points();
    }
    if (course_.last_min_dihedral == 0)
      return search_elements(for_elements, course_.most_elements, goal_);
    search_elements(for_many_elements, course_.most_elements, goal_);
    search_elements(for_promise, course_.most_elements,
                    static_cast<float>(angle_quality(course_.last_min_dihedral)));
  }

  // But for rounding: what is put on the isosurface may lose a millionth. What is coarsened may lose what is better
  // than promised.
  bool is_worse() {
    const float least = options_.coarsen ? std::min(at_first_, FaultCount::share * goal_) : at_first_;
    return schedule_.worst() < (repairs_ ? least : 0.9999f * least);
  }

  bool is_promise_kept() { return !repairs_ || schedule_.worst() >= FaultCount::share * goal_; }
  // Few meshes need it.
  void keep_promise() {
    for (const Round& round : rounds_to_promise)
      if (!is_promise_kept()) {
        schedule_.watch_crossings(Schedule::everywhere);
        count(schedule_.run(pass_of(round)));
      }
    if (!is_promise_kept())
      search_elements(for_elements, few_elements, goal_);
  }

  /// A floor for projection: with fewer rounds than all nothing repairs what falls to it.
  float at_least(float floor) const { return repairs_ ? floor : std::max(floor, no_worse_); }

  void search_points() {
    const std::vector<Strategy>& rows = schedule_.ends_in_surface() ? for_points_at_end : for_points;
    size_t row = 0;
    for (int k = 0; k < searches && row < rows.size(); ++k) {
      Strategy s = rows[row];
      s.goal = usual_;
      s.worst_first = k % 2 == 0;
      if (many_ && k < searches_of_many) // what goes wrong is taken back: parts are small
        s.part_size = size_of_many;
      row = count(schedule_.search(s)) > 0 ? std::min<size_t>(row, 1) : row + 1;
      if (options_.progress)
        options_.progress(share_of_rounds + (1 - share_of_rounds) *
                                                std::max(double(row) / double(rows.size()), double(k) / searches));
    }
    for (int k = 0; goal_ > usual_ && k < 4; ++k) { // searches have repaired to the usual goal
      Pass pass = pass_of({1, true, 8, k % 2 == 0, relaxed});
      if (count(schedule_.run(pass)) == 0)
        break;
    }
  }

  /// In parts so many times as large as the rows'.
  void search_elements(const std::vector<Strategy>& rows, size_t most, float goal, double larger = 1) {
    for (Strategy s : rows) {
      s.part_size *= larger;
      s.goal = goal;
      s.most_elements = most;
      count(schedule_.search(s));
    }
  }

  void tell_progress() {
    if (!options_.progress)
      return;
    const int64_t left = schedule_.below(goal_);
    at_begin_ = std::max({at_begin_, left, int64_t{1}});
    options_.progress(share_of_rounds * (1 - double(left) / double(at_begin_)));
  }

  int64_t count(const Counts& c) {
    result_.counts += c;
    result_.looks = schedule_.looks().done;
    return c.total();
  }

  Pass pass_of(const Round& round) const {
    Pass pass;
    // For better elements than by default no point leaves the isosurface.
    pass.goal = share_of(round.goal_share, round.guard.lift > 0 ? usual_ : goal_);
    pass.merges_and_splits = round.merges_and_splits;
    pass.cell = round.cell;
    pass.worst_first = round.worst_first;
    pass.least_step = many_ ? round.least_step : finest_step;
    pass.thorough = round.least_step == finest_step;
    pass.in_mesh_order = pass.least_step > finest_step;
    pass.guard = isosurface_ || round.guard.lift == 0 ? round.guard : may_leave_slightly;
    return pass;
  }

  void offset_points() {
    isosurface_->set_offset(isosurface_->offset() + chord_offset(m_, *isosurface_, options_.threads));
  }

  void project_with_offset(float floor) {
    count(schedule_.project(floor, strict));
    offset_points();
    count(schedule_.project(floor, strict));
  }

  void project_after(size_t round, float goal) {
    if (round == 0) { // not before: what is squeezed between surface and grid is gone now
      project_with_offset(repairs_ ? 1 : no_worse_);
      schedule_.watch_crossings(Schedule::guarded); // nearer to the target, fewer are
    } else if (round + 1 == course_.rounds_to_offset)
      offset_points();
    const float floor = round < course_.rounds_to_offset ? goal : goal_;
    count(schedule_.project(at_least(floor), strict));
  }

  DynamicMesh& m_;
  const Target& target_;
  Isosurface* const isosurface_;
  const Options& options_;
  const Course& course_;
  Result& result_;
  Schedule schedule_;
  const float goal_, usual_, at_first_, no_worse_;
  const bool repairs_; ///< all rounds: what projection and fitting spoil is repaired. With fewer they spoil nothing
  const bool small_, many_;
  const int64_t elements_ = std::ssize(m_.element);
  int64_t at_begin_ = 0; ///< elements below the goal
};

} // namespace

Result improve(TetMesh& mesh, const BlockGrid* density, const Options& options,
               const std::function<void(const std::string&)>& phase, const FlowPass& flow) {
  const auto begin = [&](const char* name) {
    if (phase)
      phase(name);
  };
  Result result;
  begin("adjacency");
  DynamicMesh m = build(mesh, density ? 180 : options.sharp, options.threads);
  result.before = result.after = measure_angles(m, options.threads);
  if (options.iterations == 0 || mesh.tet.empty())
    return result;

  begin("target");
  auto interfaces = set_interface_targets(m, mesh, options);
  std::unique_ptr<Isosurface> isosurface;
  std::unique_ptr<Target> input_surface;
  if (density)
    isosurface = std::make_unique<Isosurface>(*density, options.threads);
  else
    input_surface = std::make_unique<ReferenceSurface>(mesh, curved_triangles(m, mesh));
  if (density && runs_against(m, *isosurface, options.threads))
    fail_input("most of the surface runs against the isosurface, expected the lower region's inside in its own");
  const Target& target = density ? static_cast<const Target&>(*isosurface) : *input_surface;

  begin("improve");
  const bool divided = !interfaces.empty();
  if (!Improvement(m, target, isosurface.get(), divided, options, result).run(divided ? FlowPass{} : flow)) {
    // the file that came in, in its own order
    result.rejected = result.counts.total() > 0;
    result.counts = {};
    m = DynamicMesh(); // two at a time are too much memory
    if (density) {
      m = build(mesh, 180, options.threads);
      interfaces = set_interface_targets(m, mesh, options);
      result.fidelity = measure_fidelity(m, *isosurface, options.threads);
    }
    return result;
  }
  give_back_memory(); // of parts and their tables
  begin("result");
  result.after = measure_angles(m, options.threads);
  if (isosurface)
    result.fidelity = measure_fidelity(m, *isosurface, options.threads);
  mesh = extract(std::move(m), options.threads, result.across, std::move(mesh));
  return result;
}

} // namespace molmesh::optimize
