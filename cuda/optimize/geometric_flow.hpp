// geometric_flow.hpp — geometric flow on a Backend: sweeps of Jacobi steps over the points with bad elements,
// grouped by valence. All move at once; then every star is judged with all moves in effect, points whose star does
// not keep to its limits go back, and so on until all that still move keep to theirs. So the worst element never
// becomes worse, whatever moves beside it, and the result does not depend on the order of the threads.
#pragma once
#include "cuda/optimize/device_isosurface.hpp"
#include "cuda/optimize/resident_mesh.hpp"
#include "optimize/optimize.hpp"
#include <optional>
#include <type_traits>

namespace molmesh::cuda {

/// The items (elements, triangles) at each point.
template <class Backend>
struct Stars {
  /// Item: v[corners], indices of points.
  template <class Item>
  Stars(Backend& backend, const Item* items, int64_t n, int64_t n_points) : b(backend), points(n_points) {
    constexpr int corners = static_cast<int>(sizeof(Item::v) / sizeof(int32_t));
    const int64_t pairs = corners * n;
    const auto point_of = b.template array<uint32_t>(pairs);
    begin = b.template array<int64_t>(points + 1);
    item = b.template array<uint32_t>(pairs);
    b.for_n("star pairs", pairs, StarPairs<Item, corners>{items, point_of.data(), item.data()},
            {double(pairs) * 12});
    b.sort_pairs("sort stars", point_of.data(), item.data(), pairs);
    b.for_n("star begins", points + 1, StarBegin{point_of.data(), pairs, begin.data()}, {double(points) * 12});
  }
  /// Points by falling valence.
  auto by_valence() const {
    const auto key = b.template array<uint32_t>(points);
    auto order = b.template array<uint32_t>(points);
    b.for_n("valences", points, ValenceKeys{begin.data(), key.data(), order.data()}, {double(points) * 16});
    b.sort_pairs("sort by valence", key.data(), order.data(), points);
    return order;
  }
  Star view() const { return {begin.data(), item.data()}; }

  Backend& b;
  int64_t points;
  typename Backend::template Array<int64_t> begin;
  typename Backend::template Array<uint32_t> item;
};

template <class Backend>
class Flow {
  template <class T>
  using Array = typename Backend::template Array<T>;

public:
  /// surface: null keeps the points of curved surfaces where they are. Uploaded once; its offset is read at each
  /// run. threads: of the host.
  Flow(Backend& b, const Isosurface* surface, int threads) : b_(b), mesh_(b, surface != nullptr, threads) {
    if (surface)
      surface_.emplace(b, *surface);
  }

  /// Sweeps over the mesh as it is now, the same in every run; changed elements count as never tried. Returns how
  /// many moves were done.
  int64_t run(optimize::DynamicMesh& mesh, const optimize::Pass& pass, int sweeps) {
    mesh_.update(mesh);
    const Stars<Backend> around(b_, mesh_.corners.data(), mesh_.elements, mesh_.points),
        triangles_around(b_, mesh_.triangles.data(), mesh_.triangles.n, mesh_.points);
    FlowMesh m{mesh_.corners.data(),
               mesh_.triangles.data(),
               mesh_.vertex.data(),
               around.view(),
               triangles_around.view(),
               surface_ && pass.guard.lift == 0,
               {},
               pass.guard,
               pass.guard.tilt(),
               pass.goal,
               pass.worst_first,
               mesh.walls};
    if (surface_)
      m.surface = surface_->view();
    const Array<uint32_t> order = around.by_valence();
    int64_t moves = 0;
    for (int s = 0; s < sweeps; ++s) {
      const int64_t n = sweep(m, order);
      moves += n;
      if (n == 0)
        break;
    }
    if (moves > 0)
      mesh_.give_back(mesh);
    return moves;
  }
  int64_t visited() const { return visited_; } ///< points that looked for a place, over all sweeps

private:
  int64_t sweep(const FlowMesh& m, const Array<uint32_t>& order) {
    const int64_t elements = mesh_.elements, points = mesh_.points;
    Vec3d* const point = mesh_.point.data();
    const Array<float> q = b_.template array<float>(elements);
    b_.for_n("element quality", elements, ElementQuality{m.element, point, q.data()},
             {double(elements) * 20 + double(points) * 24, 180. * double(elements), true});
    const Array<int64_t> wanted = b_.template array<int64_t>(points + 1);
    b_.for_n("points with bad elements", points, WantsToMove{m, q.data(), order.data(), wanted.data()},
             {double(elements) * 20 + double(points) * 24});
    const int64_t n = b_.scan("scan", wanted.data(), points);
    visited_ += n;
    const Array<uint32_t> active = b_.template array<uint32_t>(n);
    b_.for_n("compact", points, par::Compact<uint32_t>{order.data(), wanted.data(), active.data()},
             {double(points) * 12});
    const Array<Vec3d> to = b_.template array<Vec3d>(points);
    const Array<uint8_t> moving = b_.filled(points, uint8_t{0});
    const Array<Limits> limits = b_.template array<Limits>(n);
    // A proposal judges a star about four times.
    const double stars = double(n) * 4 * double(elements) / double(points > 0 ? points : 1);
    b_.for_n("propose moves", n, ProposeMove{m, point, active.data(), to.data(), moving.data(), limits.data()},
             {stars * 20 + double(n) * 48, 180. * 4 * stars, true});
    const Array<int64_t> stays = b_.template array<int64_t>(n + 1);
    for (;;) {
      b_.for_n("check moves", n,
               CheckMove{m, {point, to.data(), moving.data()}, active.data(), limits.data(), stays.data()},
               {stars * 20, 180. * stars, true});
      if (b_.scan("scan", stays.data(), n) == 0)
        break;
      b_.for_n("take back", n, TakeBack{active.data(), stays.data(), moving.data()}, {double(n) * 21});
    }
    b_.for_n("commit moves", n,
             CommitMoves{active.data(), to.data(), moving.data(), point, stays.data(), mesh_.has_moved.data()},
             {double(n) * 60});
    return b_.scan("scan", stays.data(), n);
  }

  Backend& b_;
  std::optional<DeviceIsosurface<Backend>> surface_;
  ResidentMesh<Backend> mesh_;
  int64_t visited_ = 0;
};

} // namespace molmesh::cuda
