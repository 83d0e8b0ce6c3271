// abaqus.cpp — keywords and lines of numbers; triangles are faces of tetrahedra.
#include "formats/abaqus/abaqus.hpp"
#include "formats/text_out.hpp"
#include "formats/vtu/names.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/face_groups.hpp"
#include <set>

namespace molmesh::formats {
namespace {

/// A set's name: letters, digits and underscores, at most 80, begins with a letter, and no other has it in any
/// case.
std::string set_name(const std::string& name, std::set<std::string>& taken) {
  std::string s;
  for (const char c : name.substr(0, 60))
    s += (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ? c : '_';
  if (s.empty() || !((s[0] >= 'A' && s[0] <= 'Z') || (s[0] >= 'a' && s[0] <= 'z')))
    s = "set_" + s;
  const auto upper = [](std::string t) {
    for (char& c : t)
      c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    return t;
  };
  while (!taken.insert(upper(s)).second)
    s += '_';
  return s;
}

} // namespace

void write_abaqus(std::ostream& stream, const TetMesh& m) {
  // Face of a tetrahedron opposite to its corner 0 … 3, as Abaqus numbers faces: S1 has the corners 1 2 3, S2 1 4
  // 2, S3 2 4 3, S4 3 4 1.
  constexpr int face_number[] = {3, 4, 2, 1};
  const ExportLabels labels = export_labels(m);
  TextOut out(stream);
  out << "*HEADING\ntetrahedral mesh by molmesh\n*NODE\n";
  for (size_t p = 0; p < m.point.size(); ++p)
    out << p + 1 << ", " << m.point[p].x << ", " << m.point[p].y << ", " << m.point[p].z << '\n';
  std::set<std::string> taken;
  for (const auto& [region, name] : labels.region_name) {
    out << "*ELEMENT, TYPE=C3D4, ELSET=" << set_name(name, taken) << '\n';
    for (size_t t = 0; t < m.tet.size(); ++t)
      if (m.region[t] == region) {
        out << t + 1;
        for (const int32_t p : m.tet[t])
          out << ", " << p + 1;
        out << '\n';
      }
  }
  // Each triangle as a face of the tetrahedron that it looks out of, or of the only one.
  std::vector<int64_t> face(m.tri.size(), -1);
  const int64_t faces = 4 * std::ssize(m.tet);
  for_each_face(m.tet, m.tri, std::ssize(m.point), 1, [&](const uint32_t* group, int n, bool) {
    for (int k = n - 1; k >= 0 && group[k] >= faces; --k) {
      const size_t t = group[k] - static_cast<size_t>(faces);
      for (int i = 0; i < k && group[i] < faces; ++i)
        if (face[t] < 0 || same_turn(face_points(m, group[i]), m.tri[t]))
          face[t] = group[i];
    }
  });
  for (const auto& [label, name] : labels.patch_name) {
    out << "*SURFACE, TYPE=ELEMENT, NAME=" << set_name(name, taken) << '\n';
    for (size_t t = 0; t < m.tri.size(); ++t)
      if (labels.patch[t] == label && face[t] >= 0)
        out << face[t] / 4 + 1 << ", S" << face_number[face[t] % 4] << '\n';
  }
}

} // namespace molmesh::formats
