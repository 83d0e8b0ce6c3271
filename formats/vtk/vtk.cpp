// vtk.cpp — an unstructured grid of the legacy format: points, cells, arrays of cells.
#include "formats/vtk/vtk.hpp"
#include "formats/hier/text.hpp"
#include "formats/vtu/cells.hpp"
#include "formats/vtu/foreign.hpp"
#include <algorithm>
#include <array>
#include <bit>
#include <deque>
#include <limits>
#include <set>

namespace molmesh::formats {
namespace {

static_assert(std::endian::native == std::endian::little, "binary data are big-endian: all of them are swapped");

constexpr int64_t any_low = std::numeric_limits<int64_t>::min(), any_high = std::numeric_limits<int64_t>::max();

struct Type {
  const char* name;
  int bytes;
  char kind; ///< integer: i, u; real: f; bit: b
};
constexpr Type types[] = {
    {"bit", 0, 'b'},         {"unsigned_char", 1, 'u'}, {"char", 1, 'i'},         {"unsigned_short", 2, 'u'},
    {"short", 2, 'i'},       {"unsigned_int", 4, 'u'},  {"int", 4, 'i'},          {"unsigned_long", 8, 'u'},
    {"long", 8, 'i'},        {"vtkIdType", 4, 'i'},     {"vtktypeint64", 8, 'i'}, {"vtktypeuint64", 8, 'u'},
    {"signed_char", 1, 'i'}, {"float", 4, 'f'},         {"double", 8, 'f'}};

class VtkReader {
public:
  VtkReader(TextIn& in, MeshNotes& notes) : in_(in), cells_(in, notes) {}

  TetMesh read(const MeshReading& as) {
    const std::string_view first = in_.line();
    if (first.substr(0, 22) != "# vtk DataFile Version")
      in_.refuse("R1", "no '# vtk DataFile Version' in the first line");
    in_.line(); // the title
    const std::string_view form = in_.word();
    if (form != "ASCII" && form != "BINARY")
      in_.refuse_word("R1", form, "ASCII or BINARY");
    binary_ = form == "BINARY";
    in_.expect("R1", "DATASET");
    if (const std::string_view set = in_.word(); set != "UNSTRUCTURED_GRID")
      in_.refuse_word("R1", set, "UNSTRUCTURED_GRID");
    for (std::string_view word; !(word = in_.word()).empty();)
      section(word);
    collect();
    return cells_.finish(as);
  }

private:
  void section(std::string_view word) {
    if (word == "POINTS")
      points();
    else if (word == "CELLS")
      cells();
    else if (word == "CELL_TYPES")
      cell_types();
    else if (word == "CELL_DATA")
      in_data_ = true, of_cells_ = true, tuples_ = in_.integer("R3", "a count of cells", 0, any_high);
    else if (word == "POINT_DATA")
      in_data_ = true, of_cells_ = false, tuples_ = in_.integer("R3", "a count of points", 0, any_high);
    else if (word == "FIELD")
      field();
    else if (word == "METADATA")
      metadata();
    else if (in_data_)
      attribute(word);
    else
      in_.refuse_word("R2", word, "a section of an unstructured grid");
  }

  /// Up to an empty line.
  void metadata() {
    in_.line();
    while (!in_.rest().empty() && !in_.line().empty()) {
    }
  }

  const Type& type(std::string_view name) const {
    for (const Type& t : types)
      if (name == t.name)
        return t;
    in_.refuse_word("R3", name, "a type of numbers");
  }

  // Values one after the other, in text or binary.
  void begin(const Type& t, int64_t n, bool in_line = true) {
    type_ = &t;
    if (binary_ && in_line)
      in_.line();
    in_.require_room("R4", "values", n, binary_ ? std::max(t.bytes, 1) : 2);
    if (binary_ && t.kind == 'b') // eight of them a byte, passed over
      in_.bytes("R4", static_cast<uint64_t>((n + 7) / 8));
  }
  double value() {
    if (!binary_)
      return in_.real("R3", "a number");
    switch (type_->bytes) {
    case 1:
      return type_->kind == 'u' ? in_.binary<uint8_t>("R4", true) : in_.binary<int8_t>("R4", true);
    case 2:
      return type_->kind == 'u' ? in_.binary<uint16_t>("R4", true) : in_.binary<int16_t>("R4", true);
    case 4:
      return type_->kind == 'f'   ? double(in_.binary<float>("R4", true))
             : type_->kind == 'u' ? double(in_.binary<uint32_t>("R4", true))
                                  : double(in_.binary<int32_t>("R4", true));
    case 8:
      return type_->kind == 'f' ? in_.binary<double>("R4", true) : double(in_.binary<int64_t>("R4", true));
    default:
      return 0;
    }
  }
  int64_t whole() {
    if (!binary_)
      return in_.integer("R3", "a whole number", any_low, any_high);
    if (type_->kind == 'f' || type_->kind == 'b')
      in_.refuse("R3", std::string("numbers of type ") + type_->name + ", expected whole ones");
    return type_->bytes == 8 ? in_.binary<int64_t>("R4", true) : static_cast<int64_t>(value());
  }

