// attribute_transfer.hpp — transfers cell arrays from a mesh to another one of the same body.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// Holds the cell arrays of a mesh while its elements change.
class AttributeTransfer {
public:
  /// Takes the cell arrays and named texts out of the mesh.
  explicit AttributeTransfer(TetMesh& m);
  bool empty() const { return array_.empty(); }
  /// Puts them into a mesh: each cell has the values of the cell before whose centroid is nearest to its own, among
  /// tetrahedra of its region or triangles of its boundary label; 0 where there was none. Same result at any number
  /// of threads.
  void put_into(TetMesh& m, int threads) const;
  /// "chain, residue"
  std::string names() const;

private:
  std::vector<CellArray> array_;
  std::vector<NamedText> text_;
  std::vector<Vec3d> centroid_; ///< [cells]
  std::vector<int32_t> label_;  ///< [cells] region or boundary
  size_t tets_ = 0;
};

} // namespace molmesh
