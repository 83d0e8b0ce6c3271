// boxed_mesh.hpp — meshes of a few atoms in a far outer boundary.
#pragma once
#include "contour/contour.hpp"
#include "density/density.hpp"
#include "unit/contour/checked.hpp"

namespace molmesh::test {

inline BlockGrid density_of(const Hierarchy& h, double spacing) {
  density::Options options;
  options.spacing = spacing;
  density::Counts counts;
  return to_block_grid(density::compute(h, options, counts), 1);
}

/// boundary: a factor of the molecule's box, `scale`.
inline TetMesh mesh_within(const BlockGrid& grid, contour::Options::Meshed meshed,
                           contour::BoxRequest::Kind boundary, double scale) {
  contour::Options options;
  options.meshed = meshed;
  options.box.kind = boundary;
  options.box.scale = scale;
  return mesh_of(grid, options);
}

} // namespace molmesh::test