  void points() {
    if (!cells_.m.point.empty())
      in_.refuse("R2", "a second POINTS");
    const int64_t n = in_.count("R4", "points", 6);
    if (n > std::numeric_limits<int32_t>::max())
      in_.refuse("R10", "over 2^31 - 1 points");
    const Type& t = type(in_.word());
    begin(t, 3 * n);
    cells_.m.point.reserve(static_cast<size_t>(n));
    for (int64_t i = 0; i < n; ++i) {
      const double x = coordinate(), y = coordinate();
      cells_.add_point({x, y, coordinate()});
    }
  }
  double coordinate() {
    if (!binary_)
      return in_.coordinate("R6");
    const double v = value();
    if (!(v >= -1e30 && v <= 1e30))
      in_.refuse("R6", "found the coordinate " + std::to_string(v) + ", expected a finite one up to 1e30");
    return v;
  }

  /// Old: count and corners of each cell, one after the other. Since version 5: offsets, then corners.
  void cells() {
    if (!offset_.empty())
      in_.refuse("R2", "a second CELLS");
    const int64_t n = in_.count("R4", "cells", 1), size = in_.count("R4", "numbers of cells", 1);
    if (binary_)
      in_.line(); // before anything is looked at: the data may begin with what looks like blanks
    if (binary_ ? in_.rest().substr(0, 7) == "OFFSETS" : in_.peek() == "OFFSETS") {
      in_.word();
      begin(type(in_.word()), n);
      for (int64_t i = 0; i < n; ++i)
        offset_.push_back(whole());
      in_.expect("R2", "CONNECTIVITY");
      begin(type(in_.word()), size);
      for (int64_t i = 0; i < size; ++i)
        corner_.push_back(point());
    } else {
      begin(type("int"), size, false);
      offset_.push_back(0);
      for (int64_t left = size; left > 0;) {
        const int64_t corners = whole();
        if (corners < 0 || corners >= left)
          in_.refuse("R5", "a cell of " + std::to_string(corners) + " corners, expected 0 to " +
                               std::to_string(left - 1));
        for (int64_t i = 0; i < corners; ++i)
          corner_.push_back(point());
        left -= corners + 1;
        offset_.push_back(std::ssize(corner_));
      }
      if (std::ssize(offset_) != n + 1)
        in_.refuse("R4", std::to_string(offset_.size() - 1) + " cells, expected " + std::to_string(n));
    }
    int64_t before = 0;
    for (const int64_t o : offset_) {
      if (o < before || o > std::ssize(corner_))
        in_.refuse("R5", "an offset of " + std::to_string(o) + ", expected " + std::to_string(before) + " to " +
                             std::to_string(corner_.size()));
      before = o;
    }
  }
  int32_t point() {
    const int64_t p = whole();
    if (p < 0 || p > std::numeric_limits<int32_t>::max())
      in_.refuse("R5", "a cell names point " + std::to_string(p));
    return static_cast<int32_t>(p);
  }

  void cell_types() {
    if (!kept_.empty())
      in_.refuse("R2", "a second CELL_TYPES");
    const int64_t n = in_.count("R4", "types", 1);
    begin(type("int"), n);
    for (int64_t c = 0; c < n; ++c) {
      const int64_t t = whole();
      if (t != 5 && t != 10 && !(t >= 1 && t <= 4))
        cells_.refuse_kind(c, std::string(vtk_cell_name(t)) + " (type " + std::to_string(t) + ")");
      kept_.push_back(static_cast<uint8_t>(t));
    }
  }

  /// Arrays with a name, components and tuples of their own.
  void field() {
    in_.word();
    for (int64_t n = in_.integer("R3", "a count of arrays", 0, 1 << 20); n > 0; --n) {
      while (in_.peek() == "METADATA") {
        in_.word();
        metadata();
      }
      const std::string name = decoded(in_.word());
      const int64_t components = in_.integer("R3", "a count of components", 0, 1 << 20),
                    tuples = in_.integer("R3", "a count of values", 0, int64_t{1} << 40);
      array(name, components, tuples, in_.word());
    }
  }

