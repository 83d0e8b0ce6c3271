// complex.cpp — what relaxation need not look at.
#include "contour/complex/complex.hpp"
#include "contour/relaxation/relax_items.hpp"
#include "par/launcher.hpp"

namespace molmesh::contour {

LargeArray<uint8_t> lattice_classes(const Complex& complex, int threads) {
  par::Launcher launcher(threads);
  LargeArray<uint8_t> of(static_cast<size_t>(complex.view.vertices()));
  launcher.for_n("lattice classes", complex.view.vertices(), detail::LatticeClasses{complex.view, of.data()});
  return of;
}

} // namespace molmesh::contour
