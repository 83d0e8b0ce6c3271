// device_field.hpp — the field and the molecule's bounding volume hierarchy in a Backend's memory.
#pragma once
#include "cuda/density/bvh.hpp"
#include "cuda/par/backend.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::cuda {

/// Single precision holds: every exponent above the innermost level is 1, the tolerance is well above rounding, no
/// term that matters underflows, nor what EvaluateBlock multiplies of it without its peak, and no power overflows
/// (ln of float: -103 … 88, without loss of digits from -87).
inline bool single_holds(const density::Field& f, double tolerance) {
  if (!f.plain_above || tolerance < 4e-5 * std::max(1.0, f.steepest))
    return false;
  std::vector<double> largest(f.level[0].exponent.size(), 0.0);
  for (size_t c = 0; c < f.group.size(); ++c) {
    if (f.ln_peak[c] - f.decay * f.cutoff2[c] < -95 || f.decay * f.cutoff2[c] > 87)
      return false;
    largest[f.group[c]] += std::exp(std::min(f.ln_peak[c], 80.0));
  }
  for (size_t g = 0; g < largest.size(); ++g)
    if (std::max(1.0, f.level[0].exponent[g]) * std::log(largest[g]) > 80)
      return false;
  return true;
}

template <class Backend>
class DeviceField {
  template <class T>
  using Array = typename Backend::template Array<T>;

public:
  DeviceField(Backend& b, const density::Field& f) {
    const auto up = [&](auto& store, const auto& v) {
      store = b.upload(v.data(), static_cast<int64_t>(v.size()));
      return store.data();
    };
    FieldView& d = view;
    d.decay = f.decay;
    d.steepest = f.steepest;
    d.levels = f.plain_above ? 1 : static_cast<int>(f.level.size());
    if (d.levels > FieldView::most_levels)
      fail(Status::failed,
           "mode cuda: found " + std::to_string(d.levels) + " levels of groups, expected at most " +
               std::to_string(FieldView::most_levels) + "; use seq or omp",
           {"mode"});
    d.x = up(x_, f.x), d.y = up(y_, f.y), d.z = up(z_, f.z), d.peak = up(peak_, f.peak);
    d.begin = up(begin_, f.begin), d.group = up(group_, f.group), d.box = up(box_, f.box);
    d.ln_peak = up(ln_peak_, f.ln_peak), d.cutoff2 = up(cutoff2_, f.cutoff2);
    for (int l = 0; l < d.levels; ++l) {
      d.exponent[l] = up(exponent_[l], f.level[l].exponent);
      d.parent[l] = up(parent_[l], f.level[l].parent);
    }
    const std::vector<BvhNode> tree = bvh(f);
    d.node = up(node_, tree);
    d.nodes = static_cast<int32_t>(tree.size());
  }
  FieldView view{};

private:
  Array<double> x_, y_, z_, peak_, ln_peak_, cutoff2_, exponent_[FieldView::most_levels];
  Array<int64_t> begin_, group_, parent_[FieldView::most_levels];
  Array<Box> box_;
  Array<BvhNode> node_;
};

} // namespace molmesh::cuda
