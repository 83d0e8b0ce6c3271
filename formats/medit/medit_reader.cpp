// medit_reader.cpp — sections of an ASCII .mesh: vertices, tetrahedra, triangles, references.
#include "formats/medit/medit.hpp"
#include "formats/vtu/cells.hpp"
#include "formats/vtu/names.hpp"
#include <array>
#include <charconv>
#include <limits>
#include <map>

namespace molmesh::formats {
namespace {

/// Sections of cells: their corners. Those of one and two corners are dropped, the others refused.
constexpr struct {
  const char* name;
  int corners;
  const char* cell;
} cell_sections[] = {{"Edges", 2, "edge"},
                     {"Quadrilaterals", 4, "quadrilateral"},
                     {"Hexahedra", 8, "hexahedron"},
                     {"Hexaedra", 8, "hexahedron"},
                     {"Prisms", 6, "prism"},
                     {"Pyramids", 5, "pyramid"},
                     {"EdgesP2", 2, "quadratic edge"},
                     {"TrianglesP2", 6, "quadratic triangle"},
                     {"TetrahedraP2", 10, "quadratic tetrahedron"}};

bool is_name(std::string_view word) {
  return !word.empty() && ((word[0] >= 'A' && word[0] <= 'Z') || (word[0] >= 'a' && word[0] <= 'z'));
}

class MeditReader {
public:
  MeditReader(TextIn& in, MeshNotes& notes) : in_(in), cells_(in, notes) {}

  TetMesh read(const MeshReading& as, MeshNotes& notes) {
    if (in_.rest().substr(0, 4) == std::string_view("\1\0\0\0", 4) ||
        in_.rest().substr(0, 4) == std::string_view("\0\0\0\1", 4))
      in_.refuse("R1", "binary MEDIT (.meshb), expected text (.mesh)");
    in_.expect("R1", "MeshVersionFormatted");
    in_.integer("R1", "a version of the format", 0, 4);
    names();
    for (std::string_view word; !(word = in_.word()).empty() && word != "End";)
      section(word);
    check_points();
    TetMesh& m = cells_.m;
    if (!reference_[1].all_zero() || !reference_[0].all_zero())
      m.cell_array.push_back(joined("medit:ref", std::move(reference_[1]), std::move(reference_[0])));
    if (!patch_names_.empty())
      add_names(m, "patch_names", patch_names_);
    if (!region_names_.empty())
      add_names(m, "region_names", region_names_);
    TetMesh mesh = cells_.finish(as);
    if (notes.renumbered.empty()) // `region` and `patch` have all of it
      std::erase_if(mesh.cell_array,
                    [&](const CellArray& a) { return a.name == "medit:ref" && a.name == notes.region_array; });
    return mesh;
  }

private:
  /// Comments in front of the first section, as we write them: "# triangles 8: active_site".
  void names() {
    std::string_view head = in_.rest();
    head = head.substr(0, head.find("\nVertices"));
    if (head.size() > 1 << 20)
      return;
    for (const auto& [key, to] : {std::pair{"\n# triangles ", &patch_names_}, {"\n# tetrahedra ", &region_names_}})
      for (size_t at = head.find(key); at != std::string_view::npos; at = head.find(key, at + 1)) {
        const std::string_view rest = head.substr(at + std::string_view(key).size());
        const std::string_view line = rest.substr(0, rest.find('\n'));
        int32_t label = 0;
        const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), label);
        const size_t used = static_cast<size_t>(end - line.data());
        if (error == std::errc{} && line.substr(used, 2) == ": " && line.size() > used + 2)
          (*to)[label] = line.substr(used + 2);
      }
  }

  void section(std::string_view word) {
    if (word == "Dimension") {
      if (const int64_t d = in_.integer("R1", "a dimension", 1, 3); d != 3)
        in_.refuse("R1", "dimension " + std::to_string(d) + ", expected 3");
      return;
    }
    if (word == "Vertices")
      return vertices();
    if (word == "Tetrahedra")
      return cells<4>();
    if (word == "Triangles")
      return cells<3>();
    for (const auto& s : cell_sections)
      if (word == s.name) {
        const int64_t n = in_.count("R4", "cells", 2);
        if (n > 0 && s.corners > 2)
          cells_.refuse_kind(1, s.cell);
        for (int64_t i = 0; i < n * (s.corners + 1); ++i)
          in_.integer("R3", "a number", std::numeric_limits<int64_t>::min(), std::numeric_limits<int64_t>::max());
        cells_.drop(n);
        return;
      }
    if (!is_name(word))
      in_.refuse_word("R2", word, "a section");
    other(word);
  }

  /// Corners, ridges, normals, what else there is: numbers up to the next word.
  void other(std::string_view word) {
    const std::string_view n = in_.peek();
    cells_.pass_over("section " + std::string(word.substr(0, 40)) +
                     (n.empty() ? "" : ", " + std::string(n.substr(0, 20))));
    while (!in_.peek().empty() && !is_name(in_.peek()))
      in_.word();
  }

  void vertices() {
    if (points_ >= 0)
      in_.refuse("R2", "a second section Vertices");
    points_ = in_.count("R4", "points", 8);
    if (points_ > std::numeric_limits<int32_t>::max())
      in_.refuse("R10", "over 2^31 - 1 points");
    cells_.m.point.reserve(static_cast<size_t>(points_));
    for (int64_t i = 0; i < points_; ++i) {
      const double x = in_.coordinate("R6"), y = in_.coordinate("R6"), z = in_.coordinate("R6");
      cells_.add_point({x, y, z});
      reference();
    }
  }

  int32_t reference() {
    constexpr int64_t most = std::numeric_limits<int32_t>::max();
    return static_cast<int32_t>(in_.integer("R3", "a reference", -most, most));
  }

  template <int N>
  void cells() {
    const int64_t n = in_.count("R4", "cells", 2 * N + 2);
    const int64_t most = points_ >= 0 ? points_ : std::numeric_limits<int32_t>::max();
    const auto corner = [&](int) {
      return static_cast<int32_t>(in_.integer("R5", "a point's number", 1, most) - 1);
    };
    for (int64_t i = 0; i < n; ++i) {
      if constexpr (N == 4)
        cells_.add_tet(corner);
      else
        cells_.add_tri(corner);
      reference_[N == 4].push_integer(reference());
    }
  }

  /// Of cells that came before the vertices.
  void check_points() const {
    if (points_ < 0)
      in_.refuse("R2", "the file ends, expected Vertices");
    const auto check = [&](const auto& cells) {
      for (const auto& c : cells)
        for (const int32_t p : c)
          if (p >= points_)
            in_.refuse("R5", "a cell names point " + std::to_string(p + int64_t{1}) + ", the file has " +
                                 std::to_string(points_));
    };
    check(cells_.m.tet);
    check(cells_.m.tri);
  }

  TextIn& in_;
  ForeignCells cells_;
  int64_t points_ = -1;             ///< -1: not read
  std::array<Values, 2> reference_; ///< of triangles, of tetrahedra
  std::map<int32_t, std::string> patch_names_, region_names_;
};

} // namespace

TetMesh read_medit(const std::string& text, const std::string& file, const MeshReading& as, MeshNotes& notes) {
  TextIn in(file, text, '#');
  return MeditReader(in, notes).read(as, notes);
}

} // namespace molmesh::formats
