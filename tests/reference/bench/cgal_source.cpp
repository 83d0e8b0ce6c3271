// cgal_source.cpp — a mesh of two regions by CGAL's Mesh_3: a box around a cube, as CGAL writes .mesh and .vtu.
// cgal_source SMALL LARGE: half the edges of the cube and of the box; writes cgal-mesh3.mesh, cgal-mesh3.vtu and
// cgal-mesh3-binary.vtu.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/File_medit.h>
#include <CGAL/IO/output_to_vtu.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_polyhedron_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Polyhedral_complex_mesh_domain_3.h>
#include <CGAL/boost/graph/generators.h>
#include <CGAL/make_mesh_3.h>
#include <cstdlib>
#include <fstream>
#include <utility>
#include <vector>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polyhedron = CGAL::Mesh_polyhedron_3<Kernel>::type;
using Domain = CGAL::Polyhedral_complex_mesh_domain_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, Domain::Corner_index, Domain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

static Polyhedron cube(double half) {
  const auto p = [half](int x, int y, int z) { return Kernel::Point_3(x * half, y * half, z * half); };
  Polyhedron cube;
  CGAL::make_hexahedron(p(-1, -1, -1), p(1, -1, -1), p(1, 1, -1), p(-1, 1, -1), p(-1, 1, 1), p(-1, -1, 1),
                        p(1, -1, 1), p(1, 1, 1), cube);
  CGAL::Polygon_mesh_processing::triangulate_faces(cube);
  return cube;
}

int main(int argc, char** argv) {
  if (argc != 3)
    return 2;
  const std::vector<Polyhedron> surfaces = {cube(std::atof(argv[2])), cube(std::atof(argv[1]))};
  const std::vector<std::pair<int, int>> sides = {{7, 0}, {12, 7}};
  Domain domain(surfaces.begin(), surfaces.end(), sides.begin(), sides.end());
  domain.detect_features();
  namespace p = CGAL::parameters;
  const Criteria criteria(p::edge_size = 0.4, p::facet_angle = 25, p::facet_size = 0.4, p::facet_distance = 0.05,
                          p::cell_radius_edge_ratio = 2, p::cell_size = 0.4);
  const Complex mesh = CGAL::make_mesh_3<Complex>(domain, criteria);
  std::ofstream medit("cgal-mesh3.mesh"), text("cgal-mesh3.vtu"), binary("cgal-mesh3-binary.vtu");
  mesh.output_to_medit(medit);
  CGAL::IO::output_to_vtu(text, mesh, CGAL::IO::ASCII);
  CGAL::IO::output_to_vtu(binary, mesh, CGAL::IO::BINARY);
  return medit && text && binary ? 0 : 1;
}
