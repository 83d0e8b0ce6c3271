// gmsh.cpp — physical groups, nodes, elements, data of elements.
#include "formats/gmsh/gmsh.hpp"
#include "formats/text_out.hpp"
#include "formats/vtu/names.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/face_groups.hpp"
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

/// Numbers of a section of 4.1: in text, or as they lie in memory.
class Numbers {
public:
  Numbers(TextOut& out, bool binary) : out_(out), binary_(binary) {}
  Numbers& integer(int32_t v) { return put(v, v); }
  Numbers& size(size_t v) { return put(v, v); }
  Numbers& real(double v) { return put(v, v); }
  Numbers& point(Vec3d p) { return real(p.x).real(p.y).real(p.z); }
  void end_line() {
    if (!binary_)
      out_ << '\n';
    begun_ = false;
  }
  /// After the last line of the section.
  void end_section() {
    if (binary_)
      out_ << '\n';
  }

private:
  template <class T>
  Numbers& put(T as_text, T as_bytes) {
    if (binary_) {
      out_.bytes(&as_bytes, sizeof as_bytes);
    } else {
      if (begun_)
        out_ << ' ';
      out_ << as_text;
    }
    begun_ = true;
    return *this;
  }
  TextOut& out_;
  const bool binary_;
  bool begun_ = false;
};

/// By region: the labels of its boundary, 1 where their triangles point out of it, else -1.
using Bounds = std::map<int32_t, std::map<int32_t, int32_t>>;

Bounds bounds_of(const TetMesh& m, const std::vector<int32_t>& patch) {
  Bounds bounds;
  const int64_t faces = 4 * std::ssize(m.tet);
  for_each_face(m.tet, m.tri, std::ssize(m.point), 1, [&](const uint32_t* face, int n, bool) {
    if (face[n - 1] < faces)
      return;
    const size_t t = face[n - 1] - static_cast<size_t>(faces);
    for (int i = 0; i < n && face[i] < faces; ++i) {
      int32_t& sign = bounds[m.region[face[i] / 4]].try_emplace(patch[t], -1).first->second;
      if (same_turn(face_points(m, face[i]), m.tri[t]))
        sign = 1;
    }
  });
  return bounds;
}

void write_entity(Numbers& out, int32_t tag, const Group& g, const std::map<int32_t, int32_t>& bounds) {
  out.integer(tag).point(g.lo).point(g.hi).size(1).integer(tag).size(bounds.size());
  for (const auto& [label, sign] : bounds)
    out.integer(sign * label);
  out.end_line();
}

void write_mesh_4_1(TextOut& text, const TetMesh& m, const Groups& surfaces, const Groups& volumes, Bounds bounds,
                    bool binary) {
  Numbers out(text, binary);
  text << "$Entities\n";
  out.size(0).size(0).size(surfaces.size()).size(volumes.size()).end_line();
  for (const auto& [tag, g] : surfaces)
    write_entity(out, tag, g, {});
  for (const auto& [tag, g] : volumes)
    write_entity(out, tag, g, bounds[tag]);
  out.end_section();
  text << "$EndEntities\n$Nodes\n";
  out.size(1).size(m.point.size()).size(1).size(m.point.size()).end_line();
  out.integer(3).integer(volumes.begin()->first).integer(0).size(m.point.size()).end_line();
  for (size_t p = 0; p < m.point.size(); ++p)
    out.size(p + 1).end_line();
  for (const Vec3d& p : m.point)
    out.point(p).end_line();
  out.end_section();
  const size_t elements = m.tri.size() + m.tet.size();
  text << "$EndNodes\n$Elements\n";
  out.size(surfaces.size() + volumes.size()).size(elements).size(1).size(elements).end_line();
  int32_t open_tag = 0;
  int open_dimension = 0;
  for_each_element(surfaces, volumes, [&](size_t number, int dimension, int32_t tag, size_t c) {
    if (dimension != open_dimension || tag != open_tag) {
      const Groups& all = dimension == 2 ? surfaces : volumes;
      out.integer(dimension).integer(tag).integer(dimension == 2 ? 2 : 4).size(all.at(tag).cell.size()).end_line();
      open_dimension = dimension;
      open_tag = tag;
    }
    out.size(number);
    const auto corners = [&](const auto& cell) {
      for (const int32_t p : cell)
        out.size(static_cast<size_t>(p) + 1);
    };
    dimension == 2 ? corners(m.tri[c]) : corners(m.tet[c]);
    out.end_line();
  });
  out.end_section();
  text << "$EndElements" << '\n';
}

void write_data(TextOut& text, const TetMesh& m, const std::string& name, const Groups& surfaces,
                const Groups& volumes, const std::vector<int32_t>& integer, const std::vector<double>& real,
                bool binary) {
  Numbers out(text, binary);
  text << "$ElementData\n1\n\"" << quotable(name) << "\"\n1\n0\n3\n0\n1\n" << m.tri.size() + m.tet.size() << '\n';
  for_each_element(surfaces, volumes, [&](size_t number, int dimension, int32_t, size_t c) {
    const size_t cell = dimension == 3 ? c : m.tet.size() + c;
    out.integer(static_cast<int32_t>(number));
    if (real.empty() && !binary)
      out.integer(integer[cell]);
    else
      out.real(real.empty() ? integer[cell] : real[cell]);
    out.end_line();
  });
  out.end_section();
  text << "$EndElementData" << '\n';
}

} // namespace

void write_gmsh(std::ostream& stream, const TetMesh& m, GmshVersion version) {
  const ExportLabels labels = export_labels(m);
  Groups surfaces = groups(m, m.tri, labels.patch), volumes = groups(m, m.tet, m.region);
  for (const auto& [tag, name] : labels.patch_name)
    surfaces.at(tag).name = name;
  for (const auto& [tag, name] : labels.region_name)
    volumes.at(tag).name = name;
  const bool binary = version == GmshVersion::v4_1_binary;
  TextOut out(stream);
  out << "$MeshFormat\n" << (version == GmshVersion::v2_2 ? "2.2" : "4.1") << (binary ? " 1 8\n" : " 0 8\n");
  if (binary) {
    const int32_t one = 1; // tells the order of bytes
    out.bytes(&one, sizeof one) << '\n';
  }
  out << "$EndMeshFormat" << '\n';
  write_physical_names(out, surfaces, volumes);
  if (version == GmshVersion::v2_2) {
    write_mesh_2_2(out, m, surfaces, volumes);
    return; // meshio 5.0 refuses files of format 2.2 with data of elements
  }
  write_mesh_4_1(out, m, surfaces, volumes, bounds_of(m, labels.patch), binary);
  if (!m.part.empty()) {
    std::vector<int32_t> part = m.part;
    part.resize(m.tet.size() + m.tri.size(), 0);
    write_data(out, m, "part", surfaces, volumes, part, {}, binary);
  }
  for (const CellArray& a : m.cell_array)
    if (a.name != "patch")
      write_data(out, m, a.name, surfaces, volumes, a.integer, a.real, binary);
}

} // namespace molmesh::formats
