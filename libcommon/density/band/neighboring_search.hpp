// neighboring_search.hpp — finds the active set: every corner of a cell that meets the band around the isosurface.
// §3.1 of Liao et al. 2013, over blocks of 8³ points. The paper starts from one active cell and floods its
// neighbors, and would miss a component without a start. Here bounds on G decide for every block near the molecule
// whether it lies below the band, above it, or is open (culling/block_bounds.cpp, docs/theory/field.md §5), so
// there is no first active cell: the search grows from all open blocks to those neighbors that share a cell of the
// band with them (BrickSearch::need_neighbors, add_needed). The same bounds say which faraway points are inside, in
// place of a flood fill. Nothing is dense over the grid.
#pragma once
#include "density/band/search_counts.hpp"
#include "density/culling/block_atoms.hpp"
#include "density/field/field.hpp"
#include "grid/band.hpp"
#include "grid/tile.hpp"
#include <functional>
#include <span>

namespace molmesh::density {

/// How the clusters of atoms that matter near a brick are found.
enum class AtomSearch {
  bvh,    ///< boxes of the hierarchy's clusters, tested while the grid is halved
  kdtree, ///< a kd-tree over the clusters, asked by every brick of the grid
  all     ///< no search: every atom counts everywhere
};

/// Receives the blocks of the band as they are found, each once, in runs in any order. Blocks and values are valid
/// during the call alone. info: the numbers that empty_band() sets.
using BandSink = std::function<void(const FieldInfo& info, std::span<const BandBlocks> runs)>;

struct SearchOptions {
  double isovalue = 1, band_lower = 0.9, band_upper = 1.1; ///< in units of G
  double tolerance = 1e-4;                                 ///< ε of I1
  bool full = false;                                       ///< compute every point of the grid
  AtomSearch atoms = AtomSearch::bvh;
  int threads = 1;
  Tile tile;                                                 ///< the part of the grid whose blocks are wanted
  std::function<void(int64_t done, int64_t total)> progress; ///< called from any thread; may be empty
  BandSink take; ///< empty: the band keeps its blocks, and their memory grows with the surface
};

/// How the tolerance is shared.
Budget budget_for(const SearchOptions& options);
/// Comparing floats with these is comparing them with the options' doubles.
struct FloatBand {
  float lower, upper;
};
FloatBand float_band(const SearchOptions& options);
/// The band before the search: the frame and the numbers of `info`, without blocks.
Band empty_band(const Field& f, const GridFrame& frame, const SearchOptions& options);
/// Of the points whose sides a tile needs: its own, and those of the bricks next to it.
Box searched_box(const GridFrame& frame, Tile tile);
/// Finds the band: frame, values, sides and the numbers of `info`; the caller sets the texts. The field must be
/// made with budget_for(options).far; of a tile, keep_near() may have left it what lies near searched_box(). Same
/// result for any number of threads; what tiles have, together, is what the whole has.
Band find_band(const Field& f, const GridFrame& frame, const SearchOptions& options, SearchCounts& counts);

} // namespace molmesh::density
