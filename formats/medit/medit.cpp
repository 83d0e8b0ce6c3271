// medit.cpp — vertices, tetrahedra and triangles with references.
#include "formats/medit/medit.hpp"
#include "formats/text_out.hpp"
#include "formats/vtu/names.hpp"

namespace molmesh::formats {

void write_medit(std::ostream& stream, const TetMesh& m) {
  const std::vector<int32_t> patch = patches(m);
  TextOut out(stream);
  out << "MeshVersionFormatted 2\nDimension 3\n";
  for (const auto& [label, name] : boundary_names(m, patch))
    out << "# triangles " << label << ": " << name << '\n';
  out << "Vertices\n" << m.point.size() << '\n';
  for (const Vec3d& p : m.point)
    out << p.x << ' ' << p.y << ' ' << p.z << " 0" << '\n';
  out << "Tetrahedra\n" << m.tet.size() << '\n';
  for (size_t t = 0; t < m.tet.size(); ++t) {
    for (const int32_t p : m.tet[t])
      out << p + 1 << ' ';
    out << m.region[t] << '\n';
  }
  out << "Triangles\n" << m.tri.size() << '\n';
  for (size_t t = 0; t < m.tri.size(); ++t) {
    for (const int32_t p : m.tri[t])
      out << p + 1 << ' ';
    out << patch[t] << '\n';
  }
  out << "End" << '\n';
}

} // namespace molmesh::formats
