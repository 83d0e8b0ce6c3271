// mesh_labels.cpp — takes centroids out of the mesh and puts labels into it.
#include "label/mesh_labels.hpp"
#include "base/error.hpp"
#include "mesh/cavity_walls.hpp"
#include "mesh/region_order.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <set>

namespace molmesh::label {
namespace {

size_t cells(const TetMesh& m) {
  return m.tet.size() + m.tri.size();
}

} // namespace

Places places_of(const TetMesh& m, int threads) {
  Places places;
  const RegionOrder order(m);
  for (size_t t = 0; t < m.tet.size(); ++t)
    if (order.is_inside(m.region[t]))
      places.cell.push_back(static_cast<int64_t>(t));
  places.tets = static_cast<int64_t>(places.cell.size());
  for (size_t t = 0; t < m.tri.size(); ++t)
    if (m.boundary[t] == Boundary::surface)
      places.cell.push_back(static_cast<int64_t>(m.tet.size() + t));
  places.centroid.resize(places.cell.size());
  par::for_n(static_cast<int64_t>(places.cell.size()), threads, [&](int64_t i) {
    const auto s = static_cast<size_t>(i);
    places.centroid[s] = cell_centroid(m, static_cast<size_t>(places.cell[s]));
  });
  return places;
}

void add_labels(TetMesh& m, const Places& places, Labels&& labels) {
  std::set<std::string> taken{"region", "boundary", "part", "patch"};
  for (const CellArray& a : m.cell_array)
    taken.insert(a.name);
  for (const std::string& level : labels.level) // two levels may be x and x_share
    if (!taken.insert(level).second || !taken.insert(level + "_share").second)
      fail_input("level '" + level + "', expected a name that no array of the mesh has");
  for (size_t l = 0; l < labels.level.size(); ++l) {
    CellArray index{labels.level[l], std::vector<int32_t>(cells(m), -1), {}},
        share{labels.level[l] + "_share", {}, std::vector<double>(cells(m), 0)};
    for (size_t i = 0; i < places.cell.size(); ++i) {
      index.integer[places.cell[i]] = labels.index[l][i];
      share.real[places.cell[i]] = labels.share[l][i];
    }
    labels.index[l] = {};
    labels.share[l] = {};
    m.cell_array.push_back(std::move(index));
    m.cell_array.push_back(std::move(share));
  }
}

Patches add_patches(TetMesh& m, const Places& places, const Labels& labels,
                    const std::vector<NamedBoundary>& boundary) {
  Patches result;
  CellArray patch{"patch", std::vector<int32_t>(m.tet.size(), 0), {}};
  patch.integer.insert(patch.integer.end(), m.boundary.begin(), m.boundary.end());
  result.first = Boundary::box_z1 + 1;
  for (const int32_t b : m.boundary)
    result.first = std::max(result.first, b + 1);
  result.count.assign(boundary.size(), 0);
  result.walls.assign(boundary.size(), 0);
  result.taken_by.resize(boundary.size());
  const std::vector<uint8_t> wall = boundary.empty() ? std::vector<uint8_t>{} : cavity_walls(m);
  for (auto i = static_cast<size_t>(places.tets); i < places.cell.size(); ++i) {
    const int32_t atom = labels.index.back()[i];
    size_t winner = boundary.size();
    for (size_t b = boundary.size(); atom >= 0 && b-- > 0;)
      if (boundary[b].atom[atom] && winner < boundary.size())
        result.taken_by[b].insert(winner);
      else if (boundary[b].atom[atom]) {
        winner = b;
        patch.integer[places.cell[i]] = result.first + static_cast<int32_t>(b);
        ++result.count[b];
        result.walls[b] += wall[static_cast<size_t>(places.cell[i]) - m.tet.size()];
      }
  }
  m.cell_array.push_back(std::move(patch));
  return result;
}

namespace {

void remove_named(TetMesh& m, const std::set<std::string>& gone) {
  const auto is_gone = [&](const auto& a) { return gone.count(a.name) > 0; };
  m.cell_array.erase(std::remove_if(m.cell_array.begin(), m.cell_array.end(), is_gone), m.cell_array.end());
  m.named_text.erase(std::remove_if(m.named_text.begin(), m.named_text.end(), is_gone), m.named_text.end());
}

} // namespace

void remove_labels(TetMesh& m) {
  std::set<std::string> gone, texts;
  for (const NamedText& t : m.named_text)
    texts.insert(t.name);
  for (const CellArray& a : m.cell_array)
    if (const size_t n = a.name.size(); n > 6 && a.name.compare(n - 6, 6, "_share") == 0) {
      const std::string level = a.name.substr(0, n - 6);
      if (texts.count(level + "_names") > 0) // else another program's
        gone.insert({level, a.name, level + "_names"});
    }
  remove_named(m, gone);
}

void remove_patches(TetMesh& m) {
  remove_named(m, {"patch", "patch_names"});
}

double median_offset(const Places& places, const Labels& labels, double isovalue) {
  std::vector<double> ln(labels.ln_field.begin() + places.tets, labels.ln_field.end());
  if (ln.empty())
    return 0;
  const auto middle = ln.begin() + static_cast<std::ptrdiff_t>(ln.size() / 2);
  std::nth_element(ln.begin(), middle, ln.end());
  return *middle - std::log(isovalue);
}

} // namespace molmesh::label
