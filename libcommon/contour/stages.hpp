// stages.hpp — the stages of contour(), by the host's threads or by a device.
#pragma once
#include "contour/complex/dual_contouring.hpp"
#include "contour/octree/lattice.hpp"
#include "contour/octree/leaves.hpp"
#include "contour/options.hpp"
#include "contour/regions/components.hpp"
#include "mesh/tet_mesh.hpp"
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace molmesh::contour {

/// Called in this order, each once. What a stage makes stays where the next needs it.
class Stages {
public:
  virtual ~Stages() = default;
  /// The lattice and its grid stay the caller's until release_grid().
  virtual void find_surface(const Lattice& lattice) = 0;
  virtual void select_leaves(const RefineOptions& options) = 0;
  /// Complex and elements; unmeshed: Options::unmeshed_side; on_phase as in contour().
  virtual void make_dual(Side unmeshed, const std::function<void(const std::string&)>& on_phase) = 0;
  virtual void relax() = 0;
  virtual std::vector<Component> find_regions(const RegionOptions& options) = 0;
  virtual TetMesh assemble(Options::Meshed meshed) = 0;
  /// Fills the counters of Summary; contour() sets volumes, components and halvings.
  virtual void count(Summary& summary) const = 0;
  /// From here on nothing reads the lattice or its grid; also after a stage has thrown.
  virtual void release_grid() noexcept {}
};

class HostStages final : public Stages {
public:
  explicit HostStages(int threads) : threads_(threads) {}

  void find_surface(const Lattice& lattice) override;
  void select_leaves(const RefineOptions& options) override;
  void make_dual(Side unmeshed, const std::function<void(const std::string&)>& on_phase) override;
  void relax() override;
  std::vector<Component> find_regions(const RegionOptions& options) override;
  TetMesh assemble(Options::Meshed meshed) override;
  void count(Summary& summary) const override;

  const Octree& tree() const { return *tree_; }
  const Dual& dual() const { return dual_; } ///< the elements' positions stand for the complex's

private:
  int threads_;
  const Lattice* lattice_ = nullptr;
  Surface surface_;
  std::optional<Octree> tree_;
  Dual dual_;
  int64_t relaxed_ = 0;
  Components regions_;
};

} // namespace molmesh::contour
