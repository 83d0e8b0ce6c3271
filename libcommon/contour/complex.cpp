// complex.cpp — what relaxation need not look at.
#include "contour/complex.hpp"
#include "contour/detail/at.hpp"
#include "par/par.hpp"

namespace molmesh::contour {

using detail::at;

std::vector<uint8_t> lattice_classes(const Complex& complex, int threads) {
  const ComplexView& c = complex.view;
  std::vector<uint8_t> of(at(c.vertices()), 0);
  par::for_n(c.grid_vertices, threads, [&](int64_t v) { of[at(v)] = c.nearest[v] < 0; });
  par::for_n(c.tree.leaves, threads, [&](int64_t leaf) {
    if (c.side[leaf] != Side::crossed)
      of[at(c.dual0 + leaf)] = static_cast<uint8_t>(2 + c.tree.level[leaf]);
  });
  return of;
}

} // namespace molmesh::contour
