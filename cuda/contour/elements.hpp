// elements.hpp — contour::make_elements on a Backend: the same functions for faces and rings, so the same elements
// in the same order. Runs of leaves, one after the other, where the device's memory asks for it.
#pragma once
#include "contour/elements.hpp"
#include "cuda/contour/element_items.hpp"
#include "cuda/density/search_items.hpp"
#include "cuda/par/backend.hpp"
#include <algorithm>
#include <optional>

namespace molmesh::cuda {

template <class Backend>
class ElementMaker {
  template <class T>
  using Array = typename Backend::template Array<T>;
  template <class T>
  using Pending = typename Backend::template Pending<T>;

public:
  using Ids = contour::detail::List<Backend, int32_t>;
  explicit ElementMaker(Backend& b) : b_(b) {}

  /// The elements of the complex whose view this is; more than make_elements only in where they are made.
  contour::Elements operator()(const ComplexView& view) {
    contour::Elements out;
    const int32_t own = view.vertices();
    MoreVertices more;
    make(MakeFaces<false>{view, nullptr}, int64_t{view.tree.leaves}, own, &out, &more);
    out.face_points = more.points;
    const Rings rings = join(more);
    make(MakeRings<false>{vertices(view, rings), rings.link.data(), rings.first.data()}, rings.edges,
         own + out.face_points, &out, nullptr);
    out.edge_points = static_cast<int64_t>(out.position.size()) - out.face_points;
    return out;
  }

  /// Vertices that elements without positive volume would hang on: of the leaves' faces, and of the rings of edges
  /// with both ends among `ends` (null: of all edges).
  Ids spoiled_of(const ComplexView& view, const Ids& leaves, const Ids* ends) {
    const Array<uint8_t> flag = b_.filled(view.vertices(), uint8_t{0});
    MoreVertices more;
    make(MakeFaces<true>{view, leaves.data()}, leaves.n, view.vertices(), nullptr, &more, flag.data());
    const Rings rings = join(more, ends, view.grid_vertices);
    make(MakeRings<true>{vertices(view, rings), rings.link.data(), rings.first.data()}, rings.edges,
         view.vertices(), nullptr, nullptr, flag.data());
    return contour::detail::gather<int32_t>(b_, "spoiled", view.vertices(), contour::detail::Flagged{flag.data()});
  }
  int64_t runs() const { return runs_; }

private:
  /// What the rings need of the faces, run by run.
  struct MoreVertices {
    std::vector<Array<Link>> link;
    std::vector<Array<Vec3d>> point;
    std::vector<Array<int32_t>> wall;
    std::vector<int64_t> link_count, point_count; ///< of each run
    int64_t links = 0, points = 0;
  };
  /// On its way to the host; empty where elements are only checked.
  struct Result {
    std::optional<Pending<Tet>> tet;
    std::optional<Pending<Tri>> tri;
    std::optional<Pending<Sides>> tri_sides;
    std::optional<Pending<int32_t>> boundary;
    std::optional<Pending<Vec3d>> point;
    int64_t points = 0;
  };

  /// What faces leave for the rings, in order.
  struct Rings {
    Array<Link> link;
    Array<Vec3d> point;
    Array<int32_t> wall;
    Array<int64_t> first;
    int64_t edges = 0;
  };
  static contour::detail::RingVertices vertices(const ComplexView& view, const Rings& r) {
    return {view, view.vertices(), r.point.data(), r.wall.data()};
  }
  Rings join(MoreVertices& more, const Ids* ends = nullptr, int32_t grid_vertices = 0) {
    Rings r;
    Array<Link> link = joined(more.link, more.link_count, more.links);
    int64_t links = more.links;
    if (ends) {
      auto kept = contour::detail::gather<Link>(b_, "whole edges", links,
                                                WholeEdges{link.data(), ends->data(), ends->n, grid_vertices});
      link = std::move(kept.array);
      links = kept.n;
    }
    r.point = joined(more.point, more.point_count, more.points);
    r.wall = joined(more.wall, more.point_count, more.points);
    more = {};
    r.link = sort_links(link, links);
    r.first = first_links(r.link, links, r.edges);
    return r;
  }

