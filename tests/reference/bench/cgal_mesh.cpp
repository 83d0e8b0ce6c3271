// cgal_mesh.cpp — Labeled_mesh_domain_3 on a function, default refinement.
#include "cgal_mesh.hpp"
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/make_mesh_3.h>
#include <map>

namespace molmesh::reference {

TetMesh cgal_mesh(const std::function<double(Vec3d)>& inside, Vec3d center, double radius, const CgalSizes& sizes) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
  using Triangulation = CGAL::Mesh_triangulation_3<Domain>::type;
  using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
  using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
  namespace p = CGAL::parameters;
  // CGAL's implicit functions are negative inside.
  const std::function<double(const Kernel::Point_3&)> function = [&](const Kernel::Point_3& x) {
    return -inside({CGAL::to_double(x.x()), CGAL::to_double(x.y()), CGAL::to_double(x.z())});
  };
  const Domain domain = Domain::create_implicit_mesh_domain(
      function, Kernel::Sphere_3(Kernel::Point_3(center.x, center.y, center.z), radius * radius),
      p::relative_error_bound = 1e-5);
  const Criteria criteria(p::facet_angle = 25, p::facet_size = sizes.facet,
                          p::facet_distance = sizes.facet_distance, p::cell_radius_edge_ratio = 2,
                          p::cell_size = sizes.cell);
  const Complex complex = sizes.optimized
                              ? CGAL::make_mesh_3<Complex>(domain, criteria, p::no_lloyd(), p::no_odt())
                              : CGAL::make_mesh_3<Complex>(domain, criteria, p::no_perturb(), p::no_exude());
  TetMesh m;
  std::map<Triangulation::Vertex_handle, int32_t> number;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
    Tet t{};
    for (int i = 0; i < 4; ++i) {
      const auto vertex = cell->vertex(i);
      const auto [place, fresh] = number.try_emplace(vertex, static_cast<int32_t>(m.point.size()));
      if (fresh)
        m.point.push_back({vertex->point().x(), vertex->point().y(), vertex->point().z()});
      t[i] = place->second;
    }
    m.tet.push_back(t);
    m.region.push_back(Region::molecule);
  }
  return m;
}

} // namespace molmesh::reference
