// resident_mesh.hpp — optimize::DynamicMesh in a Backend's memory, slot by slot: between two rounds only what has
// changed goes up, and only what has moved comes down.
#pragma once
#include "cuda/optimize/known_mesh.hpp"
#include "cuda/par/backend.hpp"
#include "par/items.hpp"
#include "par/passes.hpp"
#include <utility>
#include <vector>

namespace molmesh::cuda {

template <class Backend>
class ResidentMesh {
  template <class T>
  using Array = typename Backend::template Array<T>;
  template <class T>
  using List = par::List<Backend, T>;

public:
  /// threads: of the host, which looks for what has changed.
  ResidentMesh(Backend& b, bool with_surface, int threads) : b_(b), known_(with_surface, threads) {}

  /// As the mesh is now.
  void update(const optimize::DynamicMesh& m) {
    has_moved = {};
    triangles = {};
    const int64_t had = std::exchange(elements, static_cast<int64_t>(m.element.size())),
                  had_points = std::exchange(points, static_cast<int64_t>(m.point.size()));
    if (4 * elements > int64_t{1} << 32)
      fail(Status::failed, "mode cuda: the mesh has more than 2^30 elements, use seq or omp", {"mode"});
    const ElementChanges e = known_.element_changes(m);
    send(e.slot, e.corners, had, elements, corners);
    send(e.slot, e.faces, had, elements, faces_);
    const PointChanges p = known_.point_changes(m);
    send(p.slot, p.at, had_points, points, point);
    send(p.slot, p.vertex, had_points, points, vertex);
    triangles = par::gather<SurfaceTriangle>(b_, "surface triangles", elements,
                                             GatherSurfaceTriangles{corners.data(), faces_.data()});
    has_moved = b_.filled(points, uint8_t{0});
  }
  /// What has moved, and the qualities of the elements there; they count as never tried.
  void give_back(optimize::DynamicMesh& m) {
    const auto moved = par::flagged(b_, "moved points", points, has_moved.data());
    const Array<Vec3d> place = b_.template array<Vec3d>(moved.n);
    b_.for_n("moved points", moved.n,
             par::Gather<Vec3d>{point.data(), reinterpret_cast<const uint32_t*>(moved.data()), place.data()},
             {double(moved.n) * 52});
    const std::vector<int32_t> slot = on_host(moved.array, moved.n);
    const std::vector<Vec3d> to = on_host(place, moved.n);
    for (size_t i = 0; i < slot.size(); ++i) {
      m.point[slot[i]] = to[i];
      known_.move(slot[i], to[i]);
    }
    const auto changed = par::gather<NewQuality>(
        b_, "new qualities", elements, GatherNewQualities{corners.data(), point.data(), has_moved.data()});
    for (const NewQuality& n : on_host(changed.array, changed.n)) {
      optimize::Element& e = m.element[n.element];
      e.q = n.q;
      m.note_change(n.element);
      e.tried = 0;
    }
  }

  int64_t elements = 0, points = 0; ///< slots
  Array<Corners> corners;
  Array<Vec3d> point;
  Array<optimize::Vertex> vertex;
  Array<uint8_t> has_moved; ///< [points] since the update
  List<SurfaceTriangle> triangles;

private:
  /// Into an array of n slots at least, of which there were `had`.
  template <class T>
  void send(const std::vector<uint32_t>& slot, const std::vector<T>& value, int64_t had, int64_t n, Array<T>& to) {
    const auto count = static_cast<int64_t>(slot.size());
    if (count == n) { // all of them, in order
      to = {};
      to = b_.upload(value.data(), n);
      return;
    }
    if (to.size() < n) {
      auto more = b_.template array<T>(n + n / 8);
      b_.for_n("copy", had, par::CopyItems<T>{to.data(), more.data()}, {2. * double(had) * sizeof(T)});
      to = std::move(more);
    }
    const auto at = b_.upload(slot.data(), count);
    const auto from = b_.upload(value.data(), count);
    b_.for_n("update", count, par::Scatter<T>{from.data(), at.data(), to.data()},
             {double(count) * (2 * sizeof(T) + 4)});
  }
  template <class T>
  std::vector<T> on_host(const Array<T>& from, int64_t n) {
    std::vector<T> to(static_cast<size_t>(n));
    b_.download(from, n, to.data());
    return to;
  }

  Backend& b_;
  KnownMesh known_;
  Array<uint8_t> faces_; ///< [elements] ElementChanges::faces
};

} // namespace molmesh::cuda
