// evaluate.hpp — G on the 8³ points of one block from a selection.
#pragma once
#include "density/block_kernel.hpp"
#include "density/selection.hpp"

namespace molmesh::density {

/// Scratch of one thread.
class Evaluator {
public:
  /// middle: Å, of the block's points, spaced h. out[512]: slot 64·i + 8·j + k.
  void evaluate(const Field& f, const Selection& s, Vec3d middle, double h, float* out);

private:
  void in_single(const Field& f, const Selection& s, double h, float* out);
  void in_double(const Field& f, const Selection& s, Vec3d middle, double h, float* out);
  void by_logarithms(const Field& f, const Selection& s, Vec3d middle, double h, float* out);
  BlockRows rows_;
  Floats single_;
  std::vector<double> double_;
};

} // namespace molmesh::density
