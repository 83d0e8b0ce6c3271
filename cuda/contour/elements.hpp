// elements.hpp — contour::make_elements on a Backend: the same functions for faces and rings, so the same elements
// in the same order. Leaves are taken in several runs where the device's memory is short.
#pragma once
#include "contour/elements/elements.hpp"
#include "cuda/contour/element_items.hpp"
#include "cuda/contour/element_sinks.hpp"
#include "cuda/par/backend.hpp"
#include <algorithm>
#include <numeric>

namespace molmesh::cuda {

template <par::Launcher Backend>
class ElementMaker {
  template <class T>
  using Array = typename Backend::template Array<T>;

public:
  using Ids = par::List<Backend, int32_t>;
  ElementMaker(Backend& b, int64_t least_run) : b_(b), least_run_(least_run) {}

  /// What it tells of the elements that its sink took.
  struct Made {
    int64_t face_points, edge_points;
  };
  /// The elements of the complex whose view this is, into a sink: the same as make_elements makes.
  template <class Sink>
  Made operator()(const ComplexView& view, Sink& sink) {
    const int32_t own = view.vertices();
    MoreVertices more;
    const int64_t all_faces = make(MakeFaces<false>{view, nullptr}, int64_t{view.tree.leaves}, own, sink, &more);
    const Rings rings = join(more);
    const int64_t all = make(MakeRings<false>{vertices(view, rings), rings.link.data(), rings.first.data()},
                             rings.edges, all_faces, sink, nullptr);
    return {all_faces - own, all - all_faces};
  }

  /// Vertices that elements without positive volume would hang on: of the leaves' faces, and of the rings of edges
  /// with both ends among `ends` (null: of all edges).
  Ids spoiled_of(const ComplexView& view, const Ids& leaves, const Ids* ends) {
    const Array<uint8_t> flag = b_.filled(view.vertices(), uint8_t{0});
    MoreVertices more;
    NoSink none;
    make(MakeFaces<true>{view, leaves.data()}, leaves.n, view.vertices(), none, &more, flag.data());
    const Rings rings = join(more, ends, view.grid_vertices);
    make(MakeRings<true>{vertices(view, rings), rings.link.data(), rings.first.data()}, rings.edges,
         view.vertices(), none, nullptr, flag.data());
    return par::flagged(b_, "spoiled", view.vertices(), flag.data());
  }
  int64_t runs() const { return runs_; }

private:
  struct NoSink { ///< elements are only checked
    void take(ElementRun<Backend>) {}
  };
  /// What the rings need of the faces, run by run.
  struct MoreVertices {
    std::vector<Array<Link>> link;
    std::vector<Array<Vec3d>> point;
    std::vector<Array<int32_t>> wall;
    std::vector<int64_t> link_count, point_count; ///< of each run
  };

  /// What faces leave for the rings, in order.
  struct Rings {
    Array<Link> link;
    Array<Vec3d> point;
    Array<int32_t> wall;
    Array<int64_t> first;
    int64_t edges = 0;
  };
  static contour::RingVertices vertices(const ComplexView& view, const Rings& r) {
    return {view, view.vertices(), r.point.data(), r.wall.data()};
  }
  Rings join(MoreVertices& more, const Ids* ends = nullptr, int32_t grid_vertices = 0) {
    Rings r;
    Array<Link> link = joined<Link>(b_, more.link, more.link_count);
    int64_t links = std::accumulate(more.link_count.begin(), more.link_count.end(), int64_t{0});
    if (ends) {
      auto kept = par::gather<Link>(b_, "whole edges", links,
                                    WholeEdges{link.data(), ends->data(), ends->n, grid_vertices});
      link = std::move(kept.array);
      links = kept.n;
    }
    r.point = joined<Vec3d>(b_, more.point, more.point_count);
    r.wall = joined<int32_t>(b_, more.wall, more.point_count);
    more = {};
    r.link = sort_links(link, links);
    r.first = first_links(r.link, links, r.edges);
    return r;
  }

