// mcsf.cpp — simplices with their material and the types of their faces.
#include "formats/mcsf/mcsf.hpp"
#include "base/error.hpp"
#include "formats/text_out.hpp"
#include "formats/vtu/names.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/sorted_triangle.hpp"
#include <algorithm>

namespace molmesh::formats {
namespace {

constexpr int32_t most_label = 1 << 30; // twice that is a type

/// Odd is Dirichlet for MC, even Neumann, 0 a face within the mesh; (type + 1) / 2 is the label.
int32_t face_type(int32_t label, int32_t surface_label) {
  return label == surface_label ? 2 * label : 2 * label - 1;
}

} // namespace

int64_t write_mcsf(std::ostream& stream, const TetMesh& m, const std::string& file) {
  const ExportLabels export_as = export_labels(m);
  const std::vector<int32_t>& patch = export_as.patch;
  const int32_t surface_label = Boundary::surface + export_as.step;
  if (const auto most = std::max_element(patch.begin(), patch.end()); most != patch.end() && *most > most_label)
    fail_input(file + ": a triangle of label " + std::to_string(*most) + ", expected 2^30 at most for mcsf");
  const TriangleNumbers labels(m.tri, [&](size_t t) { return patch[t]; });
  auto unplaced = static_cast<int64_t>(patch.size()) - std::count(patch.begin(), patch.end(), surface_label);
  const LargeArray<int32_t> across = face_neighbors(m, 1);
  TextOut out(stream);
  out << "mcsf_begin=1;\n\ndim=3;\ndimii=3;\nvertices=" << m.point.size() << ";\nsimplices=" << m.tet.size()
      << ";\n\nvert=[" << '\n';
  for (size_t p = 0; p < m.point.size(); ++p)
    out << p << " 0 " << m.point[p].x << ' ' << m.point[p].y << ' ' << m.point[p].z << '\n';
  out << "];\n\nsimp=[" << '\n';
  for (size_t t = 0; t < m.tet.size(); ++t) {
    out << t << " 0 " << m.region[t];
    for (size_t f = 0; f < 4; ++f) {
      int32_t type = 0;
      if (across[4 * t + f] < 0) {
        const int32_t* const found = labels.find(face_points(m, static_cast<int64_t>(4 * t + f)));
        const int32_t label = found ? *found : surface_label;
        type = face_type(label, surface_label);
        unplaced -= label != surface_label;
      }
      out << ' ' << type;
    }
    for (const int32_t p : m.tet[t])
      out << ' ' << p;
    out << '\n';
  }
  out << "];\n\nmcsf_end=1;" << '\n';
  return unplaced;
}

} // namespace molmesh::formats
