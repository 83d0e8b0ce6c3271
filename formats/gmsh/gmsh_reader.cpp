// gmsh_reader.cpp — sections of a .msh 2.2 or 4.1, ASCII or binary.
#include "formats/gmsh/gmsh.hpp"
#include "formats/vtu/cells.hpp"
#include "formats/vtu/names.hpp"
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace molmesh::formats {
namespace {

constexpr int64_t most_points = std::numeric_limits<int32_t>::max();
constexpr int64_t any_low = std::numeric_limits<int64_t>::min(), any_high = std::numeric_limits<int64_t>::max();

/// Gmsh's types of elements: their name and points; 0 points: none that is known here.
struct Kind {
  const char* name;
  int points;
};
Kind kind_of(int64_t type) {
  static constexpr Kind kind[] = {{"element", 0},
                                  {"line", 2},
                                  {"triangle", 3},
                                  {"quadrilateral", 4},
                                  {"tetrahedron", 4},
                                  {"hexahedron", 8},
                                  {"prism", 6},
                                  {"pyramid", 5},
                                  {"quadratic line", 3},
                                  {"quadratic triangle", 6},
                                  {"quadratic quadrilateral", 9},
                                  {"quadratic tetrahedron", 10},
                                  {"quadratic hexahedron", 27},
                                  {"quadratic prism", 18},
                                  {"quadratic pyramid", 14},
                                  {"point", 1}};
  if (type >= 26 && type <= 28)
    return {"line of higher order", static_cast<int>(type) - 22};
  return type >= 0 && type <= 15 ? kind[type] : kind[0];
}
bool is_dropped(int64_t type) {
  return type == 1 || type == 8 || type == 15 || (type >= 26 && type <= 28);
}

class GmshReader {
public:
  GmshReader(TextIn& in, MeshNotes& notes) : in_(in), cells_(in, notes) {}

  TetMesh read(const MeshReading& as, MeshNotes& notes) {
    format();
    for (std::string_view name; !(name = in_.word()).empty();)
      section(name);
    if (!has_elements_)
      in_.refuse("R2", "the file ends, expected $Elements");
    arrays();
    TetMesh m = cells_.finish(as);
    remove_told(m, notes);
    return m;
  }

private:
  void format() {
    in_.expect("R1", "$MeshFormat");
    const std::string_view version = in_.word();
    if (version != "2.2" && version != "4.1" && version != "2.1" && version != "2")
      in_.refuse_word("R1", version, "version 2.2 or 4.1 of the format");
    new_ = version == "4.1";
    binary_ = in_.integer("R1", "0 for text or 1 for binary", 0, 1) == 1;
    bytes_ = in_.integer("R1", "the bytes of a number", 4, 8);
    if (binary_) {
      in_.line();
      const auto one = in_.binary<int32_t>("R1", false);
      swap_ = one == 16777216;
      if (one != 1 && !swap_)
        in_.refuse("R1", "the binary 1 that tells the order of bytes is " + std::to_string(one));
      if ((new_ && bytes_ != 4 && bytes_ != 8) || (!new_ && bytes_ != 8))
        in_.refuse("R1", "numbers of " + std::to_string(bytes_) + " bytes, expected 8");
    }
    in_.expect("R2", "$EndMeshFormat");
  }

  void section(std::string_view name) {
    if (name == "$PhysicalNames")
      physical_names();
    else if (name == "$Entities" && new_)
      entities();
    else if (name == "$PartitionedEntities")
      in_.refuse("R2", "a mesh in partitions ($PartitionedEntities), expected one that is whole");
    else if (name == "$Nodes")
      nodes();
    else if (name == "$Elements")
      elements();
    else if (name == "$ElementData")
      element_data();
    else if (name.size() > 1 && name[0] == '$' && name.substr(0, 4) != "$End")
      skip(name);
    else
      in_.refuse_word("R2", name, "a section");
    in_.expect("R2", "$End" + std::string(name.substr(1)));
  }

  /// To the end of a section that is not read.
  void skip(std::string_view name) {
    const std::string end = "$End" + std::string(name.substr(1));
    const size_t at = in_.rest().find(end);
    if (at == std::string_view::npos)
      in_.refuse("R2", "the file ends within " + std::string(name) + ", expected a whole file: make it again");
    in_.skip(at);
    if (skipped_.insert(std::string(name)).second && name != "$Comments")
      cells_.pass_over("section " + std::string(name));
  }

  // Numbers in text or binary.
  int64_t integer(const char* what, int64_t least, int64_t most) {
    if (!binary_)
      return in_.integer("R3", what, least, most);
    return checked(in_.binary<int32_t>("R3", swap_), what, least, most);
  }
  int64_t size(const char* what, int64_t least, int64_t most) {
    if (!binary_)
      return in_.integer("R3", what, least, most);
    return checked(bytes_ == 8 ? in_.binary<int64_t>("R3", swap_) : in_.binary<uint32_t>("R3", swap_), what, least,
                   most);
  }
  double real(const char* what) { return binary_ ? in_.binary<double>("R3", swap_) : in_.real("R3", what); }
  double coordinate() {
    if (!binary_)
      return in_.coordinate("R6");
    const auto v = in_.binary<double>("R3", swap_);
    if (!(v >= -1e30 && v <= 1e30))
      in_.refuse("R6", "found the coordinate " + std::to_string(v) + ", expected a finite one up to 1e30");
    return v;
  }
  int64_t checked(int64_t v, const char* what, int64_t least, int64_t most) const {
    if (v < least || v > most)
      in_.refuse("R3", "found " + std::to_string(v) + ", expected " + what + ", " + std::to_string(least) + " to " +
                           std::to_string(most));
    return v;
  }
  /// A count that is followed by as many things of at least text or binary bytes each.
  int64_t count(const char* what, int64_t text, int64_t binary) {
    const int64_t n = size(what, 0, any_high);
    in_.require_room("R4", what, n, binary_ ? binary : text);
    return n;
  }
  void begin_data() {
    if (binary_)
      in_.line();
  }

  void physical_names() {
    for (int64_t n = in_.count("R4", "names", 5); n > 0; --n) {
      const int64_t dimension = in_.integer("R3", "a dimension", 0, 3);
      const auto tag = static_cast<int32_t>(in_.integer("R3", "a physical group", -most_points, most_points));
      std::string_view name = in_.line();
      if (name.size() >= 2 && name.front() == '"' && name.back() == '"')
        name = name.substr(1, name.size() - 2);
      if (dimension >= 2 && !name.empty())
        names_[dimension - 2][tag] = name;
    }
  }

  void entities() {
    begin_data();
    std::array<int64_t, 4> n{};
    for (int64_t& c : n)
      c = count("entities", 8, 36);
    for (int dimension = 0; dimension < 4; ++dimension)
      for (int64_t i = 0; i < n[dimension]; ++i) {
        const auto tag = static_cast<int32_t>(integer("an entity", -most_points, most_points));
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k)
          real("a bound");
        const int64_t groups = count("physical groups", 2, 4);
        int32_t physical = 0;
        for (int64_t g = 0; g < groups; ++g) {
          const int64_t p = integer("a physical group", -most_points, most_points);
          if (g == 0)
            physical = static_cast<int32_t>(p < 0 ? -p : p);
        }
        several_groups_ += groups > 1 && dimension >= 2;
        if (dimension >= 2)
          physical_of_[dimension - 2][tag] = physical;
        for (int64_t b = dimension == 0 ? 0 : count("bounding entities", 2, 4); b > 0; --b)
          integer("an entity", -most_points, most_points);
      }
  }

  void nodes() {
    if (point_.size() > 0)
      in_.refuse("R2", "a second $Nodes");
    if (new_) {
      begin_data();
      const int64_t blocks = count("blocks of points", 8, 12), n = count("points", 8, 24);
      size("a number", any_low, any_high);
      size("a number", any_low, any_high);
      reserve_points(n);
      for (int64_t b = 0; b < blocks; ++b) {
        const int64_t dimension = integer("a dimension", 0, 3);
        integer("an entity", -most_points, most_points);
        const bool parametric = integer("0, or 1 for parameters", 0, 1) == 1;
        const int64_t in_block = count("points", 8, 24);
        for (int64_t i = 0; i < in_block; ++i)
          point_.add(size("the number of a point", any_low, any_high));
        for (int64_t i = 0; i < in_block; ++i) {
          add_point();
          for (int64_t k = 0; parametric && k < dimension; ++k)
            real("a parameter");
        }
      }
    } else {
      const int64_t n = in_.integer("R3", "a count of points", 0, most_points);
      begin_data();
      in_.require_room("R4", "points", n, binary_ ? 28 : 8);
      reserve_points(n);
      for (int64_t i = 0; i < n; ++i) {
        point_.add(integer("the number of a point", any_low, any_high));
        add_point();
      }
    }
    if (!point_.close())
      in_.refuse("R5", "two points have the same number");
  }
  void reserve_points(int64_t n) {
    point_.reserve(static_cast<size_t>(n));
    cells_.m.point.reserve(static_cast<size_t>(n));
  }
  void add_point() {
    if (std::ssize(cells_.m.point) == most_points)
      in_.refuse("R10", "over 2^31 - 1 points");
    const double x = coordinate(), y = coordinate();
    cells_.add_point({x, y, coordinate()});
  }

  void elements() {
    if (std::exchange(has_elements_, true))
      in_.refuse("R2", "a second $Elements");
    if (point_.size() == 0)
      in_.refuse("R2", "$Elements before $Nodes, expected the points first");
    if (new_) {
      begin_data();
      const int64_t blocks = count("blocks of elements", 8, 12);
      count("elements", 4, 12);
      size("a number", any_low, any_high);
      size("a number", any_low, any_high);
      for (int64_t b = 0; b < blocks; ++b) {
        const int64_t dimension = integer("a dimension", 0, 3);
        const auto entity = static_cast<int32_t>(integer("an entity", -most_points, most_points));
        const int64_t type = integer("a type of elements", 1, 1000);
        const int64_t n = count("elements", 4, bytes_);
        int32_t physical = 0;
        if (dimension >= 2)
          if (const auto p = physical_of_[dimension - 2].find(entity); p != physical_of_[dimension - 2].end())
            physical = p->second;
        for (int64_t i = 0; i < n; ++i) {
          const int64_t number = size("the number of an element", any_low, any_high);
          element(number, type, physical, entity, [&] { return size("the number of a point", any_low, any_high); });
        }
      }
    } else {
      const int64_t n = in_.integer("R3", "a count of elements", 0, any_high);
      begin_data();
      in_.require_room("R4", "elements", n, binary_ ? 8 : 6);
      for (int64_t done = 0; done < n;) {
        int64_t number = 0, type = 0, in_block = 1, tags = 0;
        if (!binary_)
          number = in_.integer("R3", "the number of an element", any_low, any_high);
        type = integer("a type of elements", 1, 1000);
        if (binary_)
          in_block = integer("a count of elements", 1, n - done);
        tags = integer("a count of tags", 0, 1 << 20);
        for (int64_t i = 0; i < in_block; ++i, ++done) {
          if (binary_)
            number = integer("the number of an element", any_low, any_high);
          std::array<int32_t, 2> tag{};
          for (int64_t t = 0; t < tags; ++t) {
            const auto v = static_cast<int32_t>(integer("a tag", -most_points, most_points));
            if (t < 2)
              tag[t] = v;
          }
          element(number, type, tag[0] < 0 ? -tag[0] : tag[0], tag[1],
                  [&] { return integer("the number of a point", any_low, any_high); });
        }
      }
    }
  }

  template <class Next>
  void element(int64_t number, int64_t type, int32_t physical, int32_t entity, Next&& next) {
    if (is_dropped(type)) {
      for (int i = kind_of(type).points; i > 0; --i)
        next();
      cells_.drop();
      return;
    }
    if (type != 2 && type != 4)
      cells_.refuse_kind(number, std::string(kind_of(type).name) + " (type " + std::to_string(type) + ")");
    const auto corner = [&](int) {
      const int64_t p = next();
      const int32_t place = point_.place(p);
      if (place < 0)
        in_.refuse("R5", "element " + std::to_string(number) + " names point " + std::to_string(p) +
                             ", which the file does not have");
      return place;
    };
    const bool tet = type == 4;
    if (tet)
      cells_.add_tet(corner);
    else
      cells_.add_tri(corner);
    physical_[tet].push_integer(physical);
    entity_[tet].push_integer(entity);
    element_.add(number);
    is_tet_.push_back(tet);
  }

  /// Values of elements by their numbers; those that have none have 0.
  void element_data() {
    if (!has_elements_)
      in_.refuse("R2", "$ElementData before $Elements, expected the elements first");
    std::string name;
    for (int64_t n = in_.integer("R3", "a count of texts", 0, 1000), i = 0; i < n; ++i) {
      if (i == 0)
        in_.line(); // the rest of the count's
      std::string_view text = in_.line();
      if (text.size() >= 2 && text.front() == '"' && text.back() == '"')
        text = text.substr(1, text.size() - 2);
      if (i == 0)
        name = text;
    }
    for (int64_t n = in_.integer("R3", "a count of reals", 0, 1000); n > 0; --n)
      in_.real("R3", "a real");
    std::array<int64_t, 3> whole{};
    for (int64_t n = in_.integer("R3", "a count of integers", 0, 1000), i = 0; i < n; ++i) {
      const int64_t v = in_.integer("R3", "an integer", any_low, any_high);
      if (i < 3)
        whole[i] = v;
    }
    const int64_t components = checked(whole[1], "a count of components", 1, 1000), entries = whole[2];
    begin_data();
    in_.require_room("R4", "values", entries, binary_ ? 4 + 8 * components : 2 + 2 * components);
    const bool taken = components == 1 && !data_name_.contains(name) && !name.empty();
    if (!taken)
      cells_.pass_over("values '" + name + "' of elements, " +
                       (components > 1 ? std::to_string(components) + " components" : "a second time"));
    if (!closed_) {
      if (!element_.close())
        in_.refuse("R5", "two elements have the same number");
      closed_ = true;
      for (const bool tet : is_tet_)
        within_.push_back(counts_[tet]++);
    }
    std::array<Values, 2> value;
    if (taken) {
      cells_.spend(sizeof(double) * element_.size(), "'" + name + "'");
      for (const bool tet : {false, true})
        value[tet].resize(counts_[tet]);
    }
    for (int64_t i = 0; i < entries; ++i) {
      const int32_t place = element_.place(integer("the number of an element", any_low, any_high));
      for (int64_t k = 0; k < components; ++k) {
        const double v = real("a value");
        if (taken && place >= 0)
          value[is_tet_[place]].set(within_[place], v);
      }
    }
    if (taken) {
      data_name_.insert(name);
      data_.push_back(joined(name, std::move(value[1]), std::move(value[0])));
    }
  }

  void arrays() {
    TetMesh& m = cells_.m;
    if (!physical_[1].all_zero() || !physical_[0].all_zero())
      m.cell_array.push_back(joined("gmsh:physical", std::move(physical_[1]), std::move(physical_[0])));
    if (!entity_[1].all_zero() || !entity_[0].all_zero())
      m.cell_array.push_back(joined("gmsh:geometrical", std::move(entity_[1]), std::move(entity_[0])));
    for (CellArray& a : data_)
      m.cell_array.push_back(std::move(a));
    add_names(m, "patch_names", names_[0]);
    std::erase_if(names_[1], [](const auto& n) { return n.second == region_name(n.first); });
    add_names(m, "region_names", names_[1]);
    std::erase_if(m.named_text, [](const NamedText& t) { return t.text.empty(); });
    if (several_groups_ > 0)
      cells_.pass_over("all but the first physical group of " + std::to_string(several_groups_) + " entities");
  }

  /// Arrays of which `region` and `patch` have all.
  static void remove_told(TetMesh& m, const MeshNotes& notes) {
    const auto find = [&](const char* name) {
      return std::find_if(m.cell_array.begin(), m.cell_array.end(),
                          [&](const CellArray& a) { return a.name == name; });
    };
    const auto physical = find("gmsh:physical"), entity = find("gmsh:geometrical"), end = m.cell_array.end();
    const bool same = physical != end && entity != end && physical->integer == entity->integer;
    std::erase_if(m.cell_array, [&](const CellArray& a) {
      return notes.renumbered.empty() && (a.name == notes.region_array || (same && a.name == "gmsh:geometrical"));
    });
  }

  TextIn& in_;
  ForeignCells cells_;
  bool new_ = false, binary_ = false, swap_ = false, closed_ = false, has_elements_ = false;
  int64_t bytes_ = 8, several_groups_ = 0;
  std::set<std::string> skipped_, data_name_{"gmsh:physical", "gmsh:geometrical"};
  std::array<std::map<int32_t, std::string>, 2> names_;   ///< of surfaces, of volumes
  std::array<std::map<int32_t, int32_t>, 2> physical_of_; ///< entity → physical group
  Numbering point_, element_;
  std::vector<bool> is_tet_;                ///< [elements]
  std::vector<int32_t> within_;             ///< [elements] place among the triangles or the tetrahedra
  std::array<int32_t, 2> counts_{};         ///< triangles, tetrahedra
  std::array<Values, 2> physical_, entity_; ///< of triangles, of tetrahedra
  std::vector<CellArray> data_;
};

} // namespace

TetMesh read_gmsh(const std::string& text, const std::string& file, const MeshReading& as, MeshNotes& notes) {
  TextIn in(file, text);
  return GmshReader(in, notes).read(as, notes);
}

} // namespace molmesh::formats
