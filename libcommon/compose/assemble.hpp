// assemble.hpp — densities from files, each with a rigid motion, to the density of the whole.
#pragma once
#include "compose/join.hpp"
#include "compose/resample.hpp"
#include "geom/rigid.hpp"
#include <map>
#include <span>
#include <string>
#include <vector>

namespace molmesh::compose {

/// The surface of sums of Gaussians; others have other names, and their densities do not add up.
inline constexpr const char* gaussian = "gaussian";

/// A density as a file holds it.
struct Ingredient {
  BlockGrid grid;
  Tail tail;
  double resampling_error = 0; ///< of former joins
  std::string surface = gaussian;
  double probe = 0; ///< Å, of surfaces that have a probe
  std::string file; ///< for messages
};

/// A copy of an ingredient.
struct Copy {
  const Ingredient* of;
  Rigid place;
  bool subtract = false;
};

struct Assembly {
  BlockGrid grid; ///< all but info.creator
  Tail tail;
  double resampling_error = 0; ///< the largest, also of former joins
  int64_t copied = 0, resampled = 0;
  ResamplingError worst; ///< of this join
  Counts counts;
};

/// The lattice is that of the first copy, moved if that copy is only translated. Copies on it, to a ten-thousandth
/// of a spacing, keep their values bit for bit; others are resampled. The first copy adds. band_lower, band_upper:
/// 0: what all ingredients know; where several are summed at least 0.9 isovalues below. Throws Error(bad_input)
/// where spacings, isovalues or decay rates differ, Error(usage) as join(), and where a band is asked for that an
/// ingredient does not know.
Assembly assemble(std::span<const Copy> copies, double band_lower, double band_upper, const Options& options);

} // namespace molmesh::compose
