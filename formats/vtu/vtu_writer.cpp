// vtu_writer.cpp — a TetMesh as .vtu, appended raw (VTUv1.md).
#include "formats/vtu/vtu.hpp"
#include "formats/xml_text.hpp"
#include <bit>
#include <cassert>
#include <functional>
#include <limits>
#include <ostream>
#include <utility>

namespace molmesh::formats {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

struct Array {
  std::string type, name, shape; ///< shape: further attributes
  uint64_t bytes;
  std::function<void(std::ostream&)> write;
};

void write_bytes(std::ostream& out, const void* p, size_t n) {
  out.write(static_cast<const char*>(p), static_cast<std::streamsize>(n));
}
template <class Vector>
void write_vector(std::ostream& out, const Vector& v) {
  write_bytes(out, v.data(), v.size() * sizeof(v[0]));
}
/// f(0) … f(n-1), in pieces that fit a cache.
template <class T, class F>
void write_values(std::ostream& out, size_t n, F f) {
  constexpr size_t piece = 4096;
  T buffer[piece];
  for (size_t i = 0; i < n; i += piece) {
    const size_t m = std::min(piece, n - i);
    for (size_t k = 0; k < m; ++k)
      buffer[k] = static_cast<T>(f(i + k));
    write_bytes(out, buffer, m * sizeof(T));
  }
}

Array bytes_array(const std::string& name, const std::string& s) {
  return {"UInt8", name, " NumberOfTuples=\"" + std::to_string(s.size()) + '"', s.size(),
          [&s](std::ostream& out) { write_bytes(out, s.data(), s.size()); }};
}

Array number_array(const char* name, double value) {
  return {"Float64", name, " NumberOfTuples=\"1\"", sizeof value,
          [value](std::ostream& out) { write_bytes(out, &value, sizeof value); }};
}

Array sphere_array(const Sphere& s) {
  const std::array<double, 4> value{s.center.x, s.center.y, s.center.z, s.radius};
  return {"Float64", "sphere", " NumberOfTuples=\"4\"", sizeof value,
          [value](std::ostream& out) { write_bytes(out, value.data(), sizeof value); }};
}

/// Labels of the tetrahedra, then of the triangles; null: 0.
Array label_array(const char* name, const TetMesh& m, const std::vector<int32_t>* tet,
                  const std::vector<int32_t>* tri) {
  const auto write = [&m, tet, tri](std::ostream& out) {
    const auto zero = [](size_t) { return 0; };
    tet ? write_vector(out, *tet) : write_values<int32_t>(out, m.tet.size(), zero);
    tri ? write_vector(out, *tri) : write_values<int32_t>(out, m.tri.size(), zero);
  };
  return {"Int32", name, "", (m.tet.size() + m.tri.size()) * sizeof(int32_t), write};
}

template <class Index>
std::vector<Array> cell_arrays(const TetMesh& m, const char* type) {
  const size_t tets = m.tet.size(), tris = m.tri.size();
  const auto connectivity = [&m](std::ostream& out) {
    if constexpr (sizeof(Index) == sizeof(int32_t)) {
      write_vector(out, m.tet);
      write_vector(out, m.tri);
    } else {
      write_values<Index>(out, 4 * m.tet.size(), [&](size_t i) { return m.tet[i / 4][i % 4]; });
      write_values<Index>(out, 3 * m.tri.size(), [&](size_t i) { return m.tri[i / 3][i % 3]; });
    }
  };
  const auto offsets = [tets, tris](std::ostream& out) {
    write_values<Index>(out, tets, [](size_t i) { return 4 * (i + 1); });
    write_values<Index>(out, tris, [&](size_t i) { return 4 * tets + 3 * (i + 1); });
  };
  const auto types = [tets, tris](std::ostream& out) {
    write_values<uint8_t>(out, tets + tris, [&](size_t i) { return i < tets ? 10 : 5; });
  };
  return {{type, "connectivity", "", (4 * tets + 3 * tris) * sizeof(Index), connectivity},
          {type, "offsets", "", (tets + tris) * sizeof(Index), offsets},
          {"UInt8", "types", "", tets + tris, types}};
}

void declare(std::ostream& out, const std::vector<Array>& arrays, uint64_t& end) {
  for (const Array& a : arrays) {
    end -= sizeof a.bytes + a.bytes;
    out << "<DataArray type=\"" << a.type << "\" Name=\"" << a.name << '"' << a.shape
        << " format=\"appended\" offset=\"" << end << "\"/>\n";
  }
}

} // namespace

