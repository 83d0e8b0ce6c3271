// from_map.hpp — a dense map at a contour level to a density near that contour.
#pragma once
#include "compose/dense_map.hpp"
#include "grid/block_grid.hpp"
#include <optional>

namespace molmesh::compose {

struct MapOptions {
  double level = 0;             ///< values above it are inside
  double spacing = 0;           ///< Å; 0: the map's own where that is one, else the smallest of the three
  std::optional<Vec3d> lattice; ///< Å: grid points lie whole spacings from it along each axis; none: from the map's
  double isovalue = 1;          ///< of the density, > 0
  double decay = 1;             ///< Å⁻², as the density says
  double band_lower = 0.9;      ///< isovalues
  double band_upper = 1.1;      ///< isovalues
  double slope = 1;             ///< Å⁻¹: of ln G at half of the places where the map crosses the level
  int threads = 1;
};

struct MapCounts {
  bool interpolated = false;
  double slope_of_map = 0; ///< its values per Å at half of the crossings
  int64_t wall_points = 0; ///< points of the map's walls that are inside
  double least = 0, most = 0;
};

/// The density G = isovalue·exp(s·(m - level)) of the map's values m, with s so that the slope is as asked for: ln
/// G, which is what the programs interpolate, is the map itself but for a factor. Values between the map's points
/// are tricubic; beyond its walls is outside. Throws Error(usage) where the map does not cross the level, or the
/// grid would be too large. info.source and creator are left to the caller.
BlockGrid from_map(const DenseMap& map, const MapOptions& options, MapCounts& counts);

} // namespace molmesh::compose
