// elements.hpp — contour::make_elements on a Backend: the same functions for faces and rings, so the same elements
// in the same order. Runs of leaves, one after the other, where the device's memory asks for it.
#pragma once
#include "contour/elements.hpp"
#include "cuda/contour/element_items.hpp"
#include "cuda/density/search_items.hpp"
#include "cuda/par/backend.hpp"
#include <algorithm>
#include <memory>
#include <optional>

namespace molmesh::cuda {

template <class Backend>
class ElementMaker {
  template <class T>
  using Array = typename Backend::template Array<T>;
  template <class T>
  using Pending = typename Backend::template Pending<T>;

public:
  explicit ElementMaker(Backend& b) : b_(b) {}

  contour::Elements operator()(const contour::Complex& complex, bool inside, bool outside) {
    complex_.reset();
    complex_ = std::make_unique<DeviceComplex<Backend>>(b_, complex);
    contour::Elements out;
    out.position = complex.position;
    MoreVertices more;
    const MakeFaces faces{complex_->view, {outside, inside}};
    make(faces, int64_t{complex.tree.size()}, out, &more);
    out.face_points = more.points;
    const auto own = static_cast<int32_t>(complex.position.size());
    const Array<Link> link = joined(more.link, more.links);
    const Array<Vec3d> point = joined(more.point, more.points);
    const Array<int32_t> wall = joined(more.wall, more.points);
    more = {};
    const Array<Link> sorted = sort_links(link);
    int64_t edges = 0;
    const Array<int64_t> first = first_links(sorted, edges);
    const MakeRings rings{complex_->view, {outside, inside}, own,         point.data(),
                          wall.data(),    sorted.data(),     first.data()};
    make(rings, edges, out, nullptr);
    out.edge_points = static_cast<int64_t>(out.position.size()) - own - out.face_points;
    std::sort(out.spoiled.begin(), out.spoiled.end());
    out.spoiled.erase(std::unique(out.spoiled.begin(), out.spoiled.end()), out.spoiled.end());
    return out;
  }
  int64_t runs() const { return runs_; }

private:
  /// What the rings need of the faces, run by run.
  struct MoreVertices {
    std::vector<Array<Link>> link;
    std::vector<Array<Vec3d>> point;
    std::vector<Array<int32_t>> wall;
    int64_t links = 0, points = 0;
  };
  struct Result {
    Pending<Tet> tet;
    Pending<Tri> tri;
    Pending<Sides> tri_sides;
    Pending<int32_t> boundary, spoiled;
    Pending<Vec3d> point;
  };

  template <class Make>
  void make(const Make& item, int64_t items, contour::Elements& out, MoreVertices* more) {
    std::optional<Result> before;
    constexpr int64_t most = int64_t{1} << 25; // counts of a run are 32 bits wide
    int64_t run = std::max<int64_t>(1, std::min({items, b_.room() / 256, most}));
    int64_t number = static_cast<int64_t>(out.position.size()); // of the next new point
    for (int64_t begin = 0; begin < items;) {
      const int64_t n = std::min(run, items - begin);
      std::optional<Result> result;
      try {
        result.emplace(make_run(item, begin, n, number, more));
      } catch (const OutOfRoom&) {
        if (before) {
          append(*before, out);
          before.reset();
        } else if (n > 1) {
          run = (n + 1) / 2;
        } else {
          throw;
        }
        continue;
      }
      ++runs_;
      begin += n;
      number += result->point.size();
      if (before)
        append(*before, out);
      before.reset();
      before.emplace(std::move(*result));
    }
    if (before)
      append(*before, out);
  }

