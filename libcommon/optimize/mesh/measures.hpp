// measures.hpp — the dihedral angles of a whole mesh, and how close its surface is to the isosurface (I8).
#pragma once
#include "isosurface/isosurface.hpp"
#include "optimize/mesh/dynamic_mesh.hpp"
#include <string>

namespace molmesh::optimize {

struct Angles {
  double min = 180, max = 0;           ///< degrees
  int64_t below_25 = 0, above_140 = 0; ///< elements
};

/// Elements have their qualities. Same result for any number of threads.
Angles measure_angles(const DynamicMesh& mesh, int threads);

/// "24.1° to 142.3°, 2 elements under 25°, 1 over 140°"
std::string text(const Angles& a);

/// Over the curved surfaces, each triangle once. Distances are to the isosurface itself, whatever the offset.
struct Fidelity {
  int64_t points = 0; ///< free ones: where the surface touches itself or labels meet they stay as they came
  int64_t triangles = 0;
  int64_t points_off = 0;           ///< by over 0.02 spacings, or 0.0625 if they are put further out; or not known
  int64_t points_off_cavity = 0;    ///< of these, on closed cavities: where one is smaller than the grid can show
  int64_t points_off_wall = 0;      ///< and in walls that cut the surface
  int64_t centroids_off = 0;        ///< further than 0.25 spacings, or not known
  int64_t turned = 0;               ///< normals more than 45° from its own
  int64_t interface_points = 0;     ///< between domains, lines at the surface apart
  int64_t interface_points_off = 0; ///< of these, further than 0.02 spacings from where shares are equal
  double volume = 0;                ///< Å³ of the mesh's lowest region: the inside, where that is meshed
  double missing = 0; ///< Å³ that the isosurface encloses beyond that (to first order; negative: less)
  double area = 0;    ///< Å²
};

Fidelity measure_fidelity(const DynamicMesh& m, const Isosurface& surface, int threads);

/// Do more triangles of the curved surfaces face into the isosurface than out of it?
bool runs_against(const DynamicMesh& m, const Isosurface& surface, int threads);

/// Of triangles far coarser than the grid: how far outside the isosurface their points may be put, in spacings.
inline constexpr double most_coarse_offset = 0.06;

/// Chords enclose less than the surface they hang on: how far their points must lie outside it (Å, from where they
/// are now) to make up for that, at most `most` spacings in all (I8 allows 0.02).
double chord_offset(const DynamicMesh& m, const Isosurface& surface, int threads, double most = most_offset);

/// Of an equilateral triangle as large as those of the curved surfaces are on average (Å); 0 where there is none.
double mean_surface_edge(const DynamicMesh& m, int threads);

} // namespace molmesh::optimize
