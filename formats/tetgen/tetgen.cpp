// tetgen.cpp — points, tetrahedra with their region, triangles with their marker; indices from 1.
#include "formats/tetgen/tetgen.hpp"
#include "formats/text_out.hpp"
#include "formats/vtu/names.hpp"

namespace molmesh::formats {

void write_tetgen(std::ostream& node, std::ostream& ele, std::ostream& face, const TetMesh& m) {
  const ExportLabels labels = export_labels(m);
  TextOut nodes(node), tets(ele), faces(face);
  nodes << m.point.size() << " 3 0 0" << '\n';
  for (size_t p = 0; p < m.point.size(); ++p)
    nodes << p + 1 << ' ' << m.point[p].x << ' ' << m.point[p].y << ' ' << m.point[p].z << '\n';
  tets << m.tet.size() << " 4 1" << '\n';
  for (size_t t = 0; t < m.tet.size(); ++t) {
    tets << t + 1;
    for (const int32_t p : m.tet[t])
      tets << ' ' << p + 1;
    tets << ' ' << m.region[t] << '\n';
  }
  faces << m.tri.size() << " 1" << '\n';
  for (size_t t = 0; t < m.tri.size(); ++t) {
    faces << t + 1;
    for (const int32_t p : m.tri[t])
      faces << ' ' << p + 1;
    faces << ' ' << labels.patch[t] << '\n';
  }
}

} // namespace molmesh::formats
