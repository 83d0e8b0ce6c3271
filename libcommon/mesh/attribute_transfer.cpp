// attribute_transfer.cpp — searches the nearest centroid in each region and boundary label with nanoflann.
#include "mesh/attribute_transfer.hpp"
#include "mesh/tet_mesh.hpp"
#include "par/par.hpp"
#include <map>
#include <memory>
#include <nanoflann.hpp>

namespace molmesh {
namespace {

int32_t label(const TetMesh& m, size_t cell) {
  return cell < m.tet.size() ? m.region[cell] : m.boundary[cell - m.tet.size()];
}

/// Some of the centroids, by their cells.
struct Chosen {
  const std::vector<Vec3d>& centroid;
  std::vector<size_t> cell;
  size_t kdtree_get_point_count() const { return cell.size(); }
  double kdtree_get_pt(size_t i, size_t axis) const { return centroid[cell[i]][static_cast<int>(axis)]; }
  template <class B>
  bool kdtree_get_bbox(B&) const {
    return false;
  }
};

struct Tree {
  using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Chosen>, Chosen, 3>;
  Chosen chosen;
  std::unique_ptr<Index> index;
};

} // namespace

AttributeTransfer::AttributeTransfer(TetMesh& m)
    : array_(std::move(m.cell_array)), text_(m.named_text), tets_(m.tet.size()) {
  m.cell_array.clear();
  if (array_.empty())
    return;
  for (size_t c = 0; c < m.tet.size() + m.tri.size(); ++c) {
    centroid_.push_back(cell_centroid(m, c));
    label_.push_back(label(m, c));
  }
}

void AttributeTransfer::put_into(TetMesh& m, int threads) const {
  m.named_text = text_;
  if (array_.empty())
    return;
  std::map<std::pair<bool, int32_t>, Tree> trees; // triangle?, label
  for (size_t c = 0; c < centroid_.size(); ++c)
    trees.try_emplace({c >= tets_, label_[c]}, Tree{{centroid_, {}}, nullptr})
        .first->second.chosen.cell.push_back(c);
  for (auto& entry : trees)
    entry.second.index = std::make_unique<Tree::Index>(3, entry.second.chosen);
  const size_t cells = m.tet.size() + m.tri.size();
  for (const CellArray& a : array_) {
    m.cell_array.push_back({a.name, {}, {}});
    m.cell_array.back().integer.resize(a.integer.empty() ? 0 : cells);
    m.cell_array.back().real.resize(a.real.empty() ? 0 : cells);
  }
  par::for_n(static_cast<int64_t>(cells), threads, [&](int64_t i) {
    const auto c = static_cast<size_t>(i);
    const auto tree = trees.find({c >= m.tet.size(), label(m, c)});
    if (tree == trees.end())
      return;
    const Vec3d p = cell_centroid(m, c);
    const double place[3] = {p.x, p.y, p.z};
    uint32_t found = 0;
    double distance2 = 0;
    tree->second.index->knnSearch(place, 1, &found, &distance2);
    const size_t from = tree->second.chosen.cell[found];
    for (size_t a = 0; a < array_.size(); ++a) {
      if (array_[a].real.empty())
        m.cell_array[a].integer[c] = array_[a].integer[from];
      else
        m.cell_array[a].real[c] = array_[a].real[from];
    }
  });
}

std::string AttributeTransfer::names() const {
  std::string names;
  for (const CellArray& a : array_)
    names += (names.empty() ? "" : ", ") + a.name;
  return names;
}

} // namespace molmesh
