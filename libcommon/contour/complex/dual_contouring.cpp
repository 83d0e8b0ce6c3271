// dual_contouring.cpp — dual contouring on the host: complex, restored grid points, elements.
#include "contour/complex/dual_contouring.hpp"
#include "base/error.hpp"
#include "contour/complex/complex_passes.hpp"
#include "par/launcher.hpp"
#include <utility>

namespace molmesh::contour {

Dual make_dual(const DualInput& in, const std::function<void(const std::string&)>& on_phase) {
  on_phase("dual vertices");
  par::HostLauncher launcher(in.threads);
  using Passes = ComplexPasses<par::HostLauncher, HostMemory>;
  Passes passes(launcher, in.lattice.view(), in.tree.view(), in.surface.cells.data(), in.surface.samples.data(),
                static_cast<int64_t>(in.surface.cells.size()));
  passes.view.unmeshed = in.unmeshed;
  if (!in.lattice.cut_allowed() && passes.meets_wall())
    refuse_surface_at_wall();
  on_phase("elements");
  Dual dual;
  dual.restored_points = passes.restore_spoiling([&](const Passes::Ids& leaves, const Passes::Ids* ends) {
    Passes::Ids spoiled{spoiled_of(passes.view, leaves.array, ends ? &ends->array : nullptr, in.threads)};
    spoiled.n = static_cast<int64_t>(spoiled.array.size());
    return spoiled;
  });
  dual.elements = make_elements(passes.view, in.threads);
  dual.complex = std::move(passes);
  return dual;
}

} // namespace molmesh::contour
