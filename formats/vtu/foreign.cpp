// foreign.cpp — regions out of other arrays, merged points, rebuilt triangles and those of the file among them.
#include "formats/vtu/foreign.hpp"
#include "base/error.hpp"
#include "base/small_letters.hpp"
#include "formats/vtu/names.hpp"
#include "geom/tet_measures.hpp"
#include "mesh/adjacency.hpp"
#include "mesh/fitted_sphere.hpp"
#include "mesh/sorted_triangle.hpp"
#include "mesh/validity_duplicates.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

namespace molmesh::formats {
namespace {

/// Where programs keep regions; the first that a file has is taken. Letters of any case.
constexpr const char* usual_names[] = {
    "region",          "gmsh:physical", "medit:ref",    "MaterialIds",     "MaterialID",   "material_id",
    "material",        "CellEntityIds", "PhysicalIds",  "physical",        "tetgen:ref",   "cell_tags",
    "attribute",       "MeshDomain",    "subdomain_id", "subdomain",       "SubdomainId",  "RegionId",
    "regions",         "Label",         "elem_tags",    "avsucd:material", "block_id",     "BlockId",
    "ElementBlockIds", "ObjectId",      "labels",       "marker",          "cell_scalars", "gmsh:geometrical"};

bool same_letters(const std::string& a, const char* b) {
  return small_letters(a) == small_letters(b);
}

bool whole(double v) {
  return v == std::floor(v) && std::fabs(v) < 2147483648.;
}

/// Integers, or reals that are: some programs know no other arrays.
bool holds_labels(const CellArray& a) {
  return a.real.empty() || std::all_of(a.real.begin(), a.real.end(), whole);
}

/// Whole numbers of which some are no 32-bit integers: labels that cannot be regions.
bool holds_large_labels(const CellArray& a) {
  return !holds_labels(a) && std::all_of(a.real.begin(), a.real.end(), [](double v) { return v == std::floor(v); });
}

int32_t label_of(const CellArray& a, size_t cell) {
  return a.real.empty() ? a.integer[cell] : static_cast<int32_t>(a.real[cell]);
}

const CellArray* find_array(const TetMesh& m, const std::string& name) {
  for (const CellArray& a : m.cell_array)
    if (a.name == name)
      return &a;
  return nullptr;
}

const CellArray* asked_array(const TetMesh& m, const std::string& file, const std::string& name) {
  const CellArray* const a = find_array(m, name);
  std::string known;
  size_t listed = 0;
  for (const CellArray& other : m.cell_array)
    if (holds_labels(other) && listed++ < 20)
      known += (known.empty() ? "'" : ", '") + other.name + "'";
  if (!a || !holds_labels(*a))
    fail(Status::bad_input,
         file + ": " +
             (a ? "the cell array '" + name + "' holds no integers" + (holds_large_labels(*a) ? " of 32 bits" : "")
                : "no cell array '" + name + "'") +
             ", expected " + (known.empty() ? "one of integers, and the file has none" : "one of " + known),
         {"region-array"});
  return a;
}

const CellArray* usual_array(const TetMesh& m) {
  for (const char* const name : usual_names)
    for (const CellArray& a : m.cell_array)
      if (same_letters(a.name, name) && holds_labels(a))
        return &a;
  return nullptr;
}

/// Regions of the tetrahedra; values below 1 get the next free numbers.
void take_regions(TetMesh& m, const CellArray& a, MeshNotes& notes) {
  std::set<int32_t> below;
  int32_t most = 0;
  for (size_t t = 0; t < m.tet.size(); ++t) {
    const int32_t v = label_of(a, t);
    m.region[t] = v;
    most = std::max(most, v);
    if (v < 1 && below.size() < 1000)
      below.insert(v);
  }
  for (const int32_t v : below)
    notes.renumbered[v] = most < std::numeric_limits<int32_t>::max() ? ++most : most;
  for (int32_t& r : m.region)
    if (r < 1)
      r = notes.renumbered.contains(r) ? notes.renumbered[r] : most;
  notes.region_array = a.name;
}

/// The labels of the file's triangles for boundary conditions, where the array of the regions has some.
bool take_patches(TetMesh& m, const CellArray& a) {
  CellArray patch{"patch", std::vector<int32_t>(m.tet.size() + m.tri.size()), {}};
  bool any = false;
  for (size_t t = m.tet.size(); t < patch.integer.size(); ++t)
    any |= (patch.integer[t] = std::max(0, label_of(a, t))) > 0;
  if (any)
    m.cell_array.push_back(std::move(patch));
  return any;
}

void choose_regions(TetMesh& m, const std::string& file, const MeshReading& as, MeshNotes& notes) {
  if (!as.region_array.empty() && !(as.region_array == "region" && !notes.region_missing)) {
    take_regions(m, *asked_array(m, file, as.region_array), notes);
    return;
  }
  if (!notes.region_missing)
    return;
  if (const CellArray* const a = usual_array(m)) {
    take_regions(m, *a, notes);
    return;
  }
  for (const CellArray& a : m.cell_array)
    if (const auto differ =
            [&](const auto& v) {
              return std::any_of(v.begin(), v.begin() + std::ssize(m.tet), [&](auto x) { return x != v[0]; });
            };
        a.name != "patch" && ((a.real.empty() && differ(a.integer)) || (holds_large_labels(a) && differ(a.real))))
      notes.several.push_back(a.name);
}

/// Do all tetrahedra have the order of corners of those programs that look from the other side?
bool all_turned(const TetMesh& m) {
  return std::all_of(m.tet.begin(), m.tet.end(), [&](const Tet& t) {
    return tet_volume(m.point[t[0]], m.point[t[1]], m.point[t[2]], m.point[t[3]]) < 0;
  });
}

/// Points with the coordinates of an earlier one are that one.
void merge(TetMesh& m, const std::vector<int32_t>& twin) {
  std::vector<int32_t> number(m.point.size());
  int32_t n = 0;
  for (size_t p = 0; p < m.point.size(); ++p) {
    number[p] = twin[p] < 0 ? n : number[twin[p]];
    if (twin[p] < 0)
      m.point[n++] = m.point[p];
  }
  m.point.resize(n);
  for (Tet& t : m.tet)
    for (int32_t& p : t)
      p = number[p];
  for (Tri& t : m.tri)
    for (int32_t& p : t)
      p = number[p];
}

/// label(t) of rebuilt triangles; 0: as it is. They look out as their labels say.
template <class Label>
void relabel(TetMesh& m, const Label& label) {
  const LargeArray<int32_t> across = face_neighbors(m, 1);
  size_t next = 0; // as rebuild_triangles counts them
  for (const int64_t face : boundary_faces(m, across, 1)) {
    const int32_t region = m.region[face / 4], other = region_across(m, across, face);
    if (other != 0 && region >= other)
      continue;
    const size_t t = next++;
    const int32_t l = label(t);
    if (l == 0)
      continue;
    m.boundary[t] = l;
    m.tri[t] = face_points(m, face);
    if (!triangle_looks_out(RegionOrder(), region, other, l))
      std::swap(m.tri[t][1], m.tri[t][2]);
  }
}

/// Triangles anew, with the values of those of the file that are among them. Of others nothing is known, but for
/// what `patch` is by itself. Returns which triangle of the file each is, -1: none.
std::vector<int32_t> take_rebuilt_triangles(TetMesh& m, MeshNotes& notes) {
  const std::vector<Tri> before = std::move(m.tri);
  const std::vector<int32_t> label_before = std::move(m.boundary);
  rebuild_triangles(m);
  label_walls(m);
  const TriangleNumbers of_before(before, [](size_t t) { return static_cast<int32_t>(t); });
  std::vector<int32_t> same;
  same.reserve(m.tri.size());
  for (const Tri& t : m.tri) {
    const int32_t* const found = of_before.find(t);
    same.push_back(found ? *found : -1);
  }
  if (!notes.boundary_missing)
    relabel(m, [&](size_t t) { return same[t] < 0 ? 0 : label_before[same[t]]; });
  notes.triangles = static_cast<int64_t>(before.size());
  notes.dropped_triangles = notes.triangles - (std::ssize(same) - std::count(same.begin(), same.end(), -1));
  const size_t tets = m.tet.size();
  for (CellArray& a : m.cell_array) {
    const auto take = [&](auto& values, auto standard) {
      const std::vector of_file(values.begin() + static_cast<std::ptrdiff_t>(tets), values.end());
      values.resize(tets);
      for (size_t t = 0; t < same.size(); ++t)
        values.push_back(same[t] >= 0 ? of_file[same[t]] : standard(t));
    };
    if (a.real.empty())
      take(a.integer, [&](size_t t) { return a.name == "patch" ? m.boundary[t] : 0; });
    else
      take(a.real, [](size_t) { return 0.; });
  }
  return same;
}

/// Which triangles have a label of the file; the others get their own.
std::vector<uint8_t> tag_triangles(TetMesh& m, const std::vector<int32_t>& same) {
  std::vector<int32_t>& patch = m.cell_array.back().integer;
  std::vector<uint8_t> tagged(m.tri.size());
  for (size_t t = 0; t < m.tri.size(); ++t) {
    int32_t& p = patch[m.tet.size() + t];
    tagged[t] = same[t] >= 0 && p > 0;
    if (!tagged[t])
      p = m.boundary[t];
  }
  return tagged;
}

/// The sphere through the points of a patch, by least squares: true and the mesh's if they are on it.
bool take_sphere(TetMesh& m, int32_t number) {
  const std::vector<int32_t>& patch = m.cell_array.back().integer;
  std::vector<int32_t> on;
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (patch[m.tet.size() + t] == number)
      on.insert(on.end(), m.tri[t].begin(), m.tri[t].end());
  std::sort(on.begin(), on.end());
  on.erase(std::unique(on.begin(), on.end()), on.end());
  const std::optional<Sphere> sphere = sphere_through(m.point, on);
  if (!sphere)
    return false;
  m.sphere = sphere;
  return true;
}

/// Labels of the file that have names of ours are ours, whatever their numbers were made in that format. Where
/// nothing else is left, the array goes. Returns whether it stays.
bool take_own_labels(TetMesh& m, std::vector<uint8_t>& tagged) {
  std::vector<int32_t>& patch = m.cell_array.back().integer;
  const size_t tets = m.tet.size();
  const std::map<int32_t, std::string> names = names_of(m, "patch_names");
  std::map<int32_t, int32_t> own; // number in the file → label
  for (const auto& [number, name] : names)
    if (const int32_t label = own_boundary_label(name); label != 0 && (name != "sphere" || take_sphere(m, number)))
      own[number] = label;
  if (own.empty())
    return true;
  const int32_t shift = own.begin()->first - own.begin()->second;
  const bool shifted =
      shift > 0 && std::all_of(own.begin(), own.end(), [&](const auto& o) { return o.first - o.second == shift; });
  const auto label_of_file = [&](int32_t number) {
    const auto o = own.find(number);
    return o != own.end() ? o->second : shifted && number > shift + 7 ? number - shift : number;
  };
  relabel(m, [&](size_t t) {
    const auto o = tagged[t] ? own.find(patch[tets + t]) : own.end();
    return o == own.end() ? 0 : o->second;
  });
  bool only_own = true;
  for (size_t t = 0; t < tagged.size(); ++t) {
    int32_t& p = patch[tets + t];
    const bool is_own = tagged[t] && own.contains(p);
    p = tagged[t] ? label_of_file(p) : m.boundary[t];
    tagged[t] = tagged[t] && !is_own;
    only_own &= p == m.boundary[t];
  }
  std::map<int32_t, std::string> others;
  for (const auto& [number, name] : names)
    if (!own.contains(number))
      others[label_of_file(number)] = name;
  std::erase_if(m.named_text, [](const NamedText& t) { return t.name == "patch_names"; });
  if (!others.empty())
    add_names(m, "patch_names", others);
  if (only_own)
    m.cell_array.pop_back();
  return !only_own;
}

/// Where a label of the file has the number of one of ours that other triangles have, ours go up.
void part_labels(TetMesh& m, const std::vector<uint8_t>& tagged) {
  std::vector<int32_t>& patch = m.cell_array.back().integer;
  const size_t tets = m.tet.size();
  std::set<int32_t> own;
  int32_t most = *std::max_element(m.region.begin(), m.region.end()); // nor are regions met
  bool clash = false;
  for (size_t t = 0; t < tagged.size(); ++t)
    if (!tagged[t])
      own.insert(m.boundary[t]);
  for (size_t t = 0; t < tagged.size(); ++t)
    if (tagged[t]) {
      most = std::max(most, patch[tets + t]);
      clash |= own.contains(patch[tets + t]);
    }
  if (!clash || most > std::numeric_limits<int32_t>::max() - 7)
    return;
  std::map<int32_t, std::string> name;
  for (size_t t = 0; t < tagged.size(); ++t)
    if (!tagged[t]) {
      patch[tets + t] += most;
      name[patch[tets + t]] = own_boundary_name(m, m.boundary[t]);
    }
  add_names(m, "patch_names", name);
}

} // namespace

const char* vtk_cell_name(int64_t type) {
  switch (type) {
  case 5:
    return "triangle";
  case 6:
    return "strip of triangles";
  case 7:
    return "polygon";
  case 8:
    return "pixel";
  case 9:
    return "quadrilateral";
  case 10:
    return "tetrahedron";
  case 11:
    return "voxel";
  case 12:
    return "hexahedron";
  case 13:
    return "wedge";
  case 14:
    return "pyramid";
  case 22:
    return "quadratic triangle";
  case 24:
    return "quadratic tetrahedron";
  case 42:
    return "polyhedron";
  default:
    return "cell";
  }
}

void complete_mesh(TetMesh& m, const std::string& file, const MeshReading& as, MeshNotes& notes) {
  const bool foreign = notes.region_missing && notes.boundary_missing;
  choose_regions(m, file, as, notes);
  bool patches_taken = false;
  if (notes.boundary_missing && !notes.region_array.empty() && !find_array(m, "patch"))
    patches_taken = take_patches(m, *find_array(m, notes.region_array));
  if (foreign && all_turned(m)) {
    for (Tet& t : m.tet)
      std::swap(t[2], t[3]);
    notes.turned = true;
  }
  const std::vector<int32_t> twin = point_twins(m.point, 1);
  notes.duplicate_points = std::ssize(twin) - std::count(twin.begin(), twin.end(), -1);
  notes.merged = as.merge_points && notes.duplicate_points > 0;
  if (notes.merged)
    merge(m, twin);
  if (notes.boundary_missing || notes.merged || !notes.region_array.empty()) {
    const std::vector<int32_t> same = take_rebuilt_triangles(m, notes);
    if (patches_taken) {
      std::vector<uint8_t> tagged = tag_triangles(m, same);
      if (take_own_labels(m, tagged))
        part_labels(m, tagged);
    }
  }
  if (as.scale != 1) {
    for (Vec3d& p : m.point)
      p = as.scale * p;
    m.decay /= as.scale * as.scale; // per unit squared
    if (m.sphere)
      m.sphere = Sphere{as.scale * m.sphere->center, as.scale * m.sphere->radius};
  }
  if (as.arrays == CellArrays::drop) {
    m.cell_array.clear();
    std::erase_if(m.named_text, [](const NamedText& t) { // what regions are is no further text
      return t.name != region_names_text && t.name != region_level_text && t.name != "boundary_names";
    });
  }
}

std::vector<std::string> described(const MeshNotes& notes) {
  std::vector<std::string> lines;
  if (notes.dropped_cells > 0)
    lines.push_back("dropped " + std::to_string(notes.dropped_cells) + " vertices and lines");
  for (const std::string& what : notes.passed_over)
    lines.push_back("passed over: " + what);
  if (!notes.region_array.empty()) {
    std::string text = "regions are the values of '" + notes.region_array + "'";
    int shown = 0;
    for (const auto& [value, region] : notes.renumbered)
      if (shown++ < 8)
        text += (value == notes.renumbered.begin()->first ? ", with " : ", ") + std::to_string(region) + " for " +
                std::to_string(value);
    lines.push_back(text);
  }
  if (!notes.several.empty()) {
    std::string text = "one region for all, though cells have several values of ";
    constexpr size_t most = 8;
    for (size_t i = 0; i < std::min(most, notes.several.size()); ++i)
      text += (i == 0 ? "'" : ", '") + notes.several[i] + "'";
    if (notes.several.size() > most)
      text += " and " + std::to_string(notes.several.size() - most) + " more";
    lines.push_back(text + ": --region-array NAME makes regions of one");
  }
  if (notes.turned)
    lines.push_back("every tetrahedron had a negative volume: two corners of each changed places");
  if (notes.duplicate_points > 0)
    lines.push_back(
        std::to_string(notes.duplicate_points) + " points have the coordinates of others: " +
        (notes.merged ? "merged" : "pieces that touch there are not joined; --merge-points merges them"));
  if (notes.dropped_triangles > 0)
    lines.push_back((notes.boundary_missing ? "the file has no array 'boundary': of its " : "of the file's ") +
                    std::to_string(notes.triangles) + " triangles " + std::to_string(notes.dropped_triangles) +
                    " dropped, on no boundary of a region");
  return lines;
}

} // namespace molmesh::formats
