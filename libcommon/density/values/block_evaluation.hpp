// block_evaluation.hpp — evaluates G on the 8³ points of one block, from the atoms that matter there.
#pragma once
#include "density/culling/block_atoms.hpp"
#include "density/values/block_sums_simd.hpp"
#include "density/values/log_sums_simd.hpp"

namespace molmesh::density {

/// Scratch of one thread.
class Evaluator {
public:
  /// h: Å, between the block's points. out[512]: slot 64·i + 8·j + k.
  void evaluate(const Field& f, const BlockAtoms& s, double h, float* out);

private:
  template <class T>
  struct Scratch {
    BlockRows<T> rows;
    AlignedVector<T> level; ///< [512 l]: the open group of level l
  };
  template <class T, class Units>
  void sum(const Field& f, const BlockAtoms& s, const Units& u, const BlockShape<T>& shape, double h,
           Scratch<T>& scratch, T* out);
  template <class T>
  void add_body(const Field& f, const BlockAtoms& s, const BlockAtoms::UnitBody& body, double h, T* out) const;
  void add_log_body(const Field& f, const BlockAtoms& s, const BlockAtoms::UnitBody& body, double h,
                    LogSums& to) const;
  void in_single(const Field& f, const BlockAtoms& s, double h, float* out);
  void in_double(const Field& f, const BlockAtoms& s, double h, float* out);
  void by_logarithms(const Field& f, const BlockAtoms& s, double h, float* out);
  Scratch<float> single_;
  Scratch<double> double_;
  AlignedVector<double> exact_;
  std::vector<LogSums> logs_;
  LogScratch log_scratch_;
};

} // namespace molmesh::density
