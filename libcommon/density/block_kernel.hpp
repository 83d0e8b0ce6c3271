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
/// + 16. Bounds below 2^-122 are not told apart, unless `scaled`.
void upper_bounds(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& box, float decay,
                  bool scaled, float* out);

/// Arguments of the factors of kept atoms: term of T = 2^(constant + x·t_i + y·t_j + z·t_k), t = -3.5 … 3.5.
struct AtomArguments {
  float *x, *y, *z, *constant;
};

/// A unit at the middle of a block, positions relative to the node's middle.
struct UnitMiddle {
  float log2_sum = 0;     ///< of S
  float centroid[3] = {}; ///< Å
  float swing = 0;        ///< largest |x·3.5| + |y·3.5| + |z·3.5| of the kept atoms
  int32_t kept = 0;
};

/// The clusters list[n] as one unit: its middle, and the arguments of its atoms whose terms of T can reach
/// 2^log2_small in the block (all atoms: a low value). `to` holds 16 n + 16 more. False when single precision
/// cannot tell: all terms are next to nothing beside the bound for their cluster.
bool take_unit(const LocalClusters& c, const int32_t* list, int32_t n, const LocalBox& block, float decay,
               float log2_small, const AtomArguments& to, UnitMiddle& middle);

/// v[i] = 2^v[i]; n a multiple of 16; below 2^-126 and above 2^127 the limit.
void exp2_all(float* v, int32_t n);

/// One unit of a selection: S^P = T^P · 2^(constant + Σ over axes (slope·t + curvature·t²)).
struct UnitArguments {
  float exponent; ///< P
  float constant, slope[3], curvature;
  AtomArguments atom;
  int32_t atoms;
};

/// sum[512] += (S)^P at each point. scratch holds 96·(atoms + 1) + 64.
void add_unit(const UnitArguments& unit, float* scratch, float* sum);

/// to[512] += from^p, from = 0. Zero stays zero.
void raise_group(float p, float* from, float* to);

/// Name of the instruction set in use.
const char* instruction_set();

} // namespace molmesh::density
