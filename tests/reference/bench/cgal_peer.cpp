// cgal_peer.cpp — CGAL's Mesh_3 of the molecule in a density grid, for tests/bench/peers.py.
// cgal_peer FILE.vdb OUT.vtu EDGE [optimized]: triangles on the surface and tetrahedra by it of about EDGE (Å),
// larger ones inside; optimized: with perturber and exuder. One thread.
#include "cgal_mesh.hpp"
#include "formats/vdb/vdb.hpp"
#include "formats/vtu/vtu.hpp"
#include "mesh/adjacency.hpp"
#include "reference/bench/trilinear.hpp"
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>

using namespace molmesh;

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "cgal_peer FILE.vdb OUT.vtu EDGE [optimized]\n");
    return 2;
  }
  const double edge = std::atof(argv[3]);
  std::ifstream in(argv[1], std::ios::binary);
  const BlockGrid grid = formats::read_vdb(in, argv[1]);
  const reference::Trilinear inside(grid);
  constexpr double of_facet = 0.7, of_cell = 4, of_distance = 0.15; // bounds that give about that edge
  TetMesh m = reference::cgal_mesh(
      std::ref(inside), inside.center(), inside.radius(),
      {of_facet * edge, of_distance * edge, of_cell * edge, argc > 4 && std::string(argv[4]) == "optimized"});
  rebuild_triangles(m);
  std::ofstream out(argv[2], std::ios::binary);
  formats::write_vtu(out, m);
  return out.flush() ? 0 : 1;
}
