// foreign.cpp — rebuilt triangles and those of the file, on the same points.
#include "formats/vtu/foreign.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/sorted_triangle.hpp"
#include <algorithm>
#include <utility>

namespace molmesh::formats {
void take_rebuilt_triangles(TetMesh& m, VtuNotes& notes) {
  const std::vector<Tri> before = std::move(m.tri);
  rebuild_triangles(m);
  label_walls(m);
  const TriangleNumbers of_before(before, [](size_t t) { return static_cast<int32_t>(t); });
  std::vector<const int32_t*> same; // of each triangle, which one before
  for (const Tri& t : m.tri)
    same.push_back(of_before.find(t));
  notes.triangles = static_cast<int64_t>(before.size());
  notes.dropped_triangles = notes.triangles - (std::ssize(same) - std::count(same.begin(), same.end(), nullptr));
  const size_t tets = m.tet.size();
  for (CellArray& a : m.cell_array) {
    const auto take = [&](auto& values, auto standard) {
      const std::vector of_file(values.begin() + static_cast<std::ptrdiff_t>(tets), values.end());
      values.resize(tets);
      for (size_t t = 0; t < same.size(); ++t)
        values.push_back(same[t] ? of_file[*same[t]] : standard(t));
    };
    if (a.real.empty())
      take(a.integer, [&](size_t t) { return a.name == "patch" ? m.boundary[t] : 0; });
    else
      take(a.real, [](size_t) { return 0.; });
  }
}

std::vector<std::string> described(const VtuNotes& notes) {
  std::vector<std::string> lines;
  if (notes.dropped_cells > 0)
    lines.push_back("dropped " + std::to_string(notes.dropped_cells) + " vertices and lines");
  if (notes.dropped_triangles > 0)
    lines.push_back("the file has no array 'boundary': of its " + std::to_string(notes.triangles) + " triangles " +
                    std::to_string(notes.dropped_triangles) + " dropped, on no boundary of a region");
  return lines;
}

} // namespace molmesh::formats
