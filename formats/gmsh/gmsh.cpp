// gmsh.cpp — physical groups, nodes, elements, data of elements.
#include "formats/gmsh/gmsh.hpp"
#include "formats/text_out.hpp"
#include "formats/vtu/names.hpp"
#include <algorithm>
#include <limits>

namespace molmesh::formats {
namespace {

/// Cells of one label: an entity and a physical group of Gmsh.
struct Group {
  std::string name;
  std::vector<size_t> cell;
  Vec3d lo, hi;
};
using Groups = std::map<int32_t, Group>;

template <class Cells>
Groups groups(const TetMesh& m, const Cells& cells, const std::vector<int32_t>& label) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Groups g;
  for (size_t c = 0; c < cells.size(); ++c) {
    Group& group =
        g.try_emplace(label[c], Group{"", {}, {infinity, infinity, infinity}, {-infinity, -infinity, -infinity}})
            .first->second;
    group.cell.push_back(c);
    for (const int32_t p : cells[c])
      for (int a = 0; a < 3; ++a) {
        group.lo[a] = std::min(group.lo[a], m.point[p][a]);
        group.hi[a] = std::max(group.hi[a], m.point[p][a]);
      }
  }
  return g;
}

/// Between quotes, on one line.
std::string quotable(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '"' || (c >= 0 && c < ' ') || c == 0x7F; }, '_');
  return name;
}

void write_physical_names(TextOut& out, const Groups& surfaces, const Groups& volumes) {
  out << "$PhysicalNames\n" << surfaces.size() + volumes.size() << '\n';
  for (const auto& [tag, g] : surfaces)
    out << "2 " << tag << " \"" << quotable(g.name) << "\"" << '\n';
  for (const auto& [tag, g] : volumes)
    out << "3 " << tag << " \"" << quotable(g.name) << "\"" << '\n';
  out << "$EndPhysicalNames" << '\n';
}

void put(TextOut& out, Vec3d p) {
  out << p.x << ' ' << p.y << ' ' << p.z;
}

/// Elements are numbered from 1 in the order in which they are written: triangles, then tetrahedra, by group.
template <class Write>
void for_each_element(const Groups& surfaces, const Groups& volumes, Write write) {
  size_t number = 0;
  for (const auto& [tag, g] : surfaces)
    for (const size_t c : g.cell)
      write(++number, 2, tag, c);
  for (const auto& [tag, g] : volumes)
    for (const size_t c : g.cell)
      write(++number, 3, tag, c);
}

/// The points of a triangle (dimension 2) or a tetrahedron, and the end of its line.
void put_corners(TextOut& out, const TetMesh& m, int dimension, size_t c) {
  const auto put_all = [&](const auto& cell) {
    for (const int32_t p : cell)
      out << ' ' << p + 1;
  };
  if (dimension == 2)
    put_all(m.tri[c]);
  else
    put_all(m.tet[c]);
  out << '\n';
}

void write_mesh_2_2(TextOut& out, const TetMesh& m, const Groups& surfaces, const Groups& volumes) {
  out << "$Nodes\n" << m.point.size() << '\n';
  for (size_t p = 0; p < m.point.size(); ++p) {
    out << p + 1 << ' ';
    put(out, m.point[p]);
    out << '\n';
  }
  out << "$EndNodes\n$Elements\n" << m.tri.size() + m.tet.size() << '\n';
  for_each_element(surfaces, volumes, [&](size_t number, int dimension, int32_t tag, size_t c) {
    out << number << (dimension == 2 ? " 2 2 " : " 4 2 ") << tag << ' ' << tag;
    put_corners(out, m, dimension, c);
  });
  out << "$EndElements" << '\n';
}

void write_entity(TextOut& out, int32_t tag, const Group& g) {
  out << tag << ' ';
  put(out, g.lo);
  out << ' ';
  put(out, g.hi);
  out << " 1 " << tag << " 0" << '\n'; // one physical group, no bounding entities
}

void write_mesh_4_1(TextOut& out, const TetMesh& m, const Groups& surfaces, const Groups& volumes) {
  out << "$Entities\n0 0 " << surfaces.size() << ' ' << volumes.size() << '\n';
  for (const auto& [tag, g] : surfaces)
    write_entity(out, tag, g);
  for (const auto& [tag, g] : volumes)
    write_entity(out, tag, g);
  out << "$EndEntities\n$Nodes\n1 " << m.point.size() << " 1 " << m.point.size() << "\n3 " << volumes.begin()->first
      << " 0 " << m.point.size() << '\n';
  for (size_t p = 0; p < m.point.size(); ++p)
    out << p + 1 << '\n';
  for (const Vec3d& p : m.point) {
    put(out, p);
    out << '\n';
  }
  const size_t elements = m.tri.size() + m.tet.size();
  out << "$EndNodes\n$Elements\n"
      << surfaces.size() + volumes.size() << ' ' << elements << " 1 " << elements << '\n';
  int32_t open_tag = 0;
  int open_dimension = 0;
  for_each_element(surfaces, volumes, [&](size_t number, int dimension, int32_t tag, size_t c) {
    if (dimension != open_dimension || tag != open_tag) {
      const Groups& all = dimension == 2 ? surfaces : volumes;
      out << dimension << ' ' << tag << (dimension == 2 ? " 2 " : " 4 ") << all.at(tag).cell.size() << '\n';
      open_dimension = dimension;
      open_tag = tag;
    }
    out << number;
    put_corners(out, m, dimension, c);
  });
  out << "$EndElements" << '\n';
}

void write_data(TextOut& out, const TetMesh& m, const std::string& name, const Groups& surfaces,
                const Groups& volumes, const std::vector<int32_t>& integer, const std::vector<double>& real) {
  out << "$ElementData\n1\n\"" << quotable(name) << "\"\n1\n0\n3\n0\n1\n" << m.tri.size() + m.tet.size() << '\n';
  for_each_element(surfaces, volumes, [&](size_t number, int dimension, int32_t, size_t c) {
    const size_t cell = dimension == 3 ? c : m.tet.size() + c;
    out << number << ' ';
    real.empty() ? out << integer[cell] : out << real[cell];
    out << '\n';
  });
  out << "$EndElementData" << '\n';
}

} // namespace

void write_gmsh(std::ostream& stream, const TetMesh& m, GmshVersion version) {
  const std::vector<int32_t> patch = patches(m);
  Groups surfaces = groups(m, m.tri, patch), volumes = groups(m, m.tet, m.region);
  for (const auto& [tag, name] : boundary_names(m, patch))
    surfaces.at(tag).name = name;
  for (auto& [tag, g] : volumes)
    g.name = region_name(tag);
  TextOut out(stream);
  out << "$MeshFormat\n" << (version == GmshVersion::v2_2 ? "2.2" : "4.1") << " 0 8\n$EndMeshFormat" << '\n';
  write_physical_names(out, surfaces, volumes);
  (version == GmshVersion::v2_2 ? write_mesh_2_2 : write_mesh_4_1)(out, m, surfaces, volumes);
  if (version == GmshVersion::v2_2)
    return; // meshio 5.0 refuses files of format 2.2 with data of elements
  if (!m.part.empty()) {
    std::vector<int32_t> part = m.part;
    part.resize(m.tet.size() + m.tri.size(), 0);
    write_data(out, m, "part", surfaces, volumes, part, {});
  }
  for (const CellArray& a : m.cell_array)
    if (a.name != "patch")
      write_data(out, m, a.name, surfaces, volumes, a.integer, a.real);
}

} // namespace molmesh::formats
