// vtu_reader.cpp — tetrahedra, triangles and labels out of a VTK unstructured grid (VTUv1.md).
#include "base/error.hpp"
#include "formats/read_all.hpp"
#include "formats/vtu/cells.hpp"
#include "formats/vtu/foreign.hpp"
#include "formats/vtu/vtk_array.hpp"
#include "formats/vtu/vtu.hpp"
#include "mesh/region_order.hpp"
#include "par/pages.hpp"
#include <algorithm>
#include <cmath>
#include <istream>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace molmesh::formats {
namespace {

using namespace vtk;

constexpr double coordinate_limit = 1e30; // Å; squares and cubes of it stay finite
constexpr int64_t tet_limit = int64_t{1} << 29, point_limit = std::numeric_limits<int32_t>::max();

const ArrayTag* find(const std::vector<ArrayTag>& arrays, const char* name) {
  const auto a = std::find_if(arrays.begin(), arrays.end(), [&](const ArrayTag& t) { return t.name == name; });
  return a == arrays.end() ? nullptr : &*a;
}

bool is_without_region(const Document& d) {
  return std::any_of(d.piece.begin(), d.piece.end(),
                     [](const Piece& p) { return find(p.cell_data, "region") == nullptr; });
}

/// Arrays by their names, of several the first.
using Index = std::map<std::string_view, const ArrayTag*>;
Index index_of(const std::vector<ArrayTag>& arrays) {
  Index index;
  for (const ArrayTag& a : arrays)
    index.emplace(a.name, &a);
  return index;
}
const ArrayTag* find(const Index& index, std::string_view name) {
  const auto a = index.find(name);
  return a == index.end() ? nullptr : a->second;
}

class Reader {
public:
  Reader(const Document& d, MeshNotes& notes, CellArrays arrays)
      : d_(d), decoder_(d), notes_(notes), arrays_(arrays) {}

  TetMesh read() {
    for (const Piece& p : d_.piece)
      arrays_of_.push_back(index_of(p.cell_data));
    for (const Piece& p : d_.piece) {
      notes_.region_missing |= !find(p.cell_data, "region");
      notes_.boundary_missing |= !find(p.cell_data, "boundary");
    }
    if (arrays_ == CellArrays::keep)
      declare_arrays();
    for (const Piece& p : d_.piece)
      read_piece(p);
    for (size_t a = 0; a < m_.cell_array.size(); ++a)
      append(m_.cell_array[a], std::exchange(triangles_[a], {}));
    if (m_.tet.empty())
      d_.refuse(
          d_.piece.front().line, "R7",
          no_tetrahedron(!m_.tri.empty(), "open it in ParaView, which shows data of its points, as a potential"));
    if (m_.part.size() != m_.tet.size())
      m_.part.clear(); // pieces with and without
    read_field();
    return std::move(m_);
  }

private:
  void read_piece(const Piece& p) {
    const size_t first_point = m_.point.size();
    if (p.points > point_limit - static_cast<int64_t>(first_point))
      d_.refuse(p.line, "R10", "over 2^31 - 1 points");
    const ArrayTag& points = need(p, p.point, nullptr);
    const Column x = column(points, static_cast<uint64_t>(p.points) * 3, false);
    if (points.components != 3)
      d_.refuse(points.line, "R3", "Points with " + std::to_string(points.components) + " components, expected 3");
    reserve(m_.point, first_point + static_cast<size_t>(p.points));
    for (size_t i = 0; i < static_cast<size_t>(p.points); ++i) {
      const Vec3d v{x.real(3 * i), x.real(3 * i + 1), x.real(3 * i + 2)};
      for (int k = 0; k < 3; ++k)
        if (!(std::fabs(v[k]) <= coordinate_limit))
          d_.refuse(points.line, "R6",
                    "point " + std::to_string(i) + " has the coordinate " + std::to_string(v[k]) +
                        ", expected a finite number up to 1e30");
      m_.point.push_back(v);
    }
    read_cells(p, static_cast<int32_t>(first_point));
  }

