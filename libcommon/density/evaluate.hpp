// evaluate.hpp — G on the 8³ points of one block from a selection.
#pragma once
#include "density/selection.hpp"

namespace molmesh::density {

/// How the sums are carried. Single precision holds while the tolerance is well above its rounding and no term that
/// matters underflows; logarithms hold always.
enum class Arithmetic { in_single, in_double, in_logarithms };

/// The cheapest arithmetic that keeps the bound for this field and tolerance, whatever the block.
Arithmetic arithmetic_for(const Field& f, double tolerance);

/// Scratch of one thread.
class Evaluator {
public:
  /// middle: Å, of the block's points, spaced h. out[512]: slot 64·i + 8·j + k.
  void evaluate(const Field& f, const Selection& s, Vec3d middle, double h, Arithmetic arithmetic, float* out);

private:
  void in_single(const Field& f, const Selection& s, Vec3d middle, double h, float* out);
  void in_double(const Field& f, const Selection& s, Vec3d middle, double h, float* out);
  void by_logarithms(const Field& f, const Selection& s, Vec3d middle, double h, float* out);
  std::vector<float> single_, scratch_;
  std::vector<double> double_;
  std::vector<AxisArguments> arguments_;
};

} // namespace molmesh::density
