// mesh_labels.hpp — labels the elements and triangles of a mesh, and names boundaries by the atoms that own them.
#pragma once
#include "label/label.hpp"
#include "mesh/tet_mesh.hpp"
#include <set>

namespace molmesh::label {

/// The cells that have labels, and their centroids: tetrahedra of the molecule, then triangles of its
/// surface. `cell` counts tetrahedra first, then triangles, as cell arrays do.
struct Places {
  std::vector<int64_t> cell;
  std::vector<Vec3d> centroid; ///< Å
  int64_t tets = 0;            ///< the first of them are tetrahedra
};
Places places_of(const TetMesh& m, int threads);

/// Adds to the mesh, for each level, the Int32 cell array NAME (index, -1 elsewhere) and the Float64 one NAME_share
/// (0 elsewhere). Throws Error(bad_input) for a level that is named like an array that the mesh has.
void add_labels(TetMesh& m, const Places& places, Labels&& labels);

/// A set of atoms whose triangles are a boundary of their own.
struct NamedBoundary {
  std::string name;
  std::vector<uint8_t> atom; ///< [atoms] 1: selected
};

struct Patches {
  int32_t first = 0;          ///< label of the first of them; the others follow
  std::vector<int64_t> count; ///< triangles of each
  std::vector<int64_t> walls; ///< of which on walls of closed cavities (mesh/cavity_walls.hpp)
  /// [boundaries] the later ones that have triangles of its atoms, ascending
  std::vector<std::set<size_t>> taken_by;
};

/// Adds the Int32 cell array `patch`: 0 for tetrahedra, `boundary` for triangles, and for those whose atom is
/// selected 8, 9, … in order (above the largest label where that is larger); later ones win. Takes atoms from
/// labels.index.back(): before add_labels.
Patches add_patches(TetMesh& m, const Places& places, const Labels& labels,
                    const std::vector<NamedBoundary>& boundary);

/// Removes what a former run added: arrays and texts of levels (those with a NAME_share and NAME_names).
void remove_labels(TetMesh& m);
/// Removes the named boundaries of a former run.
void remove_patches(TetMesh& m);

/// Median of ln(G / isovalue) at the triangles: 0 on the isosurface itself. 0 without triangles.
double median_offset(const Places& places, const Labels& labels, double isovalue);

} // namespace molmesh::label