  /// number: of the first new point; returns that of the next.
  template <class Make, class Sink>
  int64_t make(const Make& item, int64_t items, int64_t number, Sink& sink, MoreVertices* more,
               uint8_t* spoiled = nullptr) {
    constexpr int64_t most = int64_t{1} << 25; // counts of a run are 32 bits wide
    const int64_t run = std::clamp(b_.room() / 1024, least_run_, most);
    for (int64_t begin = 0; begin < items; begin += run, ++runs_) {
      int64_t points = 0;
      sink.take(make_run(item, begin, std::min(run, items - begin), number, more, spoiled, points));
      number += points;
    }
    return number;
  }

  template <class Make>
  ElementRun<Backend> make_run(const Make& item, int64_t begin, int64_t n, int64_t number, MoreVertices* more,
                               uint8_t* spoiled, int64_t& points) {
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
      fail(Status::failed, "mode cuda: the mesh has more than 2^30 points, use seq or omp", {"mode"});
    if (Make::check && !more)
      return {};
    ElementRun<Backend> run{b_.template array<Tet>(total[0]),
                            b_.template array<Tri>(total[1]),
                            b_.template array<Sides>(total[1]),
                            b_.template array<int32_t>(total[1]),
                            {}};
    Array<Link> link = b_.template array<Link>(total[2] + 1); // not null: it writes
    Array<Vec3d> point = b_.template array<Vec3d>(total[3]);
    Array<int32_t> wall = b_.template array<int32_t>(total[3]);
    b_.for_n(more ? "make faces" : "make rings", n,
             RunElements<Make>{item,
                               begin,
                               order.data(),
                               at,
                               {run.tet.data(), run.tri.data(), run.tri_sides.data(), run.boundary.data(),
                                link.data(), point.data(), wall.data(), static_cast<int32_t>(number)},
                               spoiled},
             {double(n) * 200 + double(total[0]) * 16 + double(total[1]) * 24 + double(total[2]) * 20 +
              double(total[3]) * 28});
    points = total[3];
    if (!more) {
      run.point = std::move(point);
      return run;
    }
    if (!Make::check) {
      run.point = b_.template array<Vec3d>(total[3]);
      b_.for_n("copy", total[3], par::CopyItems<Vec3d>{point.data(), run.point.data()}, {double(total[3]) * 48});
    }
    more->link_count.push_back(total[2]);
    more->point_count.push_back(total[3]);
    more->link.push_back(std::move(link));
    more->point.push_back(std::move(point));
    more->wall.push_back(std::move(wall));
    return run;
  }

  Array<Link> sort_links(const Array<Link>& link, int64_t n) {
    const Array<uint32_t> from = b_.template array<uint32_t>(n), index = b_.template array<uint32_t>(n);
    const Array<uint64_t> edge = b_.template array<uint64_t>(n);
    b_.for_n("link keys", n, LinkFrom{link.data(), from.data(), index.data()}, {double(n) * 28});
    b_.sort_pairs("sort links", from.data(), index.data(), n);
    b_.for_n("link keys", n, LinkEdge{link.data(), index.data(), edge.data()}, {double(n) * 32});
    b_.sort_pairs("sort links", edge.data(), index.data(), n);
    Array<Link> sorted = b_.template array<Link>(n);
    b_.for_n("gather links", n, par::Gather<Link>{link.data(), index.data(), sorted.data()}, {double(n) * 44});
    return sorted;
  }
  /// First link of each edge, then their number.
  Array<int64_t> first_links(const Array<Link>& link, int64_t n, int64_t& edges) {
    const Array<int64_t> first = b_.template array<int64_t>(n + 1), index = b_.template array<int64_t>(n);
    b_.for_n("first links", n, FirstLink{link.data(), first.data(), index.data()}, {double(n) * 36});
    edges = b_.scan("scan", first.data(), n);
    Array<int64_t> out = b_.filled(edges + 1, n);
    b_.for_n("compact", n, par::Compact<int64_t>{index.data(), first.data(), out.data()}, {double(n) * 24});
    return out;
  }

  Backend& b_;
  int64_t least_run_, runs_ = 0;
};

} // namespace molmesh::cuda
