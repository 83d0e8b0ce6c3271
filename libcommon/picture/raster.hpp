// raster.hpp — draws triangles into a picture: z-buffer, lights, drawn edges, shaded hollows, supersampling.
#pragma once
#include "geom/vec.hpp"
#include "picture/image.hpp"
#include <array>
#include <cstdint>
#include <vector>

namespace molmesh::picture {

/// In pixels of the picture: x to the right, y down from the upper left corner, z towards the viewer. Parallel
/// projection.
struct Scene {
  struct Facet {
    std::array<int32_t, 3> corner;
    Rgb colour;
    bool smooth; ///< lit by the normals of its corners, else by its own
  };
  std::vector<Vec3f> point;
  std::vector<Vec3f> normal; ///< [points] or empty: no facet is smooth. Either sense; length 0: the facet's own
  std::vector<Facet> facet;
  double edge_width = 0;   ///< pixels, 0: edges are not drawn
  double edge_opacity = 0; ///< 0 to 1
};

struct RasterOptions {
  int width = 1200, height = 900;
  int samples = 3;           ///< of a pixel along x and along y
  bool shade_hollows = true; ///< ambient occlusion in screen space
  Rgb background{255, 255, 255};
};

/// Both sides of a facet are lit. Of facets at the same depth the first is seen. Same bytes at any number of
/// threads.
Image draw_scene(const Scene& scene, const RasterOptions& options, int threads);

} // namespace molmesh::picture