  void attribute(std::string_view word) {
    std::string name = decoded(in_.word());
    if (word == "SCALARS") {
      const std::string_view t = in_.word();
      const int64_t components = in_.peek() == "LOOKUP_TABLE" ? 1 : in_.integer("R3", "components", 1, 4);
      in_.expect("R2", "LOOKUP_TABLE");
      in_.word();
      array(name, components, tuples_, t);
    } else if (word == "LOOKUP_TABLE") {
      const int64_t n = in_.count("R4", "colors", 1);
      skip(type(binary_ ? "unsigned_char" : "float"), 4 * n);
    } else if (word == "COLOR_SCALARS") {
      const int64_t n = in_.integer("R3", "components", 1, 4);
      skip(type(binary_ ? "unsigned_char" : "float"), n * tuples_);
    } else if (word == "VECTORS" || word == "NORMALS") {
      array(name, 3, tuples_, in_.word());
    } else if (word == "TENSORS" || word == "TENSORS6") {
      array(name, word == "TENSORS" ? 9 : 6, tuples_, in_.word());
    } else if (word == "TEXTURE_COORDINATES") {
      const int64_t n = in_.integer("R3", "components", 1, 3);
      array(name, n, tuples_, in_.word());
    } else if (word == "GLOBAL_IDS" || word == "PEDIGREE_IDS" || word == "EDGE_FLAGS") {
      array(name, 1, tuples_, in_.word());
    } else {
      in_.refuse_word("R2", word, "values of cells or points");
    }
  }

  void skip(const Type& t, int64_t n) {
    begin(t, n);
    for (int64_t i = 0; i < n && !(binary_ && t.kind == 'b'); ++i)
      value();
  }

  /// One value a cell is kept; the others are passed over, those of cells aloud.
  void array(const std::string& name, int64_t components, int64_t tuples, std::string_view type_name) {
    if (type_name == "string" || type_name == "utf8_string" || type_name == "variant") {
      if (binary_)
        in_.refuse("R3", "array '" + name + "' of binary texts, expected numbers");
      in_.line();
      for (int64_t i = 0; i < components * tuples && !in_.rest().empty(); ++i)
        in_.line();
      return;
    }
    const Type& t = type(type_name);
    if (components > 0 && tuples > (int64_t{1} << 40) / components)
      in_.refuse("R4", std::to_string(tuples) + " values of " + std::to_string(components) +
                           " components, expected a whole file: make it again");
    const bool wanted = in_data_ && of_cells_;
    if (!wanted || components != 1 || t.kind == 'b' || !names_.insert(name).second) {
      if (wanted)
        cells_.pass_over("values '" + name + "' of cells, " + std::to_string(components) + " components");
      return skip(t, components * tuples);
    }
    begin(t, tuples);
    cells_.spend(4 * static_cast<uint64_t>(tuples), "'" + name + "'");
    array_.push_back({name, {}});
    for (int64_t i = 0; i < tuples; ++i)
      array_.back().second.push(value());
  }

  static std::string decoded(std::string_view name) {
    std::string s;
    return percent_decode(name, s) ? s : std::string(name);
  }

  /// Cells and their values, when all sections are read.
  void collect() {
    if (kept_.size() + 1 != offset_.size() && !(kept_.empty() && offset_.empty()))
      in_.refuse("R4", std::to_string(kept_.size()) + " types of cells, expected " +
                           std::to_string(offset_.empty() ? 0 : offset_.size() - 1));
    const int64_t points = std::ssize(cells_.m.point);
    for (size_t c = 0; c < kept_.size(); ++c) {
      const int64_t first = offset_[c], corners = offset_[c + 1] - first;
      if (kept_[c] <= 4) {
        cells_.drop();
        continue;
      }
      const int64_t expected = kept_[c] == 10 ? 4 : 3;
      if (corners != expected)
        in_.refuse("R5", "cell " + std::to_string(c) + " has " + std::to_string(corners) + " corners, expected " +
                             std::to_string(expected));
      const auto corner = [&](int i) {
        const int32_t p = corner_[first + i];
        if (p >= points)
          in_.refuse("R5", "cell " + std::to_string(c) + " names point " + std::to_string(p) + ", the file has " +
                               std::to_string(points));
        return p;
      };
      kept_[c] == 10 ? cells_.add_tet(corner) : cells_.add_tri(corner);
    }
    names_.clear();
    cells_.m.cell_array.reserve(array_.size());
    for (auto& [name, values] : array_) {
      if (values.size() != kept_.size())
        in_.refuse("R4", "array '" + name + "' has " + std::to_string(values.size()) + " values, expected " +
                             std::to_string(kept_.size()));
      std::array<Values, 2> of;
      for (size_t c = 0; c < kept_.size(); ++c)
        if (kept_[c] > 4)
          of[kept_[c] == 10].push(values.get(c));
      values = {};
      cells_.m.cell_array.push_back(joined(name, std::move(of[1]), std::move(of[0])));
    }
  }

  TextIn& in_;
  ForeignCells cells_;
  bool binary_ = false, in_data_ = false, of_cells_ = false;
  int64_t tuples_ = 0;
  const Type* type_ = nullptr;  ///< of the values that are read
  std::vector<int64_t> offset_; ///< [cells + 1]
  std::vector<int32_t> corner_;
  std::vector<uint8_t> kept_; ///< [cells] VTK's type
  std::set<std::string> names_;
  std::deque<std::pair<std::string, Values>> array_;
};

} // namespace

TetMesh read_vtk(const std::string& text, const std::string& file, const MeshReading& as, MeshNotes& notes) {
  TextIn in(file, text);
  return VtkReader(in, notes).read(as);
}

} // namespace molmesh::formats