void write_vtu(std::ostream& out, const TetMesh& m) {
  assert(m.region.size() == m.tet.size() && m.boundary.size() == m.tri.size());
  assert(m.part.empty() || m.part.size() == m.tet.size());
  std::vector<Array> field = {number_array("isovalue", m.isovalue), bytes_array("source", m.source),
                              bytes_array("creator", m.creator)};
  if (m.decay > 0)
    field.push_back(number_array("decay", m.decay));
  if (m.atoms > 0)
    field.push_back(number_array("atoms", static_cast<double>(m.atoms)));
  if (m.sphere)
    field.push_back(sphere_array(*m.sphere));
  for (const NamedText& t : m.named_text)
    field.push_back(bytes_array(escaped(t.name), t.text));
  std::vector<Array> label = {label_array("region", m, &m.region, nullptr),
                              label_array("boundary", m, nullptr, &m.boundary)};
  if (!m.part.empty())
    label.push_back(label_array("part", m, &m.part, nullptr));
  for (const CellArray& a : m.cell_array) {
    assert(a.integer.size() + a.real.size() == m.tet.size() + m.tri.size());
    if (a.real.empty())
      label.push_back({"Int32", escaped(a.name), "", a.integer.size() * sizeof(int32_t),
                       [&a](std::ostream& o) { write_vector(o, a.integer); }});
    else
      label.push_back({"Float64", escaped(a.name), "", a.real.size() * sizeof(double),
                       [&a](std::ostream& o) { write_vector(o, a.real); }});
  }
  const std::vector<Array> point = {{"Float64", "Points", " NumberOfComponents=\"3\"",
                                     m.point.size() * sizeof(Vec3d),
                                     [&](std::ostream& o) { write_vector(o, m.point); }}};
  const bool narrow = 4 * m.tet.size() + 3 * m.tri.size() <= std::numeric_limits<int32_t>::max();
  const std::vector<Array> cell = narrow ? cell_arrays<int32_t>(m, "Int32") : cell_arrays<int64_t>(m, "Int64");

  // meshio 5 finds the owner of a block by its offset while it rewrites the offsets of earlier blocks: only with
  // the blocks in the reverse order of their declarations can no rewritten offset be taken for an original one.
  uint64_t end = 0;
  for (const auto* list : {&std::as_const(field), &std::as_const(label), &point, &cell})
    for (const Array& a : *list)
      end += sizeof a.bytes + a.bytes;
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\">\n<UnstructuredGrid>\n<FieldData>\n";
  declare(out, field, end);
  out << "</FieldData>\n<Piece NumberOfPoints=\"" << m.point.size() << "\" NumberOfCells=\""
      << m.tet.size() + m.tri.size() << "\">\n<CellData>\n";
  declare(out, label, end);
  out << "</CellData>\n<Points>\n";
  declare(out, point, end);
  out << "</Points>\n<Cells>\n";
  declare(out, cell, end);
  out << "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  for (const auto* list : {&cell, &point, &std::as_const(label), &std::as_const(field)})
    for (auto a = list->rbegin(); a != list->rend(); ++a) {
      write_bytes(out, &a->bytes, sizeof a->bytes);
      a->write(out);
    }
  out << "\n</AppendedData>\n</VTKFile>\n";
}

} // namespace molmesh::formats