  // And room, untouched, for a mesh that takes this one's place and is somewhat larger.
  template <class Vector>
  void reserve(Vector& v, size_t n) const {
    if (n > v.capacity() || d_.piece.size() == 1)
      par::reserve_pages(v, d_.piece.size() == 1 ? n : std::max(n, 2 * v.capacity()), n / 16, 1);
  }

  void read_cells(const Piece& p, int32_t first_point) {
    const auto cells = static_cast<uint64_t>(p.cells);
    const ArrayTag& offsets_tag = need(p, p.cell, "offsets");
    const ArrayTag& connectivity_tag = need(p, p.cell, "connectivity");
    const ArrayTag& types_tag = need(p, p.cell, "types");
    const Column types = column(types_tag, cells, true), offsets = column(offsets_tag, cells, true);
    if (cells > 0 && offsets.integer(cells - 1) < 0)
      d_.refuse(offsets_tag.line, "R8",
                "the last cell ends at corner " + std::to_string(offsets.integer(cells - 1)));
    const Column corners =
        column(connectivity_tag, cells == 0 ? 0 : static_cast<uint64_t>(offsets.integer(cells - 1)), true);
    const Labels region(*this, p, "region", notes_.region_missing),
        boundary(*this, p, "boundary", notes_.boundary_missing),
        part(*this, p, "part", find(p.cell_data, "part") == nullptr);
    size_t tets = m_.tet.size();
    for (size_t c = 0; c < cells; ++c)
      tets += types.integer(c) == 10;
    reserve(m_.tet, tets);
    reserve(m_.region, tets);
    if (part.tag)
      m_.part.reserve(tets);
    std::vector<uint8_t> kept(arrays_ == CellArrays::keep ? cells : 0, 0); // 1: tetrahedron, 2: triangle
    int64_t begin = 0;
    for (size_t c = 0; c < cells; ++c) {
      const int64_t end = offsets.integer(c), type = types.integer(c);
      if (end < begin || end > static_cast<int64_t>(corners.size()))
        d_.refuse(offsets_tag.line, "R8",
                  "cell " + std::to_string(c) + " ends at corner " + std::to_string(end) + ", expected " +
                      std::to_string(begin) + " to " + std::to_string(corners.size()));
      const auto corner = [&](int count) {
        if (end - begin != count)
          d_.refuse(offsets_tag.line, "R8",
                    "cell " + std::to_string(c) + " has " + std::to_string(end - begin) + " corners, expected " +
                        std::to_string(count));
      };
      const auto point = [&](int i) {
        const int64_t v = corners.integer(static_cast<size_t>(begin + i));
        if (v < 0 || v >= p.points)
          d_.refuse(connectivity_tag.line, "R8",
                    "cell " + std::to_string(c) + " names point " + std::to_string(v) + ", the file has " +
                        std::to_string(p.points));
        return static_cast<int32_t>(v) + first_point;
      };
      if (type == 10) {
        corner(4);
        if (m_.tet.size() == tet_limit)
          d_.refuse(p.line, "R10", "over 2^29 tetrahedra");
        m_.tet.push_back({point(0), point(1), point(2), point(3)});
        m_.region.push_back(region.positive(c, 1));
        if (!kept.empty())
          kept[c] = 1;
        if (part.tag)
          m_.part.push_back(part.at(c));
      } else if (type == 5) {
        corner(3);
        m_.tri.push_back({point(0), point(1), point(2)});
        m_.boundary.push_back(boundary.positive(c, 1));
        if (!kept.empty())
          kept[c] = 2;
      } else if (type >= 1 && type <= 4) {
        ++notes_.dropped_cells;
        if (end < begin)
          corner(0);
      } else {
        d_.refuse(types_tag.line, "R7",
                  "cell " + std::to_string(c) + " is a " + vtk_cell_name(type) + " (type " + std::to_string(type) +
                      "), expected tetrahedra (10) and triangles (5)");
      }
      begin = end;
    }
    read_arrays(p, kept);
  }

