// block_kernel.hpp — the vectorized inner loops, in single precision, for the best instruction set of this machine
// (scalar, AVX2, AVX-512; chosen at run time). Logarithms here are to base 2. Error of a power: below 1e-6
// relative.
#pragma once
#include <cstdint>
#include <vector>

namespace molmesh::density {

/// The clusters near a node, positions relative to its middle (Å), so that single precision suffices for bounds.
/// Atoms in slots of 16 a cluster; unused slots have peak -1e30.
struct LocalClusters {
  std::vector<int32_t> cluster;                          ///< index in Field
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

/// For each of list[n], log2 of an upper bound over `box` of the cluster's sum. decay: κ·log2(e), Å⁻². out holds n
/// + 16.
void upper_bounds(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& box, float decay,
                  float* out);

/// For each of list[n], log2 of the sum at the middle of `box` and the sum's centroid. Arrays hold n + 16.
void middle_sums(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& box, float decay,
                 float* sum, float* x, float* y, float* z);

/// v[i] = 2^v[i]; n a multiple of 16; below 2^-126 and above 2^127 the limit.
void exp2_all(float* v, int32_t n);

/// One unit of a selection for sum_unit. The three arguments of an axis are log2 of the factor at its eight points,
/// a + b·t + c·t², t = -3.5 … 3.5.
struct AxisArguments {
  float x, y, z, constant; ///< b per axis; the constant belongs to the x axis
};
struct UnitArguments {
  AxisArguments outer;       ///< P·ln of what T is multiplied with in S
  float curvature;           ///< c, the same on each axis
  float exponent;            ///< P
  const AxisArguments* atom; ///< terms of T, c = 0
  int32_t atoms;
};

/// sum[512] += (S)^P at each point. scratch holds 96·(atoms + 1) + 64.
void add_unit(const UnitArguments& unit, float* scratch, float* sum);

/// to[512] += from^p, from = 0. Zero stays zero.
void raise_group(float p, float* from, float* to);

/// Bit 8·j + k of word i of below and above: v < lower, v > upper.
void classify_points(const float* v, float lower, float upper, uint64_t* below, uint64_t* above);

/// Copies the v whose bit of active[8] is set to out, in order; writes nothing more. Returns how many.
int32_t pack_active(const float* v, const uint64_t* active, float* out);

/// Name of the instruction set in use.
const char* instruction_set();

} // namespace molmesh::density
