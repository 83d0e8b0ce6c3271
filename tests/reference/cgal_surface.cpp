// cgal_surface.cpp — the one file that sees CGAL.
#include "oracles.hpp"
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <iterator>
#include <map>

namespace molmesh::reference {

CgalSurface cgal_surface(const std::vector<Vec3d>& point, const std::vector<Tri>& tri) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  std::vector<Kernel::Point_3> points;
  std::vector<std::array<std::size_t, 3>> polygons;
  std::map<int32_t, std::size_t> number;
  for (const Tri& t : tri) {
    std::array<std::size_t, 3> polygon{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [place, fresh] = number.try_emplace(t[i], points.size());
      if (fresh) {
        const Vec3d p = point[t[i]];
        points.emplace_back(p.x, p.y, p.z);
      }
      polygon[i] = place->second;
    }
    polygons.push_back(polygon);
  }
  CgalSurface s;
  s.manifold = pmp::is_polygon_soup_a_polygon_mesh(polygons);
  if (!s.manifold)
    return s;
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  s.closed = CGAL::is_closed(mesh);
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> crossings;
  pmp::self_intersections(mesh, std::back_inserter(crossings));
  s.crossings = static_cast<int64_t>(crossings.size());
  s.bounds_volume = s.closed && s.crossings == 0 && pmp::does_bound_a_volume(mesh);
  auto component = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:component", 0).first;
  s.components = static_cast<int64_t>(pmp::connected_components(mesh, component));
  s.euler = static_cast<int64_t>(mesh.number_of_vertices()) - static_cast<int64_t>(mesh.number_of_edges()) +
            static_cast<int64_t>(mesh.number_of_faces());
  s.area = CGAL::to_double(pmp::area(mesh));
  if (s.closed)
    s.volume = CGAL::to_double(pmp::volume(mesh));
  return s;
}

} // namespace molmesh::reference
