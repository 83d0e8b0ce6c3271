// bounds_kernel.hpp — which clusters and atoms matter in a box, in single precision, for the best instruction set
// of this machine. Logarithms here are to base 2; κ comes as decay = κ·log2(e), Å⁻².
#pragma once
#include <cstdint>
#include <vector>

namespace molmesh::density {

/// The clusters near a node, positions relative to its middle (Å), so that single precision suffices for bounds.
/// Atoms in slots of 16 a cluster; unused slots have peak -1e30.
struct LocalClusters {
  std::vector<int32_t> cluster;                          ///< index in Field
  std::vector<int64_t> group;                            ///< innermost group
  std::vector<float> exponent;                           ///< its
  std::vector<float> lo_x, lo_y, lo_z, hi_x, hi_y, hi_z; ///< box, padded to a multiple of 16
  std::vector<float> cutoff2, peak;                      ///< Å², log2 of the largest atom's peak; padded likewise
  std::vector<float> atom_x, atom_y, atom_z, atom_peak;  ///< [16 n]
};

/// Half edges and middle of a box, Å, relative to the node's middle.
struct LocalBox {
  float middle[3], half[3];
};

/// Those of list[n] whose box is nearer to `box` than their cutoff, in order. out holds n + 16. Returns how many.
int32_t near_clusters(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& box, int32_t* out);

/// For each of list[n] an upper bound over `box` of the cluster's sum: out·2^log2_scale. Without `scaled` the scale
/// is 1 and bounds below 2^-122 are not told apart.
void upper_sums(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& box, float decay,
                bool scaled, float* out, float* log2_scale);

/// v = log2 v; term = 2^(exponent·log2_sum), never below 2^-126. n is rounded up to a multiple of 16.
void log2_all(float* v, int32_t n);
void power_terms(float* log2_sum, const float* exponent, int32_t n, float* term);

struct UnitRange {
  int32_t begin, end; ///< of a list of clusters
};

/// The units of a block (field.md §4). Arrays hold 16 more elements than units or atoms.
/// Unit u at the block's middle: log2 S and centroid, Å, relative to the node's middle. Its atoms are begin[u] …
/// begin[u + 1]: term of T at a point = 2^(constant + x·i + y·j + z·k) with i, j, k = -3.5 … 3.5.
struct BlockUnits {
  int32_t n = 0;
  std::vector<UnitRange> range;  ///< clusters
  std::vector<float> exponent;   ///< P
  std::vector<int32_t> begin{0}; ///< [n + 1]
  std::vector<float> log2_sum, x, y, z, log2_scale;
  std::vector<float> atom_x, atom_y, atom_z, atom_constant;
};

/// Largest change of a logarithm over a block that leaves single precision far from overflow.
constexpr float log2_range = 115;

/// Fills in all but n, range, exponent, for the clusters in `list`; begin and the atoms' arrays hold enough. Atoms
/// of a unit whose terms of T together stay below `within` are left out. False when single precision does not hold.
bool take_units(const LocalClusters& c, const int32_t* list, const LocalBox& block, float decay, float within,
                bool scaled, BlockUnits& units);

/// Σ S^P over units at the block's middle, and its gradient, Å⁻¹.
void sum_of_powers(const BlockUnits& units, const LocalBox& block, float decay, float* value, float* gradient);

} // namespace molmesh::density
