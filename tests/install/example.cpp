// example.cpp — meshes four atoms with the installed library: density, tetrahedra, better tetrahedra, no file.
#include <iostream>
#include <molmesh/contour.hpp>
#include <molmesh/density.hpp>
#include <molmesh/mesh.hpp>
#include <molmesh/optimize.hpp>

int main() {
  using namespace molmesh;
  Hierarchy molecule; // without levels: G is the plain sum of the atoms' terms
  for (const Vec3d center : {Vec3d{0, 0, 0}, Vec3d{1.5, 0, 0}, Vec3d{2.2, 1.3, 0}, Vec3d{2.2, 1.3, 1.5}})
    molecule.atom.push_back({center, 1.7});

  density::Options field;
  field.spacing = 0.5;
  density::Counts counts;
  const BlockGrid grid = to_block_grid(density::compute(molecule, field, counts), field.threads);

  const auto phase = [](const std::string&) {};
  contour::Options tetrahedra;
  tetrahedra.meshed = contour::Options::both;
  contour::Summary summary;
  TetMesh mesh = contour::contour(grid, tetrahedra, summary, phase);

  const optimize::Result result = optimize::improve(mesh, &grid, {});
  const Validity validity = check_validity(mesh, 1);
  const Distribution angles = measure_quality(mesh, 1).all.dihedral;
  std::cout << mesh.tet.size() << " tetrahedra, " << validity.region.size() << " regions, dihedral angles "
            << angles.min << "° to " << angles.max << "° (before: " << result.before.min << "° to "
            << result.before.max << "°)\n";
  const bool good = validity.valid() && angles.min > 20 && angles.max < 150;
  std::cout << (good ? "good\n" : "not good\n");
  return good ? 0 : 1;
}
