// elements.cpp — faces, then rings, joined in the order of the octree's curve.
#include "contour/elements.hpp"
#include "contour/detail/at.hpp"
#include "contour/detail/face_pass.hpp"
#include "contour/detail/ring_pass.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <utility>

namespace molmesh::contour {

using detail::at;
namespace {

using detail::Batch;
using detail::Link;

constexpr int64_t batch_size = 2048; // leaves or links; fixed, so that the result does not know the threads

/// Appends the batches in order and gives their new points the numbers from out.position.size() on.
void join(std::vector<Batch>& batches, Elements& out, std::vector<Link>& links, std::vector<int32_t>& wall,
          int threads) {
  struct Start {
    size_t tet, tri, link, point;
  };
  std::vector<Start> start;
  Start s{out.tet.size(), out.tri.size(), links.size(), out.position.size()};
  for (const Batch& b : batches) {
    start.push_back(s);
    s.tet += b.tet.size();
    s.tri += b.tri.size();
    s.link += b.link.size();
    s.point += b.point.size();
  }
  for (const Batch& b : batches)
    out.spoiled.insert(out.spoiled.end(), b.spoiled.begin(), b.spoiled.end());
  const size_t own = out.position.size() - wall.size();
  out.tet.resize(s.tet);
  out.tri.resize(s.tri);
  out.tri_sides.resize(s.tri);
  out.boundary.resize(s.tri);
  links.resize(s.link);
  out.position.resize(s.point);
  wall.resize(s.point - own);
  par::for_n(static_cast<int64_t>(batches.size()), threads, 1, [&](int64_t i) {
    Batch& b = batches[at(i)];
    const Start& to = start[at(i)];
    const auto number = [&](int32_t v) {
      return v >= 0 || v == detail::no_vertex ? v : static_cast<int32_t>(to.point) - 1 - v;
    };
    for (size_t k = 0; k < b.tet.size(); ++k)
      for (size_t c = 0; c < 4; ++c)
        out.tet[to.tet + k][c] = number(b.tet[k][c]);
    for (size_t k = 0; k < b.tri.size(); ++k) {
      for (size_t c = 0; c < 3; ++c)
        out.tri[to.tri + k][c] = number(b.tri[k][c]);
      out.tri_sides[to.tri + k] = b.tri_sides[k];
      out.boundary[to.tri + k] = b.boundary[k];
    }
    for (size_t k = 0; k < b.link.size(); ++k) {
      Link l = b.link[k];
      links[to.link + k] = {l.inside, l.outside, number(l.from), number(l.via), number(l.to)};
    }
    for (size_t k = 0; k < b.point.size(); ++k) {
      out.position[to.point + k] = b.point[k];
      wall[to.point + k - own] = b.point_wall[k];
    }
    b = Batch{};
  });
}

/// Faces of the leaves that leaf(0 … n - 1) names, into out and links; wall as in join.
template <class Leaf>
void add_faces(const Complex& complex, int64_t n, Leaf leaf, const bool wanted[2], Elements& out,
               std::vector<Link>& links, std::vector<int32_t>& wall, int threads) {
  std::vector<Batch> batches(at((n + batch_size - 1) / batch_size));
  par::for_n(static_cast<int64_t>(batches.size()), threads, 1, [&](int64_t b) {
    for (int64_t i = b * batch_size; i < std::min(n, (b + 1) * batch_size); ++i)
      detail::make_faces(complex, leaf(i), wanted, batches[at(b)]);
  });
  join(batches, out, links, wall, threads);
}

/// Rings of all the edges in links.
void add_rings(const Complex& complex, std::vector<Link>& links, const bool wanted[2], Elements& out,
               std::vector<int32_t>& wall, int threads) {
  par::sort(links, threads);
  std::vector<int64_t> first; // link of each sign-change edge
  for (size_t i = 0; i < links.size(); ++i)
    if (i == 0 || !links[i].same_edge(links[i - 1]))
      first.push_back(static_cast<int64_t>(i));
  const auto edges = static_cast<int64_t>(first.size());
  first.push_back(static_cast<int64_t>(links.size()));
  std::vector<Batch> batches(at((edges + batch_size - 1) / batch_size));
  const auto own = static_cast<int32_t>(complex.position.size());
  const detail::RingVertices<Complex> vertices{complex, own, out.position.data() + own, wall.data()};
  par::for_n(static_cast<int64_t>(batches.size()), threads, 1, [&](int64_t b) {
    for (int64_t e = b * batch_size; e < std::min(edges, (b + 1) * batch_size); ++e)
      detail::make_ring(vertices, &links[at(first[at(e)])], links.data() + first[at(e + 1)], wanted,
                        batches[at(b)]);
  });
  std::vector<Link> none;
  join(batches, out, none, wall, threads);
}

/// [grid vertices] flags the corners of the leaves.
std::vector<uint8_t> corners(const Complex& complex, const std::vector<int32_t>& leaves) {
  std::vector<uint8_t> flag(at(complex.grid_vertices), 0);
  for (int32_t leaf : leaves)
    for (int c = 0; c < 8; ++c)
      flag[at(complex.grid_vertex[at(int64_t{8} * leaf + c)])] = 1;
  return flag;
}

/// Of the leaves' faces, and of the rings round edges with both ends flagged (all edges without flags): rings of
/// others may be incomplete.
std::vector<int32_t> spoiled_of(const Complex& complex, const std::vector<int32_t>& leaves,
                                const std::vector<uint8_t>* ends, int threads) {
  const bool none[2] = {false, false};
  Elements out;
  out.position = complex.position;
  std::vector<Link> links;
  std::vector<int32_t> wall;
  add_faces(
      complex, static_cast<int64_t>(leaves.size()), [&](int64_t i) { return leaves[at(i)]; }, none, out, links,
      wall, threads);
  if (ends) {
    const auto partial = [&](const Link& l) { // all faces at a split cell's centre are that cell's
      const auto end = [&](int32_t v) { return v >= complex.grid_vertices || (*ends)[at(v)]; };
      return !(end(l.inside) && end(l.outside));
    };
    links.erase(std::remove_if(links.begin(), links.end(), partial), links.end());
  }
  add_rings(complex, links, none, out, wall, threads);
  par::sort_unique(out.spoiled, threads);
  return std::move(out.spoiled);
}

} // namespace

std::vector<int32_t> find_spoiled(const Complex& complex, int threads) {
  // Every face that a surface cell has part in belongs to a leaf with a corner in common.
  std::vector<int32_t> crossed;
  for (int32_t leaf = 0; leaf < complex.tree.size(); ++leaf)
    if (complex.side[at(leaf)] == Side::crossed)
      crossed.push_back(leaf);
  return spoiled_of(complex, complex.leaves_at(corners(complex, crossed), threads), nullptr, threads);
}

std::vector<int32_t> spoiled_at(const Complex& complex, const std::vector<int32_t>& leaves, int threads) {
  // An edge of a leaf, halves and those on its faces included, has its ends among the corners of the leaves around;
  // all faces at it belong to leaves with such a corner.
  const std::vector<uint8_t> ends = corners(complex, complex.leaves_at(corners(complex, leaves), threads));
  return spoiled_of(complex, complex.leaves_at(ends, threads), &ends, threads);
}

Elements make_elements(const Complex& complex, bool inside, bool outside, int threads) {
  const bool wanted[2] = {outside, inside};
  Elements out;
  out.position = complex.position;
  std::vector<Link> links;
  std::vector<int32_t> wall;
  add_faces(
      complex, complex.tree.size(), [](int64_t i) { return static_cast<int32_t>(i); }, wanted, out, links, wall,
      threads);
  out.face_points = static_cast<int64_t>(wall.size());
  add_rings(complex, links, wanted, out, wall, threads);
  out.edge_points = static_cast<int64_t>(wall.size()) - out.face_points;
  par::sort_unique(out.spoiled, threads);
  return out;
}

} // namespace molmesh::contour
