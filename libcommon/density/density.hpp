// density.hpp — computes the sparse density grid of a hierarchy: the front door of this room.
#pragma once
#include "density/band/neighboring_search.hpp"
#include "molecule/hierarchy.hpp"

namespace molmesh::density {

struct Options {
  double spacing = 0.5;    ///< h, Å; used when grid_points is 0
  int64_t grid_points = 0; ///< along the longest axis
  double margin =
      -1; ///< Å beyond the outermost centres; negative: just large enough that the band never touches the wall
  double decay = 1;                                        ///< κ, Å⁻²
  double isovalue = 1, band_lower = 0.9, band_upper = 1.1; ///< in units of G
  double tolerance = 1e-4;                                 ///< ε of I1
  bool full_search = false;
  AtomSearch atoms = AtomSearch::bvh;
  int threads = 1;
  Tile tile;               ///< the part of the grid whose blocks are wanted; the band finder has to know of tiles
  bool any_values = false; ///< values above a float's range stay infinite: for a count, whose grid is coarser
  std::function<void(int64_t done, int64_t total)> progress;
  BandSink take; ///< receives the band's blocks; the returned Band is then empty. Empty: the band keeps them
};

/// What compute() refuses of the options, at a grid's spacing of h Å. Throws Error(usage).
void check(const Options& options, double h);
/// What compute() refuses of the field at any spacing: logarithms of 1e8 and more. Throws Error(usage).
void check_field(const Hierarchy& hierarchy, const Options& options);

/// Which band to search for; how, on which part and with what progress, is as by default.
SearchOptions band_of(const Options& options);

struct Counts {
  SearchCounts search;
  double margin = 0; ///< Å, as used
};

/// Finds the band of a field: find_band, or what does the same on a device.
using BandFinder = std::function<Band(const Field&, const GridFrame&, const SearchOptions&, SearchCounts&)>;

/// Computes the band, all but info.creator. Of a tile: its blocks alone, and of the numbers of `info` and Counts
/// what comes from them; all else as of the whole. Atoms of radius 0 make no density. Throws Error(failed) if the
/// wall of a grid with the caller's margin cuts the surface or no cell reaches the band (of a tile: none may),
/// Error(usage) if the grid is too large to index, the band too narrow for the tolerance (docs/theory/field.md §5)
/// or, but for any_values, a value too large for a float.
Band compute(const Hierarchy& h, const Options& options, Counts& counts, const BandFinder& find = find_band);

} // namespace molmesh::density