  /// The further arrays that every piece has: reals where one piece has reals.
  void declare_arrays() {
    static const std::set<std::string> own{"region", "boundary", "part", ""};
    for (const ArrayTag& first : d_.piece.front().cell_data) {
      bool everywhere = own.count(first.name) == 0 && find(arrays_of_.front(), first.name) == &first, real = false;
      for (const Index& of_piece : arrays_of_) {
        if (!everywhere)
          break;
        const ArrayTag* a = find(of_piece, first.name);
        everywhere = a && a->components == 1;
        real |= a && a->type >= ValueType::float32;
      }
      if (!everywhere)
        continue;
      m_.cell_array.push_back({first.name, {}, {}});
      real_.push_back(real);
    }
    triangles_.resize(m_.cell_array.size());
  }

  void read_arrays(const Piece& p, const std::vector<uint8_t>& kept) {
    for (size_t a = 0; a < m_.cell_array.size(); ++a) {
      const ArrayTag& tag = *find(arrays_of_[&p - d_.piece.data()], m_.cell_array[a].name);
      const Column values = column(tag, static_cast<uint64_t>(p.cells), false);
      for (size_t c = 0; c < kept.size(); ++c) {
        if (kept[c] == 0)
          continue;
        if (!real_[a] && !is_label(values.integer(c)))
          make_real(a);
        CellArray& to = kept[c] == 1 ? m_.cell_array[a] : triangles_[a];
        if (real_[a])
          to.real.push_back(values.is_integer() ? static_cast<double>(values.integer(c)) : values.real(c));
        else
          to.integer.push_back(static_cast<int32_t>(values.integer(c)));
      }
    }
  }

  /// Integers that are too wide are carried as reals.
  void make_real(size_t a) {
    real_[a] = true;
    for (CellArray* part : {&m_.cell_array[a], &triangles_[a]}) {
      part->real.assign(part->integer.begin(), part->integer.end());
      part->integer.clear();
    }
  }

  static bool is_label(int64_t v) {
    return v >= std::numeric_limits<int32_t>::min() && v <= std::numeric_limits<int32_t>::max();
  }
  int32_t label(const ArrayTag& tag, size_t c, int64_t v) const {
    if (!is_label(v))
      d_.refuse(tag.line, "R9",
                "cell " + std::to_string(c) + " has " + tag.name + ' ' + std::to_string(v) +
                    ", expected a 32-bit label");
    return static_cast<int32_t>(v);
  }

  /// Triangles behind the tetrahedra.
  static void append(CellArray& to, const CellArray& triangles) {
    to.integer.insert(to.integer.end(), triangles.integer.begin(), triangles.integer.end());
    to.real.insert(to.real.end(), triangles.real.begin(), triangles.real.end());
  }

  void read_field() {
    const auto text_of = [&](const ArrayTag& a) {
      std::string s;
      const Column c = decoder_.decode(a);
      for (size_t i = 0; i < c.size(); ++i)
        s += static_cast<char>(c.integer(i));
      return s;
    };
    const auto text = [&](const char* name) {
      const ArrayTag* const a = find(d_.field, name);
      return a ? text_of(*a) : "";
    };
    notes_.isovalue_missing = !find(d_.field, "isovalue");
    if (const ArrayTag* a = find(d_.field, "isovalue")) {
      const Column c = decoder_.decode(*a);
      if (c.size() != 1 || !std::isfinite(c.real(0)))
        d_.refuse(a->line, "R4", "isovalue is not one finite number");
      m_.isovalue = c.real(0);
    }
    if (const ArrayTag* a = find(d_.field, "decay")) // another program's may be anything
      if (const Column c = decoder_.decode(*a); c.size() == 1 && c.real(0) > 0 && std::isfinite(c.real(0)))
        m_.decay = c.real(0);
    if (const ArrayTag* a = find(d_.field, "atoms"); a && a->type == ValueType::float64)
      if (const Column c = decoder_.decode(*a); c.size() == 1 && c.real(0) > 0 && c.real(0) < 1e15)
        m_.atoms = static_cast<int64_t>(c.real(0));
    if (const ArrayTag* a = find(d_.field, "sphere"); a && a->type != ValueType::uint8)
      if (const Column c = decoder_.decode(*a); c.size() == 4) {
        const Sphere s{{c.real(0), c.real(1), c.real(2)}, c.real(3)};
        if (s.radius > 0 && std::isfinite(s.rounding()))
          m_.sphere = s;
      }
    m_.source = text("source");
    m_.creator = text("creator");
    const Index fields = index_of(d_.field);
    for (const ArrayTag& a : d_.field)
      if (a.type == ValueType::uint8 && a.components == 1 && !a.name.empty() && a.name != "source" &&
          a.name != "creator" && a.name != "isovalue" && find(fields, a.name) == &a)
        if (arrays_ == CellArrays::keep || a.name == region_names_text || a.name == region_level_text ||
            a.name == "boundary_names")
          m_.named_text.push_back({a.name, text_of(a)});
  }

