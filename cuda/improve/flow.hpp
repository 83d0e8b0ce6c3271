// flow.hpp — geometric flow on a Backend: sweeps of Jacobi steps over the points with bad elements, grouped by
// valence. All move at once; then every star is judged with all moves in effect, points whose star does not keep to
// its limits go back, and so on until all that still move keep to theirs. So the worst element never becomes worse,
// whatever moves beside it, and the result does not depend on the order of the threads.
#pragma once
#include "cuda/density/search_items.hpp"
#include "cuda/improve/device_isosurface.hpp"
#include "cuda/improve/flow_items.hpp"
#include "cuda/par/backend.hpp"
#include "improve/improve.hpp"
#include <optional>
#include <type_traits>
#include <vector>

namespace molmesh::cuda {

/// Sails of the curved surface, each once.
std::vector<Sail> sails_of(const improve::DynamicMesh& m);

/// The items (elements, triangles) at each point.
template <class Backend>
struct Stars {
  /// Item: v[corners], indices of points.
  template <class Items>
  Stars(Backend& backend, const Items& items, int64_t n_points) : b(backend), points(n_points) {
    using Item = std::remove_pointer_t<decltype(items.data())>;
    constexpr int corners = static_cast<int>(sizeof(Item::v) / sizeof(int32_t));
    const int64_t pairs = corners * items.size();
    const auto point_of = b.template array<uint32_t>(pairs);
    begin = b.template array<int64_t>(points + 1);
    item = b.template array<uint32_t>(pairs);
    b.for_n("star pairs", pairs, StarPairs<Item, corners>{items.data(), point_of.data(), item.data()},
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
  /// run.
  Flow(Backend& b, const improve::Isosurface* surface) : b_(b) {
    if (surface)
      surface_.emplace(b, *surface);
  }

  /// Sweeps over the mesh as it is now; changed elements count as never tried. Returns how many moves were done.
  int64_t run(improve::DynamicMesh& mesh, const improve::Pass& pass, int sweeps) {
    element_of_.clear();
    std::vector<Corners> corners;
    for (size_t e = 0; e < mesh.element.size(); ++e)
      if (const improve::Element& el = mesh.element[e]; el.alive()) {
        element_of_.push_back(static_cast<int32_t>(e));
        corners.push_back({{el.v[0], el.v[1], el.v[2], el.v[3]}});
      }
    const std::vector<Sail> sails = surface_ ? sails_of(mesh) : std::vector<Sail>{};
    elements_ = static_cast<int64_t>(corners.size());
    points_ = static_cast<int64_t>(mesh.point.size());
    if (4 * elements_ > int64_t{1} << 32)
      fail(Status::failed, "--mode cuda: the mesh has more than 2^30 elements, use seq or omp");
    const Array<Corners> element = b_.upload(corners.data(), elements_);
    const Array<Sail> sail = b_.upload(sails.data(), static_cast<int64_t>(sails.size()));
    const Array<improve::Vertex> vertex = b_.upload(mesh.vertex.data(), points_);
    const Stars<Backend> around(b_, element, points_), sails_around(b_, sail, points_);
    const Array<Vec3d> point = b_.upload(mesh.point.data(), points_);
    FlowMesh m{element.data(),
               sail.data(),
               vertex.data(),
               around.view(),
               sails_around.view(),
               surface_ && pass.guard.lift == 0,
               {},
               pass.guard,
               pass.goal,
               pass.worst_first};
    if (surface_)
      m.surface = surface_->view();
    const Array<uint32_t> order = around.by_valence();
    int64_t moves = 0;
    for (int s = 0; s < sweeps; ++s) {
      const int64_t n = sweep(m, point, order);
      moves += n;
      if (n == 0)
        break;
    }
    if (moves > 0)
      give_back(m, point, mesh);
    return moves;
  }
  int64_t visited() const { return visited_; } ///< points that looked for a place, over all sweeps

private:
  int64_t sweep(const FlowMesh& m, const Array<Vec3d>& point, const Array<uint32_t>& order) {
    const Array<float> q = b_.template array<float>(elements_);
    b_.for_n("element quality", elements_, ElementQuality{m.element, point.data(), q.data()},
             {double(elements_) * 20 + double(points_) * 24, 180. * double(elements_), true});
    const Array<int64_t> wanted = b_.template array<int64_t>(points_ + 1);
    b_.for_n("points with bad elements", points_, WantsToMove{m, q.data(), order.data(), wanted.data()},
             {double(elements_) * 20 + double(points_) * 24});
    const int64_t n = b_.scan("scan", wanted.data(), points_);
    visited_ += n;
    const Array<uint32_t> active = b_.template array<uint32_t>(n);
    b_.for_n("compact", points_, Compact<uint32_t>{order.data(), wanted.data(), active.data()},
             {double(points_) * 12});
    const Array<Vec3d> to = b_.template array<Vec3d>(points_);
    const Array<uint8_t> moving = b_.filled(points_, uint8_t{0});
    const Array<Limits> limits = b_.template array<Limits>(n);
    // A proposal judges a star about four times.
    const double stars = double(n) * 4 * double(elements_) / double(points_ > 0 ? points_ : 1);
    b_.for_n("propose moves", n,
             ProposeMove{m, point.data(), active.data(), to.data(), moving.data(), limits.data()},
             {stars * 20 + double(n) * 48, 180. * 4 * stars, true});
    const Array<int64_t> stays = b_.template array<int64_t>(n + 1);
    for (;;) {
      b_.for_n("check moves", n,
               CheckMove{m, {point.data(), to.data(), moving.data()}, active.data(), limits.data(), stays.data()},
               {stars * 20, 180. * stars, true});
      if (b_.scan("scan", stays.data(), n) == 0)
        break;
      b_.for_n("take back", n, TakeBack{active.data(), stays.data(), moving.data()}, {double(n) * 21});
    }
    b_.for_n("commit moves", n, CommitMoves{active.data(), to.data(), moving.data(), point.data(), stays.data()},
             {double(n) * 60});
    return b_.scan("scan", stays.data(), n);
  }

  void give_back(const FlowMesh& m, const Array<Vec3d>& point, improve::DynamicMesh& mesh) {
    const Array<float> q = b_.template array<float>(elements_);
    b_.for_n("element quality", elements_, ElementQuality{m.element, point.data(), q.data()},
             {double(elements_) * 20 + double(points_) * 24, 180. * double(elements_), true});
    std::vector<float> quality(static_cast<size_t>(elements_));
    b_.download(q, elements_, quality.data());
    const std::vector<Vec3d> before = mesh.point;
    b_.download(point, points_, mesh.point.data());
    const auto moved = [&](int32_t v) {
      return !(before[static_cast<size_t>(v)] == mesh.point[static_cast<size_t>(v)]);
    };
    for (size_t i = 0; i < quality.size(); ++i) {
      improve::Element& e = mesh.element[static_cast<size_t>(element_of_[i])];
      if (moved(e.v[0]) || moved(e.v[1]) || moved(e.v[2]) || moved(e.v[3])) {
        e.q = quality[i];
        e.tried = 0;
      }
    }
  }

  Backend& b_;
  std::optional<DeviceIsosurface<Backend>> surface_;
  std::vector<int32_t> element_of_;
  int64_t elements_ = 0, points_ = 0, visited_ = 0;
};

} // namespace molmesh::cuda
