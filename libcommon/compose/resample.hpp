// resample.hpp — a density moved by any rigid motion, on another lattice.
#pragma once
#include "geom/rigid.hpp"
#include "grid/block_grid.hpp"

namespace molmesh::compose {

/// How far values were from the grid's own after a second resampling took them back to its points, a sample of
/// those within the band.
struct ResamplingError {
  double value = 0;       ///< the most, |ΔG| / max(1, G)
  double distance = 0;    ///< the most, Å: |Δln G| over the length of its gradient
  double distance_99 = 0; ///< 99 of 100 are below this, Å
};

/// The motion from indices of the lattice at `origin` to those of a grid that is moved by `place`; equal spacings.
Rigid index_motion(const GridFrame& grid, const Rigid& place, Vec3d origin);

/// The grid moved by `place`, at origin + spacing·(i,j,k), with its own spacing. Values come from Interpolant,
/// sides elsewhere from the next grid point; the band is complete for the values (I2).
BlockGrid resample(const BlockGrid& grid, const Rigid& place, Vec3d origin, int threads, ResamplingError& error);

} // namespace molmesh::compose
