// log_sum.hpp — adds exponentials of any size as logarithms, and takes the sums up the levels of the field.
#pragma once
#include "cuda/density/bvh.hpp"
#include <cmath>

namespace molmesh::cuda {

/// Σ exp(terms) and, weighted by them, Σ exp(term)·moment. Real: of the terms relative to the largest.
template <class Real, bool moments>
struct LogSum {
  double top = -HUGE_VAL; ///< the largest term
  Real sum = 0;           ///< relative to it
  Vec3<Real> moment{};

  MOLMESH_HD void add(double term, Vec3<Real> at = {}) {
    if (!(term > -HUGE_VAL))
      return;
    if (term > top) {
      const Real scale = std::exp(Real(top - term));
      sum = sum * scale + 1;
      if (moments)
        moment = scale * moment + at;
      top = term;
    } else {
      const Real w = std::exp(Real(term - top));
      sum += w;
      if (moments)
        moment += w * at;
    }
  }
  MOLMESH_HD double ln() const { return top > -HUGE_VAL ? top + std::log(double(sum)) : -HUGE_VAL; }
  /// Σ exp(term)·moment / Σ exp(term)
  MOLMESH_HD Vec3<Real> mean() const { return sum > 0 ? moment / sum : Vec3<Real>{}; }
};

/// The groups that are open while clusters pass by in ascending order: adds what an innermost group sums to, closes
/// groups that are left, and at the end tells the field. Sum: add(ln of a term, its gradient), ln(), mean().
template <class Sum>
struct OpenLevels {
  const FieldView& f;
  Sum root{}, open[FieldView::most_levels];
  int64_t group[FieldView::most_levels];

  MOLMESH_HD explicit OpenLevels(const FieldView& field) : f(field) {
    for (int l = 0; l < f.levels; ++l)
      group[l] = -1;
  }
  /// The sum of innermost group g, which now begins; closes others as needed.
  MOLMESH_HD Sum& enter(int64_t g) {
    if (group[0] == g)
      return open[0];
    int64_t at[FieldView::most_levels];
    at[0] = g;
    int leave = 0;
    for (int l = 1; l < f.levels; ++l) {
      at[l] = f.parent[l - 1][at[l - 1]];
      if (group[l] != at[l])
        leave = l;
    }
    close(leave);
    for (int l = 0; l < f.levels; ++l)
      group[l] = at[l];
    return open[0];
  }
  /// The field: call once, at the end.
  MOLMESH_HD Sum& finish() {
    close(f.levels - 1);
    return root;
  }

private:
  MOLMESH_HD void close(int last) {
    for (int l = 0; l <= last; ++l) {
      if (group[l] < 0)
        continue;
      const double p = f.exponent[l][group[l]];
      Sum& to = l + 1 < f.levels ? open[l + 1] : root;
      using Moment = decltype(open[l].mean());
      using Real = decltype(Moment{}.x);
      to.add(p * open[l].ln(), Real(p) * open[l].mean());
      open[l] = Sum{};
      group[l] = -1;
    }
  }
};

} // namespace molmesh::cuda
