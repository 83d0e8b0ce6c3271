// known_mesh.hpp — what the device knows of optimize::DynamicMesh: says what has changed since it was last told.
#pragma once
#include "cuda/optimize/flow_items.hpp"
#include <array>
#include <vector>

namespace molmesh::cuda {

/// Slots, ascending, and what they hold now.
struct ElementChanges {
  std::vector<uint32_t> slot;
  std::vector<Corners> corners;
  std::vector<uint8_t>
      faces; ///< that are surface triangles, as GatherSurfaceTriangles reads them; each in one element only
};
struct PointChanges {
  std::vector<uint32_t> slot;
  std::vector<Vec3d> at;
  std::vector<optimize::Vertex> vertex;
};

class KnownMesh {
public:
  KnownMesh(bool with_surface, int threads) : with_surface_(with_surface), threads_(threads) {}
  /// Slots in which the mesh is not as known, or of which nothing was; from now on it is.
  ElementChanges element_changes(const optimize::DynamicMesh& m);
  PointChanges point_changes(const optimize::DynamicMesh& m);
  void move(int32_t point, Vec3d to) { point_[point].at = to; }

private:
  struct Element {
    std::array<int32_t, 4> v;
    uint8_t faces;
    bool operator==(const Element&) const = default;
  };
  struct Point {
    Vec3d at;
    optimize::Vertex vertex;
    bool operator==(const Point& o) const {
      return at == o.at && vertex.kind == o.vertex.kind && vertex.frozen == o.vertex.frozen &&
             vertex.label == o.vertex.label && vertex.watched == o.vertex.watched;
    }
  };
  template <class Known, class AsItIs>
  std::vector<uint32_t> renew(std::vector<Known>& known, size_t n, const AsItIs& as_it_is) const;

  bool with_surface_;
  int threads_;
  std::vector<Element> element_;
  std::vector<Point> point_;
};

} // namespace molmesh::cuda