  /// A label of every cell, if the piece has one.
  struct Labels {
    Labels(Reader& r, const Piece& p, const char* name, bool missing)
        : reader(r), tag(missing ? nullptr : find(p.cell_data, name)) {
      if (tag)
        values = r.column(*tag, static_cast<uint64_t>(p.cells), true);
    }
    int32_t at(size_t c) const { return reader.label(*tag, c, values.integer(c)); }
    int32_t positive(size_t c, int32_t standard) const {
      if (!tag)
        return standard;
      const int32_t v = at(c);
      if (v < 1)
        reader.d_.refuse(tag->line, "R9",
                         "cell " + std::to_string(c) + " has " + tag->name + ' ' + std::to_string(v) +
                             ", expected a positive label");
      return v;
    }
    const Reader& reader;
    const ArrayTag* tag;
    Column values;
  };

  const ArrayTag& need(const Piece& p, const std::vector<ArrayTag>& arrays, const char* name) {
    const ArrayTag* a = name ? find(arrays, name) : arrays.empty() ? nullptr : &arrays.front();
    if (!a)
      d_.refuse(p.line, "R3", std::string("a Piece without ") + (name ? name : "Points"));
    return *a;
  }

  Column column(const ArrayTag& a, uint64_t expected, bool integer) {
    Column c = decoder_.decode(a);
    if (integer && !c.is_integer())
      d_.refuse(a.line, "R5", "array '" + a.name + "' holds reals, expected integers");
    if (c.size() != expected)
      d_.refuse(a.line, "R4",
                "array '" + a.name + "' has " + std::to_string(c.size()) + " values, expected " +
                    std::to_string(expected));
    return c;
  }

  const Document& d_;
  Decoder decoder_;
  MeshNotes& notes_;
  CellArrays arrays_;
  std::vector<Index> arrays_of_;     ///< [pieces] cell data
  std::vector<bool> real_;           ///< [cell arrays]
  std::vector<CellArray> triangles_; ///< values of the triangles until all pieces are read
  TetMesh m_;
};

} // namespace

TetMesh read_vtu(const std::string& text, const std::string& file, const MeshReading& as, MeshNotes& notes) {
  const Document document = parse_document(file, text);
  notes = {};
  // Of a mesh without `region` any array may hold the regions.
  const bool all = as.arrays == CellArrays::keep || !as.region_array.empty() || is_without_region(document);
  TetMesh mesh = Reader(document, notes, all ? CellArrays::keep : CellArrays::drop).read();
  complete_mesh(mesh, file, as, notes);
  return mesh;
}

TetMesh read_vtu(std::istream& in, const std::string& file, MeshNotes* notes, CellArrays arrays) {
  MeshNotes own;
  MeshReading as;
  as.arrays = arrays;
  return read_vtu(read_all(in, file), file, as, notes ? *notes : own);
}

} // namespace molmesh::formats
