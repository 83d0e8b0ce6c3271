// elements.cpp — makes the elements of faces, then of rings, and joins them in the order of the octree's curve.
#include "contour/elements/elements.hpp"
#include "contour/elements/interior_edges.hpp"
#include "contour/elements/sign_change_edges.hpp"
#include "par/pages.hpp"
#include <algorithm>
#include <utility>

namespace molmesh::contour {

namespace {

/// What faces and rings leave, joined: points and links beside the elements.
struct Joined {
  Elements elements; ///< position: the new points alone
  LargeArray<Link> link;
  LargeArray<int32_t> wall; ///< [new points] Boundary of a wall point, 0 otherwise
  LargeArray<int32_t> spoiled;
};

template <class T>
void append(LargeArray<T>& to, size_t n, int threads) {
  if (to.size() + n > to.capacity())
    to.reserve(2 * (to.size() + n));
  to.resize(to.size() + n);
  par::prepare_pages(to.data() + to.size() - n, n * sizeof(T), threads);
}

/// Appends the batches in order; their new points get the numbers from `first` on, those in out already included.
template <class Batch>
void join(const std::vector<Batch>& batches, int32_t first, Joined& out, int threads) {
  struct Start {
    size_t tet, tri, link, point, spoiled;
  };
  Elements& e = out.elements;
  std::vector<Start> start;
  Start s{e.tet.size(), e.tri.size(), out.link.size(), e.position.size(), out.spoiled.size()};
  const Start before = s;
  for (const Batch& b : batches) {
    start.push_back(s);
    s.tet += b.tet.size();
    s.tri += b.tri.size();
    s.link += b.link.size();
    s.point += b.point.size();
    s.spoiled += b.spoiled.size();
  }
  append(e.tet, s.tet - before.tet, threads);
  append(e.tri, s.tri - before.tri, threads);
  append(e.tri_sides, s.tri - before.tri, threads);
  append(e.boundary, s.tri - before.tri, threads);
  append(out.link, s.link - before.link, threads);
  append(e.position, s.point - before.point, threads);
  append(out.wall, s.point - before.point, threads);
  append(out.spoiled, s.spoiled - before.spoiled, threads);
  par::for_n(static_cast<int64_t>(batches.size()), threads, 1, [&](int64_t i) {
    const Batch& b = batches[i];
    const Start& to = start[i];
    const int32_t zero = first + static_cast<int32_t>(to.point) - 1;
    const auto number = [&](int32_t v) { return v >= 0 || v == no_vertex ? v : zero - v; };
    for (size_t k = 0; k < b.tet.size(); ++k)
      for (size_t c = 0; c < 4; ++c)
        e.tet[to.tet + k][c] = number(b.tet[k][c]);
    for (size_t k = 0; k < b.tri.size(); ++k) {
      for (size_t c = 0; c < 3; ++c)
        e.tri[to.tri + k][c] = number(b.tri[k][c]);
      e.tri_sides[to.tri + k] = b.tri_sides[k];
      e.boundary[to.tri + k] = b.boundary[k];
    }
    for (size_t k = 0; k < b.link.size(); ++k) {
      const Link& l = b.link[k];
      out.link[to.link + k] = {l.inside, l.outside, number(l.from), number(l.via), number(l.to)};
    }
    std::copy(b.point.begin(), b.point.end(), e.position.begin() + static_cast<std::ptrdiff_t>(to.point));
    std::copy(b.point_wall.begin(), b.point_wall.end(), out.wall.begin() + static_cast<std::ptrdiff_t>(to.point));
    std::copy(b.spoiled.begin(), b.spoiled.end(), out.spoiled.begin() + static_cast<std::ptrdiff_t>(to.spoiled));
  });
}

/// make(begin, end, out) for all of [0, n), joined. A few batches at a time, so that their memory stays in the
/// caches.
template <bool check, class Make>
void run(int64_t n, int32_t first, Joined& out, int threads, Make make) {
  constexpr int64_t batch_size = 256; // leaves or edges
  const int64_t all = (n + batch_size - 1) / batch_size, most = int64_t{64} * threads;
  std::vector<Batch<check>> batches;
  for (int64_t begin = 0; begin < all; begin += most) {
    batches.resize(static_cast<size_t>(std::min(most, all - begin)));
    par::for_n(static_cast<int64_t>(batches.size()), threads, 1, [&](int64_t b) {
      batches[b].clear();
      const int64_t first_item = (begin + b) * batch_size;
      make(first_item, std::min(n, first_item + batch_size), batches[b]);
    });
    join(batches, first, out, threads);
  }
}

/// The first link of each run of like ones, then the number of links.
template <class Like>
LargeArray<int64_t> firsts(const LargeArray<Link>& links, int threads, Like like) {
  const auto n = static_cast<int64_t>(links.size());
  LargeArray<int64_t> first =
      par::select<int64_t>(n, threads, [&](int64_t i) { return i == 0 || !like(links[i - 1], links[i]); });
  first.push_back(n);
  return first;
}

/// Sorted by edge, then by where they come from; returns the first link of each edge, then their number.
LargeArray<int64_t> sort_by_edge(LargeArray<Link>& links, int32_t vertices, int threads) {
  const auto n = static_cast<int64_t>(links.size());
  LargeArray<Link> sorted;
  par::place_by(
      n, vertices, threads, [&](int64_t i) { return links[i].inside; },
      [&](int64_t slots) { par::resize_pages(sorted, static_cast<size_t>(slots), threads); },
      [&](int64_t slot, int64_t i) { sorted[slot] = links[i]; });
  links.swap(sorted);
  const LargeArray<int64_t> run =
      firsts(links, threads, [](const Link& a, const Link& b) { return a.inside == b.inside; });
  par::for_n(static_cast<int64_t>(run.size()) - 1, threads,
             [&](int64_t r) { std::sort(links.begin() + run[r], links.begin() + run[r + 1]); });
  return firsts(links, threads, [](const Link& a, const Link& b) { return a.same_edge(b); });
}

/// Faces of the leaves that leaf(0 … n - 1) names, then the rings of all edges whose links stay(link).
template <bool check, class Leaf, class Stay>
Joined make_all(const ComplexView& view, int64_t n, Leaf leaf, int threads, Stay stay) {
  Joined out;
  // About what a uniform mesh has: memory is taken when it is written.
  out.link.reserve(6 * static_cast<size_t>(view.surface_cells));
  if (!check) {
    const size_t triangles = 3 * static_cast<size_t>(view.surface_cells);
    out.elements.tet.reserve(static_cast<size_t>(12 * n) + 8 * static_cast<size_t>(view.surface_cells));
    out.elements.tri.reserve(triangles);
    out.elements.tri_sides.reserve(triangles);
    out.elements.boundary.reserve(triangles);
  }
  run<check>(n, view.vertices(), out, threads, [&](int64_t begin, int64_t end, auto& to) {
    NearLeaves near(view.tree);
    for (int64_t i = begin; i < end; ++i)
      make_faces(view, near, leaf(i), to);
  });
  out.elements.face_points = static_cast<int64_t>(out.wall.size());
  if (check)
    out.link.erase(std::remove_if(out.link.begin(), out.link.end(), [&](const Link& l) { return !stay(l); }),
                   out.link.end());
  const LargeArray<int64_t> first = sort_by_edge(out.link, view.vertices(), threads);
  const LargeArray<Vec3d> point = out.elements.position; // the rings' are appended
  const LargeArray<int32_t> wall = out.wall;
  const RingVertices vertices{view, view.vertices(), point.data(), wall.data()};
  run<check>(static_cast<int64_t>(first.size()) - 1, view.vertices(), out, threads,
             [&](int64_t begin, int64_t end, auto& to) {
               for (int64_t e = begin; e < end; ++e)
                 make_ring(vertices, &out.link[first[e]], out.link.data() + first[e + 1], to);
             });
  return out;
}

} // namespace

LargeArray<int32_t> spoiled_of(const ComplexView& view, const LargeArray<int32_t>& leaves,
                               const LargeArray<int32_t>* ends, int threads) {
  const auto is_end = [&](int32_t v) { // all faces at a split cell's centre are that cell's
    return v >= view.grid_vertices || std::binary_search(ends->begin(), ends->end(), v);
  };
  Joined all = make_all<true>(
      view, static_cast<int64_t>(leaves.size()), [&](int64_t i) { return leaves[i]; }, threads,
      [&](const Link& l) { return !ends || (is_end(l.inside) && is_end(l.outside)); });
  par::sort_unique(all.spoiled, threads);
  return std::move(all.spoiled);
}

Elements make_elements(const ComplexView& view, int threads) {
  Joined all = make_all<false>(
      view, view.tree.leaves, [](int64_t i) { return static_cast<int32_t>(i); }, threads,
      [](const Link&) { return true; });
  Elements& out = all.elements;
  out.edge_points = static_cast<int64_t>(out.position.size()) - out.face_points;
  const LargeArray<Vec3d> more = std::move(out.position);
  const int64_t own = view.vertices(), points = own + static_cast<int64_t>(more.size());
  par::reserve_pages(out.position, static_cast<size_t>(points), par::a_few(static_cast<size_t>(points)), threads);
  out.position.resize(static_cast<size_t>(points));
  par::for_n(points, threads, [&](int64_t i) { out.position[i] = i < own ? view.position[i] : more[i - own]; });
  return std::move(out);
}

} // namespace molmesh::contour