  template <class Make>
  Result make_run(const Make& item, int64_t begin, int64_t n, int64_t number, MoreVertices* more) {
    const Array<uint32_t> order = b_.template array<uint32_t>(n);
    {
      const Array<uint32_t> key = b_.template array<uint32_t>(n);
      b_.for_n("estimate work", n, WorkKeys<Make>{item, begin, key.data(), order.data()}, {double(n) * 10});
      b_.sort_pairs("sort by work", key.data(), order.data(), n);
    }
    Array<int32_t> count[6];
    for (Array<int32_t>& c : count)
      c = b_.template array<int32_t>(n + 1);
    const ItemCounts at{count[0].data(), count[1].data(), count[2].data(),
                        count[3].data(), count[4].data(), count[5].data()};
    b_.for_n(more ? "count faces" : "count rings", n, RunElements<Make>{item, begin, order.data(), at, {}},
             {double(n) * 200});
    int32_t total[6];
    for (int k = 0; k < 6; ++k)
      total[k] = b_.scan("scan", count[k].data(), n);
    if (total[5] > 0)
      fail(Status::failed, "contour: a sign-change edge without a ring");
    if (number + total[3] >= int64_t{1} << 30)
      fail(Status::failed, "--mode cuda: the mesh has more than 2^30 points, use seq or omp");
    Array<Tet> tet = b_.template array<Tet>(total[0]);
    Array<Tri> tri = b_.template array<Tri>(total[1]);
    Array<Sides> sides = b_.template array<Sides>(total[1]);
    Array<int32_t> boundary = b_.template array<int32_t>(total[1]);
    Array<Link> link = b_.template array<Link>(total[2]);
    Array<Vec3d> point = b_.template array<Vec3d>(total[3]);
    Array<int32_t> wall = b_.template array<int32_t>(total[3]);
    Array<int32_t> spoiled = b_.template array<int32_t>(total[4]);
    b_.for_n(more ? "make faces" : "make rings", n,
             RunElements<Make>{item,
                               begin,
                               order.data(),
                               at,
                               {tet.data(), tri.data(), sides.data(), boundary.data(), link.data(), point.data(),
                                wall.data(), spoiled.data(), static_cast<int32_t>(number)}},
             {double(n) * 200 + double(total[0]) * 16 + double(total[1]) * 24 + double(total[2]) * 20 +
              double(total[3]) * 28});
    if (more) {
      more->links += total[2];
      more->points += total[3];
      Array<Vec3d> kept = b_.template array<Vec3d>(total[3]);
      b_.for_n("copy", total[3], CopyItems<Vec3d>{point.data(), kept.data()}, {double(total[3]) * 48});
      more->link.push_back(std::move(link));
      more->point.push_back(std::move(kept));
      more->wall.push_back(std::move(wall));
    }
    return {b_.fetch(std::move(tet)),      b_.fetch(std::move(tri)),     b_.fetch(std::move(sides)),
            b_.fetch(std::move(boundary)), b_.fetch(std::move(spoiled)), b_.fetch(std::move(point))};
  }

  void append(Result& r, contour::Elements& out) const {
    const auto add = [](auto& to, auto& from) {
      const auto* p = from.get();
      to.insert(to.end(), p, p + from.size());
    };
    add(out.tet, r.tet);
    add(out.tri, r.tri);
    add(out.tri_sides, r.tri_sides);
    add(out.boundary, r.boundary);
    add(out.spoiled, r.spoiled);
    add(out.position, r.point);
  }

  template <class T>
  Array<T> joined(std::vector<Array<T>>& part, int64_t n) {
    if (part.size() == 1)
      return std::move(part[0]);
    Array<T> all = b_.template array<T>(n);
    int64_t at = 0;
    for (const Array<T>& p : part) {
      b_.for_n("copy", p.size(), CopyItems<T>{p.data(), all.data() + at}, {2. * double(p.size()) * sizeof(T)});
      at += p.size();
    }
    return all;
  }

  Array<Link> sort_links(const Array<Link>& link) {
    const int64_t n = link.size();
    const Array<uint32_t> from = b_.template array<uint32_t>(n), index = b_.template array<uint32_t>(n);
    const Array<uint64_t> edge = b_.template array<uint64_t>(n);
    b_.for_n("link keys", n, LinkFrom{link.data(), from.data(), index.data()}, {double(n) * 28});
    b_.sort_pairs("sort links", from.data(), index.data(), n);
    b_.for_n("link keys", n, LinkEdge{link.data(), index.data(), edge.data()}, {double(n) * 32});
    b_.sort_pairs("sort links", edge.data(), index.data(), n);
    Array<Link> sorted = b_.template array<Link>(n);
    b_.for_n("gather links", n, Gather<Link>{link.data(), index.data(), sorted.data()}, {double(n) * 44});
    return sorted;
  }
  /// First link of each edge, then their number.
  Array<int64_t> first_links(const Array<Link>& link, int64_t& edges) {
    const int64_t n = link.size();
    const Array<int64_t> first = b_.template array<int64_t>(n + 1), index = b_.template array<int64_t>(n);
    b_.for_n("first links", n, FirstLink{link.data(), first.data(), index.data()}, {double(n) * 36});
    edges = b_.scan("scan", first.data(), n);
    Array<int64_t> out = b_.filled(edges + 1, n);
    b_.for_n("compact", n, Compact<int64_t>{index.data(), first.data(), out.data()}, {double(n) * 24});
    return out;
  }

  Backend& b_;
  std::unique_ptr<DeviceComplex<Backend>> complex_;
  int64_t runs_ = 0;
};

} // namespace molmesh::cuda