  /// number: of the first new point. out: null where elements are only checked.
  template <class Make>
  void make(const Make& item, int64_t items, int64_t number, contour::Elements* out, MoreVertices* more,
            uint8_t* spoiled = nullptr) {
    std::optional<Result> before;
    constexpr int64_t most = int64_t{1} << 25; // counts of a run are 32 bits wide
    int64_t run = std::max<int64_t>(1, std::min({items, b_.room() / 256, most}));
    for (int64_t begin = 0; begin < items;) {
      const int64_t n = std::min(run, items - begin);
      std::optional<Result> result;
      try {
        result.emplace(make_run(item, begin, n, number, more, spoiled));
      } catch (const OutOfRoom&) {
        if (before) {
          append(*before, *out);
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
      number += result->points;
      if (before)
        append(*before, *out);
      before.reset();
      if (out)
        before.emplace(std::move(*result));
    }
    if (before)
      append(*before, *out);
  }

  template <class Make>
  Result make_run(const Make& item, int64_t begin, int64_t n, int64_t number, MoreVertices* more,
                  uint8_t* spoiled) {
    const Array<uint32_t> order = b_.template array<uint32_t>(n);
    {
      const Array<uint32_t> key = b_.template array<uint32_t>(n);
      b_.for_n("estimate work", n, WorkKeys<Make>{item, begin, key.data(), order.data()}, {double(n) * 10});
      b_.sort_pairs("sort by work", key.data(), order.data(), n);
    }
    Array<int32_t> count[5];
    for (Array<int32_t>& c : count)
      c = b_.template array<int32_t>(n + 1);
    const ItemCounts at{count[0].data(), count[1].data(), count[2].data(), count[3].data(), count[4].data()};
    const char* name = Make::check ? (more ? "check faces" : "check rings") : more ? "count faces" : "count rings";
    b_.for_n(name, n, RunElements<Make>{item, begin, order.data(), at, {}, spoiled}, {double(n) * 200});
    int32_t total[5];
    for (int k = 0; k < 5; ++k)
      total[k] = b_.scan("scan", count[k].data(), n);
    if (total[4] > 0)
      fail(Status::failed, "contour: a sign-change edge without a ring");
    if (number + total[3] >= int64_t{1} << 30)
      fail(Status::failed, "--mode cuda: the mesh has more than 2^30 points, use seq or omp");
    Result result;
    if (Make::check && !more)
      return result;
    Array<Tet> tet = b_.template array<Tet>(total[0]);
    Array<Tri> tri = b_.template array<Tri>(total[1]);
    Array<Sides> sides = b_.template array<Sides>(total[1]);
    Array<int32_t> boundary = b_.template array<int32_t>(total[1]);
    Array<Link> link = b_.template array<Link>(total[2] + 1); // not null: it writes
    Array<Vec3d> point = b_.template array<Vec3d>(total[3]);
    Array<int32_t> wall = b_.template array<int32_t>(total[3]);
    b_.for_n(more ? "make faces" : "make rings", n,
             RunElements<Make>{item,
                               begin,
                               order.data(),
                               at,
                               {tet.data(), tri.data(), sides.data(), boundary.data(), link.data(), point.data(),
                                wall.data(), static_cast<int32_t>(number)},
                               spoiled},
             {double(n) * 200 + double(total[0]) * 16 + double(total[1]) * 24 + double(total[2]) * 20 +
              double(total[3]) * 28});
    result.points = total[3];
    if (more) {
      more->link_count.push_back(total[2]);
      more->point_count.push_back(total[3]);
      more->links += total[2];
      more->points += total[3];
      more->link.push_back(std::move(link));
      more->wall.push_back(std::move(wall));
      Array<Vec3d> kept = std::move(point);
      if (!Make::check) {
        point = b_.template array<Vec3d>(total[3]);
        b_.for_n("copy", total[3], CopyItems<Vec3d>{kept.data(), point.data()}, {double(total[3]) * 48});
      }
      more->point.push_back(std::move(kept));
    }
    if (!Make::check) {
      result.tet.emplace(b_.fetch(std::move(tet)));
      result.tri.emplace(b_.fetch(std::move(tri)));
      result.tri_sides.emplace(b_.fetch(std::move(sides)));
      result.boundary.emplace(b_.fetch(std::move(boundary)));
      result.point.emplace(b_.fetch(std::move(point)));
    }
    return result;
  }

  void append(Result& r, contour::Elements& out) const {
    const auto add = [](auto& to, auto& from) {
      const auto* p = from->get();
      to.insert(to.end(), p, p + from->size());
    };
    add(out.tet, r.tet);
    add(out.tri, r.tri);
    add(out.tri_sides, r.tri_sides);
    add(out.boundary, r.boundary);
    add(out.position, r.point);
  }

  template <class T>
  Array<T> joined(std::vector<Array<T>>& part, const std::vector<int64_t>& count, int64_t n) {
    if (part.size() == 1)
      return std::move(part[0]);
    Array<T> all = b_.template array<T>(n);
    int64_t at = 0;
    for (size_t i = 0; i < part.size(); ++i) {
      b_.for_n("copy", count[i], CopyItems<T>{part[i].data(), all.data() + at},
               {2. * double(count[i]) * sizeof(T)});
      at += count[i];
    }
    return all;
  }

  Array<Link> sort_links(const Array<Link>& link, int64_t n) {
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
  Array<int64_t> first_links(const Array<Link>& link, int64_t n, int64_t& edges) {
    const Array<int64_t> first = b_.template array<int64_t>(n + 1), index = b_.template array<int64_t>(n);
    b_.for_n("first links", n, FirstLink{link.data(), first.data(), index.data()}, {double(n) * 36});
    edges = b_.scan("scan", first.data(), n);
    Array<int64_t> out = b_.filled(edges + 1, n);
    b_.for_n("compact", n, Compact<int64_t>{index.data(), first.data(), out.data()}, {double(n) * 24});
    return out;
  }

  Backend& b_;
  int64_t runs_ = 0;
};

} // namespace molmesh::cuda
