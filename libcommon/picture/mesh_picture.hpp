// mesh_picture.hpp — a still of a tetrahedral mesh: its surface, cut open so that whole tetrahedra show.
#pragma once
#include "mesh/tet_mesh.hpp"
#include "picture/raster.hpp"
#include <map>
#include <optional>
#include <string>

namespace molmesh::picture {

/// Colours of the surface, and what they mean.
struct Colouring {
  std::string title;         ///< "chain"
  std::vector<Rgb> triangle; ///< [triangles]; empty: all plain
  std::vector<std::pair<std::string, Rgb>> legend;
  std::map<int32_t, Rgb> region = {}; ///< of the tetrahedra at the cut; empty: by their smallest dihedral angle
};

/// What is taken away: cells of which all corners lie where every plane's dot(normal, x) > offset. One plane is a
/// plain cut, two take a wedge.
struct Cut {
  struct Plane {
    Vec3d normal;  ///< points to what is taken away
    double offset; ///< Å along the normal
  };
  std::vector<Plane> plane; ///< none: nothing is cut
};

struct View {
  double azimuth = -60, elevation = 25; ///< degrees: where the viewer stands; azimuth from +x to +y, z is up
};

struct BestView {
  View view;
  int64_t pixels = 0; ///< of a small picture; 0: hidden from all sides
};
/// From where most of the marked triangles is seen, of the side that they face on the whole and 26 others; walls of
/// the box hide nothing. marked: [triangles].
BestView best_view(const TetMesh& m, const std::vector<uint8_t>& marked, int threads);

/// Across each of these axes ("xy": a corner), takes away the share of [low, high] that faces the viewer.
Cut cut_facing(const View& view, const std::string& axes, double share, Vec3d low, Vec3d high);

struct PictureOptions {
  RasterOptions raster;
  View view;
  Cut cut;
  std::vector<int32_t> region; ///< what is shown of the mesh
  bool edges = true;
  bool caption = true; ///< title, legend, bar of lengths; none where the picture is too small for them
  std::string title;
};

/// Smallest dihedral angle of a tetrahedron, degrees; what the cut is coloured by.
double smallest_dihedral(const TetMesh& m, int64_t tet);
/// Its range over the tetrahedra of these regions; 0, 0 where there are none.
std::array<double, 2> smallest_dihedrals(const TetMesh& m, const std::vector<int32_t>& region, int threads);

/// Same bytes at any number of threads.
Image draw_mesh(const TetMesh& m, const Colouring& colouring, const PictureOptions& options, int threads);

} // namespace molmesh::picture
