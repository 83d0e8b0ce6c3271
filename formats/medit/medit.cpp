// medit.cpp — vertices, tetrahedra and triangles with references.
#include "formats/medit/medit.hpp"
#include "formats/text_out.hpp"
#include "formats/vtu/names.hpp"

namespace molmesh::formats {

void write_medit(std::ostream& stream, const TetMesh& m) {
  const ExportLabels labels = export_labels(m);
  TextOut out(stream);
  out << "MeshVersionFormatted 2\nDimension 3\n";
  for (const auto& [label, name] : labels.patch_name)
    out << "# triangles " << label << ": " << name << '\n';
  for (const auto& [region, name] : labels.region_name)
    out << "# tetrahedra " << region << ": " << name << '\n';
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
    out << labels.patch[t] << '\n';
  }
  out << "End" << '\n';
}

} // namespace molmesh::formats
