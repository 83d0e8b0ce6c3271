// reach.hpp — finds the clusters that matter in a box however small the field is there: far from the surface the
// cutoffs of the field leave everything out.
#pragma once
#include "density/field/field.hpp"

namespace molmesh::label {

/// Keeps a reference to the field.
class Reach {
public:
  explicit Reach(const density::Field& f);
  /// Ascending; those left out together change G anywhere in the box by at most 1e-7 of it. With ln s the largest
  /// (smallest) ln of a cluster's sum in the box and Q the product of the exponents from its group to the root, G
  /// >= s_min^Q of every cluster, and for exponents up to 1 leaving one out takes at most s_max^Q from G (field.md
  /// §1). With an exponent above 1: all clusters.
  std::vector<int32_t> matter(const density::Box& box) const;
  bool bounded() const { return bounded_; }
  double power(int64_t innermost) const { return power_[innermost]; }

private:
  const density::Field& f_;
  bool bounded_ = true;       ///< no exponent above 1
  std::vector<double> power_; ///< [innermost groups] Q
};

} // namespace molmesh::label
