// names.cpp — the texts, a name a line.
#include "formats/vtu/names.hpp"
#include "formats/hier/text.hpp"
#include <algorithm>
#include <charconv>
#include <iterator>
#include <string_view>

namespace molmesh::formats {
namespace {

const char* const own_boundary[] = {"surface", "box_x0", "box_x1", "box_y0", "box_y1", "box_z0", "box_z1"};

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

void add_patch_names(TetMesh& m, const std::map<int32_t, std::string>& name) {
  std::string text;
  for (const auto& [id, n] : name) {
    text += std::to_string(id) + ' ';
    add_line(text, n);
  }
  set_text(m, "patch_names", text);
}

bool is_own_name(const std::string& name) {
  for (const int32_t region : {molecule, outside, cavity}) // groups of one name are one in some readers
    if (name == region_name(region))
      return true;
  return std::find(std::begin(own_boundary), std::end(own_boundary), name) != std::end(own_boundary);
}

std::string region_name(int32_t region) {
  static const char* const name[] = {"molecule", "outside", "cavity"};
  return region >= 1 && region <= 3 ? name[region - 1] : "region_" + std::to_string(region);
}

std::map<int32_t, std::string> boundary_names(const TetMesh& m, const std::vector<int32_t>& label) {
  std::map<int32_t, std::string> name;
  for (const int32_t l : label)
    if (auto [at, is_new] = name.try_emplace(l); is_new)
      at->second = l >= 1 && l <= 7 ? own_boundary[l - 1] : "boundary_" + std::to_string(l);
  for (const NamedText& t : m.named_text) {
    if (t.name != "patch_names")
      continue;
    for (std::string_view rest = t.text; !rest.empty();) {
      const std::string_view line = rest.substr(0, rest.find('\n'));
      rest.remove_prefix(std::min(rest.size(), line.size() + 1));
      int32_t id = 0;
      const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), id);
      const auto at = name.find(id);
      if (error == std::errc() && end != line.data() + line.size() && *end == ' ' && at != name.end())
        at->second = std::string(end + 1, line.data() + line.size());
    }
  }
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

} // namespace molmesh::formats
