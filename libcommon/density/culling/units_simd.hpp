// units_simd.hpp — drops the atoms that do not matter within the units of a block, in single precision, for the
// best instruction set of this machine. Logarithms are to base 2.
#pragma once
#include "density/culling/bounds_simd.hpp"

namespace molmesh::density {

/// The units of a block (field.md §4): S(x) = 2^log2_term · 2^(-decay·(2δ·(m - c) + δ²)) · T(x), δ = x - m, m the
/// block's middle, c = (x, y, z) the unit's atom of the largest term there, Å.
/// Atoms of unit u: begin[u] … begin[u + 1]; their terms of T at a point are 2^(constant + x·i + y·j + z·k) with
/// i, j, k = -3.5 … 3.5. Arrays hold 16 more elements than there are units or atoms.
template <class T>
struct UnitsOf {
  int32_t n = 0;
  std::vector<int32_t> begin{0}; ///< [n + 1]
  AlignedVector<T> exponent, log2_term, x, y, z;
  AlignedVector<T> atom_x, atom_y, atom_z, atom_constant;
};

/// c relative to the brick's middle. Direct: the atoms' terms hold the middle factor of S too, but for its
/// curvature, which is the same for all.
struct BlockUnits : UnitsOf<float> {
  bool direct = false;
  bool folded = false;       ///< direct, and T of units with P = 1/2 holds log2_term but for the unit's `root`
  bool roots = false;        ///< folded, and there are two units or more, all with P = 1/2
  float dropped = 0;         ///< bound on what ΣS^P loses with the atoms that are dropped, when that was asked for
  AlignedFloats root;        ///< 2 where a root must be exact: T is S/4 then; 0 where few digits will do
  AlignedFloats log2_factor; ///< of T in S
  AlignedFloats log2_atom;   ///< of all atoms of the units, dropped or not: log2 of their terms in the middle
  /// Slots of the brick's clusters: of each unit's c, and, when not direct, of the atoms.
  std::vector<int32_t> center_slot, atom_slot;
};

/// In double precision, c relative to the block's middle. Never direct.
using ExactUnits = UnitsOf<double>;

/// Largest change of a logarithm over a block that leaves single precision far from overflow.
constexpr float log2_range = 115;

/// The n units `list` of `from`, into arrays that hold enough, without atoms that do not matter: all that are
/// dropped change ΣS^P by at most `within`, or, without log2_upper (bounds on the sums of all units of `from` over
/// the block), the sum of each unit by that part of it. to.direct is the caller's wish. False when single precision
/// does not hold.
bool take_units(const LocalClusters& brick, const NearUnits& from, const int32_t* list, int32_t n,
                const LocalBox& block, float decay, const float* log2_upper, float within, BlockUnits& to);

} // namespace molmesh::density
