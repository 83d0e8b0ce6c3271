// schedule.hpp — passes over the bad elements, part by part.
#pragma once
#include "optimize/operations/region.hpp"
#include "optimize/schedule/pass.hpp"
#include "optimize/search/failed_searches.hpp"
#include <algorithm>
#include <cstdint>
#include <functional>
#include <future>
#include <vector>

namespace molmesh::optimize {

/// How many slots a part reserves for new elements, and which parts are worked on first.
struct PartShares {
  double slots_per_item = 2;
  size_t slots = 64;                               ///< and so many more
  std::function<size_t(int32_t part)> weight = {}; ///< the largest comes first; none: the number of items
};

/// Runs passes over a mesh that lives as long as it.
class Schedule {
public:
  /// is_target: the target is the mesh's own surface, as it is now.
  Schedule(DynamicMesh& mesh, const Target* target, double cell, int threads, bool is_target = false);
  /// Every part works off its elements below the goal, worst first. Parts are the cells of a coarse lattice,
  /// shifted from pass to pass: what lies across two parts now lies inside one the next time.
  Counts run(const Pass& pass);
  /// Makes surface triangles that do not keep the guard, and surface vertices off the target, fit where no element
  /// falls under the goal.
  Counts fit_surface(const Pass& pass);
  /// Removes vertices where no new edge is much longer than the sizes at its ends and no element falls under the
  /// goal. size [vertices]: target_sizes().
  Counts coarsen(const Pass& pass, const std::vector<float>& size);
  /// Searches in parts around the few places that the strategy is for. Nothing else changes.
  Counts search(const Strategy& strategy);
  /// Puts surface vertices on the target where no element falls under `floor`; floor ≥ 1 means: an element may lose
  /// at most half its quality.
  Counts project(float floor, const Guard& guard);
  /// Where the mesh ends in a curved surface, operations keep it from crossing itself: near triangles that face
  /// each other within `apart` spacings, beside what they are off the target; or everywhere, from now on.
  /// Everywhere where a wall cuts the surface: on a trace a triangle may leave its place by more.
  void watch_crossings(double apart, bool is_target = false);
  static constexpr double everywhere = 1e300;
  /// Each triangle stays within a quarter of a spacing (Guard::distance), or what it is off.
  static constexpr double guarded = 0.5;
  /// So many looks more, of which each pass takes a share of those left at most. Without, all that passes want.
  void allow(int64_t looks) { looks_.allowed = looks_.done + looks; }
  /// So many operations earn looks for others. Without, all that are done.
  void let_earn(int64_t operations) { looks_.may_earn = operations; }
  const Looks& looks() const { return looks_; }
  bool ends_in_surface() const { return ends_in_surface_; }
  float worst();
  /// How many parts of that size, in the schedule's cells, hold a point of the surface.
  int64_t parts_at_surface(double cell);
  int64_t below(float goal) const;
  /// Size of parts, in the schedule's cells, so large that one nearly always holds the whole mesh; 0 where no edge
  /// is longer than a quarter of a part of size `cell`, which will do then.
  double cell_of_all(double cell) const;

private:
  std::vector<int32_t> surface_points() const; ///< those on traces too; ascending
  std::vector<int32_t> points_off() const;     ///< of these, off the target
  bool is_hopeless(size_t points_off) const;
  std::vector<int32_t> places_to_search(const Strategy& s);
  using Work = std::function<void(Region&, std::vector<int32_t>&)>;
  /// The element is below the goal, and has changed since it was last tried.
  bool worthwhile(int32_t element, float goal) const;
  /// Worthwhile elements; tried_too: all below the goal.
  std::vector<int32_t> low_elements(float goal, bool tried_too = false);
  bool in_few_parts(const std::vector<int32_t>& items, int shift, double cell);
  Counts work_off(const std::vector<int32_t>& items, const Pass& pass, int shift, double cell);
  Counts for_parts(const std::vector<int32_t>& items, const std::vector<int32_t>& part_of_item, const Work& work,
                   const PartShares& shares = {});
  PointBox bounds() const;
  void find_worst(); ///< DynamicMesh::worst of the dirty chunks
  void set_lattice(int shift, double cell, const PointBox& box);
  void set_parts(int shift, double cell); ///< its cells
  /// A cube of about that size around each of the points, of which there are some, where there is room for it
  /// beside the others' cubes.
  void set_parts_around(const std::vector<int32_t>& points, int shift, double size);
  void find_owners();
  int32_t part_of(const Element& e) const; ///< -1: none
  std::vector<int32_t> elements_of_parts() const;
  std::vector<int32_t> parts_of(const std::vector<int32_t>& elements) const;

  DynamicMesh& m_;
  const Target* target_;
  double cell_;
  int threads_;
  bool watching_everywhere_ = false; ///< watch_crossings(everywhere)
  bool ends_in_surface_ = false;
  int passes_ = 0, projections_ = 0;
  int32_t time_ = 0, since_ = 0; ///< sweeps so far; when this kind of pass began
  Looks looks_;
  Pass last_;
  FailedSearches failed_searches_;
  Parts parts_;
  std::vector<uint32_t> stamp_; ///< of the regions
  uint32_t last_stamp_ = 0;
  /// free_triangles_ with all that was given to add().
  FreeTriangles& free_triangles();
  /// Runs work() on free_triangles_ beside the passes that do not ask for them.
  void add(std::function<void()> work);
  FreeTriangles free_triangles_; ///< where the mesh ends in curved surfaces
  std::future<void> adding_;
  std::vector<int32_t> free_element_, free_vertex_;
};

} // namespace molmesh::optimize
