// leaf_passes.hpp — passes from the surface's cells to the leaves of an octree that is balanced across faces.
// Over a launcher. Every sum keeps its order, sets are united by sorting: the same leaves from every launcher.
#pragma once
#include "base/error.hpp"
#include "contour/octree/chord_items.hpp"
#include "contour/octree/error_function.hpp"
#include "contour/octree/face_balance.hpp"
#include "contour/octree/leaf_items.hpp"
#include "contour/octree/leaves.hpp"
#include "contour/surface/surface_passes.hpp"
#include "isosurface/isosurface_view.hpp"
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace molmesh::contour {

/// Members as in LeafList.
template <par::Launcher Launcher>
struct LeafLists {
  par::List<Launcher, uint64_t> key;
  par::List<Launcher, uint8_t> level;
  par::List<Launcher, OctreeView::Block> block;
  par::List<Launcher, int32_t> large;
  double adapt = 0;
};

template <par::Launcher Launcher>
class LeafPasses {
  template <class T>
  using Array = typename Launcher::template Array<T>;
  using Nodes = par::List<Launcher, par::KeyedWord>;

public:
  LeafPasses(Launcher& m, const LatticeView& lattice, int top_level, const SurfaceView& surface,
             const RefineOptions& options)
      : m_(m), l_(lattice), top_(top_level), levels_(std::max(top_level, 3)), surface_(surface), options_(options) {
  }

  LeafLists<Launcher> run() {
    collect_surface_nodes();
    for (int level = 1; level <= levels_; ++level) {
      divided_.push_back(uploaded(options_.divided, level));
      loose_.push_back(uploaded(options_.loose, level));
    }
    double tolerance = options_.adapt;
    double of_edge = options_.loose.empty() ? 0 : 0.125;
    select(tolerance, of_edge);
    if (options_.adapt > 0) {
      find_cuts();
      const double most = allowed_cut();
      while (std::fabs(cut_off()) > most && tolerance > 0) {
        if (of_edge * (1 << most_merges) > tolerance) // loose nodes first: the others owe them nothing
          of_edge /= 2;
        else
          tolerance = tolerance > least_tolerance ? tolerance / 2 : 0;
        select(tolerance, of_edge);
      }
    }
    LeafLists<Launcher> found = leaves();
    found.adapt = tolerance;
    return found;
  }

private:
  /// SurfaceNodes' arrays.
  struct Level {
    Array<uint64_t> key;
    Array<int32_t> child, cell;
    Array<uint8_t> flags, corners;
    SurfaceNodes view;
  };
  // Chords may cut off this share of the volume beyond what tetsmooth gives back by putting points outside the
  // isosurface; below this tolerance all surface cells that are not plane stay fine.
  static constexpr double most_cut = 0.0055, least_tolerance = 0.02;

  Nodes& refined(int level) { return refined_[level]; }
  NodeSet set(int level) { return {refined(level).data(), refined(level).n}; }
  SurfaceNodes surface_nodes(int level) const { return level_[level].view; }

  void collect_surface_nodes() {
    Level fine;
    const int64_t cells = surface_.n;
    fine.key = m_.template array<uint64_t>(cells);
    fine.flags = m_.template array<uint8_t>(cells);
    fine.corners = m_.template array<uint8_t>(cells);
    m_.for_n("start from cells", cells,
             StartFromCells{surface_.cell, l_.isovalue, fine.key.data(), fine.flags.data(), fine.corners.data()});
    fine.view = {fine.key.data(), nullptr, nullptr, fine.flags.data(), fine.corners.data(), cells, 0, cells};
    level_.push_back(std::move(fine));
    for (int l = 1; l <= top_ + 2; ++l) {
      const SurfaceNodes below = surface_nodes(l - 1);
      auto child = par::gather<int32_t>(m_, "first children", below.n, FirstChildren{below.key});
      Level here;
      here.key = m_.template array<uint64_t>(child.n);
      here.cell = m_.template array<int32_t>(child.n);
      here.flags = m_.template filled<uint8_t>(child.n, 0);
      here.corners = m_.template array<uint8_t>(child.n);
      here.child = std::move(child.array);
      m_.for_n(
          "make parents", child.n,
          MakeParents{below, here.child.data(), child.n, here.key.data(), here.cell.data(), here.corners.data()});
      here.view = {here.key.data(),     here.child.data(), here.cell.data(), here.flags.data(),
                   here.corners.data(), child.n,           below.n,          cells};
      level_.push_back(std::move(here));
    }
  }

  /// How coarse the octree is. of_edge: what loose nodes may be off, as a share of their edge.
  void select(double tolerance, double of_edge) {
    for (int l = 1; options_.adapt > 0 && l <= std::min(most_merges, top_); ++l) {
      const Nodes& loose = loose_[static_cast<size_t>(l) - 1];
      m_.for_n("merge nodes", surface_nodes(l).n,
               MergeNodes{l_.cells,
                          surface_.sample,
                          surface_nodes(l),
                          surface_nodes(l - 1),
                          l,
                          tolerance,
                          {loose.data(), loose.n},
                          std::max(tolerance, of_edge * (1 << l))});
    }
    refined_.clear();
    refined_.resize(static_cast<size_t>(levels_) + 1);
    for (int level = 1; level <= levels_; ++level)
      refined(level) = level > top_ ? layer(level, -1) : refine(level);
  }

  /// Volume that chords may cut off in all, in cubed fine spacings. Of a halved grid tetsmooth gives back
  /// more: its spacing is the file's.
  double allowed_cut() {
    const int64_t runs = (surface_.n + SumCells::run - 1) / SumCells::run;
    auto part = m_.template array<SurfaceSums>(runs);
    m_.for_n("sum cells", runs, SumCells{surface_.cell, surface_.sample, surface_.n, l_.isovalue, part.data()});
    const SurfaceSums all = sum(part, runs, SurfaceSums{});
    return most_offset * all.area + most_cut * all.volume();
  }
  void find_cuts() {
    cell_cut_ = m_.template array<double>(CutByCells::items(surface_.n));
    m_.for_n("cut by cells", CutByCells::items(surface_.n),
             CutByCells{surface_.cell, surface_.sample, surface_nodes(0).key, surface_.n, l_.isovalue,
                        cell_cut_.data()});
  }
  double cut_off() {
    Array<double> cut;
    int64_t n = 0;
    for (int l = 1; l <= std::min(most_merges, top_); ++l) {
      n = surface_nodes(l).n;
      auto here = m_.template array<double>(n);
      m_.for_n("cut by nodes", n,
               CutByNodes{cell_cut_.data(), CutByCells::every(surface_.n), surface_nodes(l), set(l), l,
                          l > 1 ? cut.data() : nullptr, here.data()});
      cut = std::move(here);
    }
    return sum(cut, n, 0.);
  }
  /// On the host, in their order.
  template <class T>
  T sum(const Array<T>& array, int64_t n, T total) {
    std::vector<T> value(static_cast<size_t>(n));
    m_.download(array, n, value.data());
    for (const T& v : value)
      total += v;
    return total;
  }

  /// All nodes of the level that have children.
  Nodes refine(int level) {
    const SurfaceNodes blocks = surface_nodes(level + 2);
    Nodes surface{m_.template array<par::KeyedWord>(blocks.n), blocks.n};
    Array<uint64_t> near = m_.template array<uint64_t>(6 * blocks.n);
    m_.for_n("block nodes", blocks.n,
             SurfaceBlocks{surface_nodes(level), surface_nodes(level + 1), blocks, surface.data(), near.data()});
    const Nodes balance = level == 1 ? Nodes{} : parents_of_neighbours(level);
    const Nodes uniform = level == 1 && !(options_.adapt > 0) ? uniform_nodes() : Nodes{};
    const Nodes& divided = divided_[static_cast<size_t>(level) - 1];
    Nodes overhang[3]; // nodes that reach beyond the domain
    for (int a = 0; a < 3; ++a)
      if (l_.cells[a] % (1 << level) != 0)
        overhang[a] = layer(level, a);
    Nodes nodes =
        par::unite(m_, {&surface, &balance, &uniform, &divided, &overhang[0], &overhang[1], &overhang[2]});
    if (level == 1 && options_.adapt > 0)
      grow(nodes, level);
    if (options_.adapt > 0 && level <= most_merges)
      spread(surface, near, nodes);
    return nodes;
  }

  Nodes parents_of_neighbours(int level) {
    const auto of = [&](NodeSet below) {
      return par::gather<par::KeyedWord>(m_, "balance", below.n,
                                         ParentsOfNeighbours{below, nodes_per_axis(l_.cells, level)});
    };
    if (options_.layers == 1)
      return of(set(level - 1));
    Nodes wide = par::unite(m_, {&refined(level - 1)});
    grow(wide, level - 1);
    return of({wide.data(), wide.n});
  }
  /// By as many layers of the level's nodes as are asked for beyond the first.
  void grow(Nodes& nodes, int level) {
    for (int k = 1; k < options_.layers; ++k) {
      const Nodes wider = par::gather<par::KeyedWord>(
          m_, "neighbours", nodes.n, WithNeighbours{{nodes.data(), nodes.n}, nodes_per_axis(l_.cells, level)});
      nodes = par::unite(m_, {&wider});
    }
  }

  /// Of RefineOptions: the level's.
  Nodes uploaded(const std::vector<std::vector<par::KeyedWord>>& by_level, int level) {
    Nodes nodes;
    if (static_cast<size_t>(level) <= by_level.size() && !by_level[static_cast<size_t>(level) - 1].empty()) {
      const std::vector<par::KeyedWord>& words = by_level[static_cast<size_t>(level) - 1];
      nodes.n = std::ssize(words);
      nodes.array = m_.upload(words.data(), nodes.n);
    }
    return nodes;
  }

  Nodes uniform_nodes() {
    Vec3i first, last;
    for (int a = 0; a < 3; ++a) {
      first[a] = std::max(0, l_.grid_first[a]) >> 1;
      last[a] = (std::min(l_.cells[a], l_.grid_last[a]) - 1) >> 1;
    }
    const Vec3i low{first.x >> 2, first.y >> 2, first.z >> 2}, high{last.x >> 2, last.y >> 2, last.z >> 2};
    const BlockBox box{low, high - low + Vec3i{1, 1, 1}};
    return par::gather<par::KeyedWord>(m_, "uniform nodes", box.count(),
                                       UniformNodes{l_, box, first, last, options_.inside, options_.outside});
  }

  /// The last layer of a level's nodes along the axis; all where axis < 0.
  Nodes layer(int level, int axis) {
    const Vec3i nodes = nodes_per_axis(l_.cells, level);
    BlockBox box = all_blocks(nodes);
    if (axis >= 0) {
      box.lower[axis] = (nodes[axis] - 1) >> 2;
      box.size[axis] = 1;
    }
    Nodes out = par::gather<par::KeyedWord>(m_, "node layer", box.count(), NodeLayer{box, nodes, axis});
    return axis >= 0 ? std::move(out) : par::unite(m_, {&out});
  }
  static BlockBox all_blocks(Vec3i nodes) {
    return {{0, 0, 0}, {(nodes.x + 3) >> 2, (nodes.y + 3) >> 2, (nodes.z + 3) >> 2}};
  }

  /// Waves until none has an effect.
  void spread(const Nodes& surface, const Array<uint64_t>& near, Nodes& nodes) {
    const auto candidate = par::gather<int64_t>(m_, "near blocks", surface.n, NearBlocks{near.data()});
    const NodeSet set{nodes.data(), nodes.n};
    auto position = m_.template array<int64_t>(7 * candidate.n);
    auto grown = m_.template array<uint64_t>(candidate.n);
    auto changed = m_.template array<int64_t>(candidate.n + 1);
    m_.for_n("find neighbours", candidate.n,
             FindNeighbours{candidate.data(), surface.data(), set, position.data()});
    do {
      m_.for_n("spread", candidate.n,
               SpreadWave{candidate.data(), position.data(), near.data(), set, grown.data(), changed.data()});
      m_.for_n("apply", candidate.n, ApplyWave{position.data(), grown.data(), nodes.data()});
    } while (m_.scan("scan", changed.data(), candidate.n) > 0);
  }

  LeafLists<Launcher> leaves() {
    const Vec3i cells = l_.cells, roots = nodes_per_axis(cells, levels_);
    std::vector<Nodes> part;
    part.push_back(par::gather<par::KeyedWord>(m_, "leaf blocks", set(3).n, LeafBlocks{set(3)}));
    part.push_back(par::gather<par::KeyedWord>(m_, "leaf roots", all_blocks(roots).count(),
                                               LeafRoots{all_blocks(roots), roots, set(levels_), levels_}));
    for (int l = 4; l <= levels_; ++l)
      part.push_back(
          par::gather<par::KeyedWord>(m_, "leaf children", 8 * set(l).n,
                                      LeafChildren{set(l), set(l - 1), nodes_per_axis(cells, l - 1), l - 1}));
    std::vector<const Nodes*> parts;
    for (const Nodes& p : part)
      parts.push_back(&p);
    const Nodes entry = par::unite(m_, parts);
    auto count = m_.template array<int64_t>(entry.n + 1), blocks = m_.template array<int64_t>(entry.n + 1);
    const CountLeaves entries{entry.data(), set(1), set(2), cells, count.data(), blocks.data()};
    m_.for_n("count leaves", entry.n, entries);
    const int64_t leaves = m_.scan("scan", count.data(), entry.n), n = m_.scan("scan", blocks.data(), entry.n);
    if (leaves >= most_leaves)
      fail(Status::failed,
           "the octree has " + std::to_string(leaves) + " leaves, expected fewer than " +
               std::to_string(most_leaves) + ", or a larger adapt, or a coarser grid",
           {"adapt"});
    LeafLists<Launcher> out{{m_.template array<uint64_t>(leaves), leaves},
                            {m_.template array<uint8_t>(leaves), leaves},
                            {m_.template array<OctreeView::Block>(n), n},
                            {m_.template array<int32_t>(entry.n - n), entry.n - n}};
    m_.for_n("place leaves", entry.n,
             PlaceLeaves{entries, out.block.data(), out.large.data(), out.key.data(), out.level.data()});
    m_.for_n("fill blocks", 8 * n, FillBlocks{out.block.data(), set(1), set(2), out.key.data(), out.level.data()});
    return out;
  }

  Launcher& m_;
  LatticeView l_;
  int top_, levels_; ///< levels_: at least 3, so that blocks of 8³ fine cells are nodes
  SurfaceView surface_;
  RefineOptions options_;
  std::vector<Level> level_;           ///< [top + 3]
  Array<double> cell_cut_;             ///< CutByCells
  std::vector<Nodes> refined_;         ///< [levels + 1] nodes with children
  std::vector<Nodes> divided_, loose_; ///< [levels] of RefineOptions
};

} // namespace molmesh::contour
