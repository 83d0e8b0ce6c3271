// optimize.hpp — quality improvement of a tetrahedral mesh: §5 of the paper, docs/theory/optimization.md.
#pragma once
#include "grid/block_grid.hpp"
#include "mesh/tet_mesh.hpp"
#include "optimize/mesh/measures.hpp"
#include "optimize/mesh/snapshot.hpp"
#include "optimize/schedule/pass.hpp"
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace molmesh::optimize {

/// How much time the elements are worth.
enum class Effort : uint8_t {
  fast, ///< 15° to 155°: few rounds and no search, so some points may stay off the isosurface
  good, ///< 25° to 140°, Q 0.30, no point off
  best, ///< 28° to 134°, Q 0.35, but for a few elements; no point off
};

struct Options {
  Effort effort = Effort::good;
  /// Better elements than these are not aimed at: few meshes come so far, and all of their elements take time.
  static constexpr double most_min_dihedral = 34, least_max_dihedral = 125;
  /// Degrees aimed at where the effort aims at less; the work stops where they are reached.
  double min_dihedral = 0, max_dihedral = 180;
  /// Rounds at most; 0 leaves the mesh as it is. Fewer than the effort has are its first ones: none of them lets
  /// the worst element fall, and no search follows.
  int iterations = 15;
  /// Edges inside, on walls and, with a density, on the surface contract as far as its curvature, gradation and
  /// quality allow.
  bool coarsen = false;
  double sharp = 50; ///< degrees; without a density, edges of the surface that bend by more are kept
  int threads = 1;
  /// Told now and then how much of the improvement is done (0 to 1), by the elements that are still below the goal.
  std::function<void(double)> progress;
  /// Of a mesh with domains: where shares are equal, by the label of the interface. Others are kept on the
  /// interface that comes in.
  std::map<int32_t, std::shared_ptr<const Target>> interfaces = {};
};

struct Result {
  Counts counts;
  int rounds = 0;
  int64_t looks = 0;     ///< what it cost, on any machine: elements whose quality was looked at, about
  int64_t removed = 0;   ///< vertices that coarsening has removed
  bool rejected = false; ///< the worst element would have become worse: the mesh is as it came
  Angles before, after;
  Fidelity fidelity; ///< after (with a density)
  /// [4 tets] The tetrahedron beyond each face, -1: none; empty where the mesh stayed as it came.
  LargeArray<int32_t> across;
};

/// Moves many points at once where no element below the pass' goal becomes worse: what a device does before each
/// round of operations. The isosurface is null without a density. Returns how many moves were done; changed
/// elements have their new quality and count as never tried.
using FlowPass = std::function<int64_t(DynamicMesh&, const Isosurface*, const Pass&)>;

/// Improves the mesh in place. With a density, points of the curved boundary labels are put on G = isovalue;
/// without, they move on the surface that came in, whose sharp edges are kept. Regions, labels
/// and the topology of every surface stay; the worst element never becomes worse (I9). Same result for any number
/// of threads. phase(name), when given, is told what begins. Throws Error(bad_input) for a mesh that is not valid
/// or whose surface runs against the isosurface.
Result improve(TetMesh& mesh, const BlockGrid* density, const Options& options,
               const std::function<void(const std::string&)>& phase = {}, const FlowPass& flow = {});

} // namespace molmesh::optimize
