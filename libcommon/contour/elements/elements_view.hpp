// elements_view.hpp — contour::Elements as plain arrays. Host and device.
#pragma once
#include "mesh/tet_mesh.hpp"
#include <array>
#include <cstdint>

namespace molmesh::contour {

/// Members as in Elements.
struct ElementsView {
  const Tet* tet = nullptr;
  int64_t tets = 0;
  const Tri* tri = nullptr;
  const std::array<int32_t, 2>* tri_sides = nullptr;
  const int32_t* boundary = nullptr;
  int64_t tris = 0;
  Vec3d* position = nullptr;
  int64_t positions = 0;
};

} // namespace molmesh::contour
