// names.cpp — the texts, a name a line.
#include "formats/vtu/names.hpp"
#include "base/error.hpp"
#include "formats/hier/text.hpp"
#include "mesh/region_order.hpp"
#include <algorithm>
#include <charconv>
#include <iterator>
#include <limits>
#include <string_view>

namespace molmesh::formats {
namespace {

const char* const own_boundary[] = {"surface", "box_x0", "box_x1", "box_y0", "box_y1", "box_z0", "box_z1"};
const char* const sphere_name = "sphere"; // of label outer_sphere, where the outer boundary is one

void set_text(TetMesh& m, const std::string& name, std::string text) {
  for (NamedText& t : m.named_text)
    if (t.name == name) {
      t.text = std::move(text);
      return;
    }
  m.named_text.push_back({name, std::move(text)});
}

void add_line(std::string& text, const std::string& name) {
  percent_encode(text, name);
  text += '\n';
}

} // namespace

void add_level_names(TetMesh& m, const Hierarchy& h) {
  std::string text;
  for (const Level& l : h.level) {
    text.clear();
    for (const Group& g : l.group)
      add_line(text, g.name);
    set_text(m, l.name + "_names", text);
  }
  text.clear();
  for (const Atom& a : h.atom)
    add_line(text, h.names[a.name]);
  set_text(m, "atom_names", text);
}

void add_names(TetMesh& m, const std::string& text_name, const std::map<int32_t, std::string>& name) {
  std::map<int32_t, std::string> all = names_of(m, text_name);
  for (const auto& [id, n] : name)
    all[id] = n;
  std::string text;
  for (const auto& [id, n] : all) {
    text += std::to_string(id) + ' ';
    add_line(text, n);
  }
  set_text(m, text_name, text);
}

void add_patch_names(TetMesh& m, const std::map<int32_t, std::string>& name) {
  std::erase_if(m.named_text, [](const NamedText& t) { return t.name == "patch_names"; });
  add_names(m, "patch_names", name);
}

std::map<int32_t, std::string> names_of(const TetMesh& m, const std::string& text_name) {
  std::map<int32_t, std::string> name;
  for (const NamedText& t : m.named_text) {
    if (t.name != text_name)
      continue;
    for (std::string_view rest = t.text; !rest.empty();) {
      const std::string_view line = rest.substr(0, rest.find('\n'));
      rest.remove_prefix(std::min(rest.size(), line.size() + 1));
      int32_t id = 0;
      const char* const stop = line.data() + line.size();
      const auto [end, error] = std::from_chars(line.data(), stop, id);
      if (error != std::errc() || end == stop || *end != ' ')
        continue;
      const std::string_view written(end + 1, static_cast<size_t>(stop - end - 1));
      std::string decoded;
      name[id] = percent_decode(written, decoded) ? decoded : std::string(written);
    }
  }
  return name;
}

void add_region_names(TetMesh& m, const std::string& level, const std::map<int32_t, std::string>& region,
                      const std::map<int32_t, std::string>& boundary) {
  add_names(m, "region_names", region);
  add_names(m, "boundary_names", boundary);
  set_text(m, region_level_text, level);
}

std::string region_level(const TetMesh& m) {
  for (const NamedText& t : m.named_text)
    if (t.name == region_level_text)
      return t.text;
  return {};
}

std::string own_boundary_name(const TetMesh& m, int32_t label) {
  if (m.sphere && label == Boundary::outer_sphere)
    return sphere_name;
  return label >= 1 && label <= 7 ? own_boundary[label - 1] : "";
}

int32_t own_boundary_label(const std::string& name) {
  if (name == sphere_name)
    return Boundary::outer_sphere;
  const auto at = std::find(std::begin(own_boundary), std::end(own_boundary), name);
  return at == std::end(own_boundary) ? 0 : static_cast<int32_t>(at - std::begin(own_boundary)) + 1;
}

bool is_own_name(const std::string& name) {
  for (const int32_t region : {molecule, outside, cavity}) // groups of one name are one in some readers
    if (name == region_name(region))
      return true;
  return own_boundary_label(name) != 0;
}

std::string region_name(int32_t region) {
  static const char* const name[] = {"molecule", "outside", "cavity"};
  return region >= 1 && region <= 3 ? name[region - 1] : "region_" + std::to_string(region);
}

std::map<int32_t, std::string> region_names(const TetMesh& m) {
  std::map<int32_t, std::string> name;
  for (const int32_t r : m.region)
    if (name.empty() || name.rbegin()->first != r)
      name.try_emplace(r);
  const std::map<int32_t, std::string> given = names_of(m, region_names_text);
  for (auto& [r, text] : name) {
    const auto g = given.find(r);
    text = g == given.end() ? region_name(r) : g->second;
  }
  return name;
}

std::map<int32_t, std::string> boundary_names(const TetMesh& m, const std::vector<int32_t>& label) {
  std::map<int32_t, std::string> name;
  for (const int32_t l : label)
    if (auto [at, is_new] = name.try_emplace(l); is_new)
      at->second = l >= 1 && l <= 7 ? own_boundary_name(m, l) : "boundary_" + std::to_string(l);
  for (const char* text : {"boundary_names", "patch_names"})
    for (const auto& [id, given] : names_of(m, text))
      if (const auto at = name.find(id); at != name.end())
        at->second = given;
  return name;
}

std::vector<int32_t> patches(const TetMesh& m) {
  std::vector<int32_t> label = m.boundary;
  for (const CellArray& a : m.cell_array)
    if (a.name == "patch" && a.integer.size() == m.tet.size() + m.tri.size())
      for (size_t t = 0; t < label.size(); ++t)
        if (const int32_t patch = a.integer[m.tet.size() + t]; patch > 0)
          label[t] = patch;
  return label;
}

ExportLabels export_labels(const TetMesh& m) {
  ExportLabels e;
  e.patch = patches(m);
  e.region_name = region_names(m);
  const int32_t most_region = e.region_name.empty() ? 0 : std::max(0, e.region_name.rbegin()->first);
  e.patch_name = boundary_names(m, e.patch);
  const bool own = std::any_of(e.patch_name.begin(), e.patch_name.end(),
                               [&](const auto& p) { return p.second == own_boundary_name(m, p.first); });
  const bool shared = std::any_of(e.patch_name.begin(), e.patch_name.end(),
                                  [&](const auto& p) { return e.region_name.contains(p.first); });
  if (!own && !shared)
    return e;
  int64_t step = 10;
  while (step <= most_region)
    step *= 10;
  if (!e.patch_name.empty() && e.patch_name.rbegin()->first + step > std::numeric_limits<int32_t>::max())
    fail_input("label " + std::to_string(e.patch_name.rbegin()->first) +
               " of a triangle: no number above it that is no region's, expected labels below 2^31 - " +
               std::to_string(step));
  e.step = static_cast<int32_t>(step);
  for (int32_t& p : e.patch)
    p += e.step;
  std::map<int32_t, std::string> moved;
  for (auto& [id, name] : e.patch_name)
    moved.emplace(id + e.step, std::move(name));
  e.patch_name = std::move(moved);
  return e;
}

} // namespace molmesh::formats
