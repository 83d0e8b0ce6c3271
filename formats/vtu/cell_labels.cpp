// cell_labels.cpp — numbers labels by rank and gives them the names that the mesh has for them.
#include "formats/vtu/cell_labels.hpp"
#include "formats/vtu/names.hpp"
#include "molecule/grouping.hpp"
#include <algorithm>
#include <limits>
#include <map>

namespace molmesh::formats {
namespace {

constexpr size_t most_names = 200000;

std::vector<std::string> lines_of(const TetMesh& m, const std::string& name) {
  std::vector<std::string> lines;
  for (const NamedText& t : m.named_text)
    if (t.name == name)
      for (size_t from = 0; from < t.text.size();) {
        const size_t end = std::min(t.text.find('\n', from), t.text.size());
        lines.push_back(t.text.substr(from, end - from));
        from = end + 1;
      }
  return lines;
}

/// Values to their ranks; names by number. False where there are too many to be labels.
bool rank(CellLabel& l) {
  std::vector<int32_t> values;
  const auto collect = [&](const std::vector<int32_t>& v) {
    for (const int32_t x : v)
      if (x >= 0 && (values.empty() || values.back() != x))
        values.push_back(x);
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
  };
  collect(l.tet);
  collect(l.tri);
  if (values.size() > most_names)
    return false;
  for (std::vector<int32_t>* v : {&l.tet, &l.tri})
    for (int32_t& x : *v)
      x = x < 0 ? -1 : static_cast<int32_t>(std::lower_bound(values.begin(), values.end(), x) - values.begin());
  for (const int32_t x : values)
    l.names.push_back(std::to_string(x));
  return true;
}

CellLabel boundary_label(const TetMesh& m) {
  CellLabel l{"boundary", {}, {}, patches(m)};
  std::map<int32_t, int32_t> number;
  for (const auto& [value, name] : boundary_names(m, l.tri)) {
    number[value] = static_cast<int32_t>(l.names.size());
    l.names.push_back(name);
  }
  for (int32_t& b : l.tri)
    b = number[b];
  return l;
}

/// "//D/1(GLY)", as selections have it: names of residues are told apart by their chains only. Numbers in place of
/// names, of another program, stay.
void add_chains(const TetMesh& m, std::vector<CellLabel>& labels) {
  const CellLabel* const chain = find_label(labels, "chain");
  if (lines_of(m, "residue_names").empty() || (chain && lines_of(m, "chain_names").empty()))
    return;
  for (CellLabel& l : labels) {
    if (l.name != "residue")
      continue;
    std::vector<int32_t> chain_of(l.names.size(), -1);
    if (chain)
      for (const auto& [in, out] : {std::pair{&l.tet, &chain->tet}, std::pair{&l.tri, &chain->tri}})
        for (size_t i = 0; i < std::min(in->size(), out->size()); ++i)
          if ((*in)[i] >= 0 && (*out)[i] >= 0)
            chain_of[(*in)[i]] = (*out)[i];
    for (size_t r = 0; r < chain_of.size(); ++r)
      l.names[r] = residue_in_selection(chain_of[r] >= 0 ? chain->names[chain_of[r]] : "", l.names[r]);
  }
}

} // namespace

std::vector<CellLabel> cell_labels(const TetMesh& m) {
  std::vector<CellLabel> labels{boundary_label(m)};
  if (!m.part.empty()) {
    CellLabel part{"part", {}, m.part, {}};
    if (rank(part))
      labels.push_back(std::move(part));
  }
  const auto tets = static_cast<int64_t>(m.tet.size());
  for (const CellArray& a : m.cell_array) {
    if (a.integer.empty() || a.name == "atom" || a.name == "patch" || a.name == "boundary" || a.name == "part" ||
        a.name == "region" || a.name == "body" || a.name == "plain")
      continue;
    CellLabel l{a.name,
                lines_of(m, a.name + "_names"),
                {a.integer.begin(), a.integer.begin() + tets},
                {a.integer.begin() + tets, a.integer.end()}};
    if (!l.names.empty()) {
      const auto count = static_cast<int32_t>(l.names.size());
      for (std::vector<int32_t>* v : {&l.tet, &l.tri})
        for (int32_t& x : *v)
          x = x < 0 || x >= count ? -1 : x;
      labels.push_back(std::move(l));
    } else if (rank(l))
      labels.push_back(std::move(l));
  }
  add_chains(m, labels);
  return labels;
}

const CellLabel* find_label(const std::vector<CellLabel>& labels, const std::string& name) {
  for (const CellLabel& l : labels)
    if (l.name == name)
      return &l;
  return nullptr;
}

PlaceNames::PlaceNames(const std::vector<CellLabel>& labels) : inner_(find_label(labels, "residue")) {
  if (!inner_)
    inner_ = find_label(labels, "chain");
}

std::string PlaceNames::name(int32_t inner) const {
  return inner_ && inner >= 0 ? inner_->names[inner] : std::string();
}

std::string PlaceNames::of_tet(const TetMesh& m, int64_t tet) const {
  if (!inner_)
    return {};
  if (!inner_->tet.empty() && inner_->tet[tet] >= 0)
    return name(inner_->tet[tet]);
  const Vec3d centre = cell_centroid(m, static_cast<size_t>(tet));
  int64_t nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < inner_->tri.size(); ++i)
    if (inner_->tri[i] >= 0)
      if (const double d = norm2(cell_centroid(m, m.tet.size() + i) - centre); d < least)
        least = d, nearest = static_cast<int64_t>(i);
  return nearest < 0 ? std::string() : name(inner_->tri[nearest]);
}

std::vector<std::vector<std::string>> names_round_bodies(const TetMesh& m, const TriangleSides& sides,
                                                         const MeshBodies& bodies, const PlaceNames& places) {
  std::vector<std::map<int32_t, int64_t>> triangles(bodies.body.size());
  for (size_t i = 0; i < m.tri.size(); ++i)
    if (const int32_t r = places.triangle(static_cast<int64_t>(i)); r >= 0)
      for (const int32_t f : sides.face[i])
        if (f >= 0)
          ++triangles[bodies.of[f / 4]][r];
  std::vector<std::vector<std::string>> all;
  for (const auto& of : triangles) {
    std::vector<std::pair<int64_t, int32_t>> order;
    for (const auto& [r, n] : of)
      order.push_back({-n, r});
    std::sort(order.begin(), order.end());
    std::vector<std::string> names;
    for (const auto& [n, r] : order)
      names.push_back(places.name(r));
    all.push_back(names);
  }
  return all;
}

std::string first_of(const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < std::min(shown_names, names.size()); ++i)
    text += (i > 0 ? ", " : "") + names[i];
  return text;
}

} // namespace molmesh::formats
