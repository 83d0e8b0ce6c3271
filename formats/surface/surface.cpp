// surface.cpp — the triangles of the molecular surface and the points that they use.
#include "formats/surface/surface.hpp"
#include "base/error.hpp"
#include "formats/text_out.hpp"
#include "formats/vtu/names.hpp"
#include "geom/tet_measures.hpp"
#include <bit>
#include <cstring>
#include <limits>
#include <set>

namespace molmesh::formats {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

struct Surface {
  std::vector<Vec3d> point; ///< in the order of the mesh
  std::vector<Tri> tri;
  std::vector<size_t> source; ///< [tri] in the mesh
};

Surface surface_of(const TetMesh& m, const std::string& file) {
  Surface s;
  std::vector<int32_t> number(m.point.size(), -1);
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (m.boundary[t] == Boundary::surface) {
      s.source.push_back(t);
      for (const int32_t p : m.tri[t])
        number[p] = 0;
    }
  if (s.source.empty())
    fail_input(file + ": no triangle of boundary 1, expected a molecular surface");
  for (size_t p = 0; p < m.point.size(); ++p)
    if (number[p] == 0) {
      number[p] = static_cast<int32_t>(s.point.size());
      s.point.push_back(m.point[p]);
    }
  for (const size_t t : s.source) {
    Tri corner = m.tri[t];
    for (int32_t& p : corner)
      p = number[p];
    s.tri.push_back(corner);
  }
  return s;
}

template <class T>
void put(std::ostream& out, const T* values, size_t n) {
  out.write(reinterpret_cast<const char*>(values), static_cast<std::streamsize>(n * sizeof(T)));
}

/// A PLY property is a word that no other one is.
std::string property(const std::string& name, std::set<std::string>& taken) {
  std::string s;
  for (const char c : name)
    s += c > ' ' && c < 0x7F ? c : '_';
  while (!taken.insert(s).second)
    s += '_';
  return s;
}

} // namespace

void write_stl(std::ostream& out, const TetMesh& m, const std::string& file) {
  const Surface s = surface_of(m, file);
  if (s.tri.size() > std::numeric_limits<uint32_t>::max())
    fail_input(file + ": over 2^32 - 1 triangles, expected fewer for STL");
  char header[80] = "molecular surface by molmesh"; // must not begin with "solid"
  const auto count = static_cast<uint32_t>(s.tri.size());
  put(out, header, sizeof header);
  put(out, &count, 1);
  for (const Tri& t : s.tri) {
    Vec3d p[3];
    float record[12];
    for (int i = 0; i < 3; ++i)
      p[i] = s.point[t[i]];
    Vec3d normal = tri_normal(p[0], p[1], p[2]);
    const double length = norm(normal);
    normal = length > 0 ? normal / length : Vec3d{};
    for (int a = 0; a < 3; ++a) {
      record[a] = static_cast<float>(normal[a]);
      for (int i = 0; i < 3; ++i)
        record[3 + 3 * i + a] = static_cast<float>(p[i][a]);
    }
    const uint16_t attributes = 0;
    put(out, record, 12);
    put(out, &attributes, 1);
  }
}

void write_ply(std::ostream& stream, const TetMesh& m, const std::string& file) {
  const Surface s = surface_of(m, file);
  const ExportLabels labels = export_labels(m);
  TextOut out(stream); // in text: meshio 5.0 misreads binary faces that have more than their corners
  out << "ply\nformat ascii 1.0\n";
  for (const auto& [label, name] : labels.patch_name)
    out << "comment patch " << label << ' ' << name << '\n';
  out << "element vertex " << s.point.size()
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << s.tri.size()
      << "\nproperty list uchar int vertex_indices\nproperty int patch\n";
  std::set<std::string> taken{"vertex_indices", "patch"};
  for (const CellArray& a : m.cell_array)
    if (a.name != "patch")
      out << (a.real.empty() ? "property int " : "property double ") << property(a.name, taken) << '\n';
  out << "end_header\n";
  for (const Vec3d& p : s.point)
    out << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (size_t t = 0; t < s.tri.size(); ++t) {
    out << "3 " << s.tri[t][0] << ' ' << s.tri[t][1] << ' ' << s.tri[t][2] << ' ' << labels.patch[s.source[t]];
    for (const CellArray& a : m.cell_array) {
      const size_t cell = m.tet.size() + s.source[t];
      if (a.name == "patch")
        continue;
      out << ' ';
      a.real.empty() ? out << a.integer[cell] : out << a.real[cell];
    }
    out << '\n';
  }
}

void write_off(std::ostream& stream, const TetMesh& m, const std::string& file) {
  const Surface s = surface_of(m, file);
  TextOut out(stream);
  out << "OFF\n" << s.point.size() << ' ' << s.tri.size() << " 0" << '\n';
  for (const Vec3d& p : s.point)
    out << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const Tri& t : s.tri)
    out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
}

} // namespace molmesh::formats
