// block_bounds.hpp — tells which side of the band a block is on, by upper and lower bounds on G over its points
// (docs/theory/field.md §5).
#pragma once
#include "cuda/density/log_sum.hpp"
#include "cuda/density/near_clusters.hpp"
#include "cuda/par/backend.hpp"

namespace molmesh::cuda {

/// What is known of a block before its points are.
enum class State : uint8_t { outside, inside, open };

/// Squared distance of a point to the interval of an axis' points, Å².
MOLMESH_HD inline double beyond2(double c, double middle, double half) {
  const double d = (c > middle ? c - middle : middle - c) - half;
  return d > 0 ? d * d : 0;
}

/// state[i] of block key[i]. One call reads the atoms near a block once.
template <class Real>
struct BoundBlocks {
  NearClusters near;
  double lower, upper; ///< of the band
  double total;        ///< of the budget for what is dropped
  bool classify;       ///< false: every block stays open
  const Key* key;
  State* state;

  MOLMESH_HD void operator()(int64_t i) const {
    if (!classify) {
      state[i] = State::open;
      return;
    }
    const FieldView& f = near.f;
    const Vec3i block = BlockFrame::block(key[i]);
    const Box box = near.frame.box(block, 1);
    const Vec3d m = 0.5 * (box.lo + box.hi), half = 0.5 * (box.hi - box.lo);
    OpenLevels<LogSum<Real, false>> largest(f);
    OpenLevels<LogSum<Real, true>> middle(f);
    near.for_each(block, box, Solo{}, [&](int32_t c, bool is_near) {
      if (!is_near)
        return;
      LogSum<Real, false>& high = largest.enter(f.group[c]);
      LogSum<Real, true>& here = middle.enter(f.group[c]);
      for (int64_t a = f.begin[c]; a < f.begin[c + 1]; ++a) {
        const Vec3d to{f.x[a] - m.x, f.y[a] - m.y, f.z[a] - m.z};
        const double d2 =
            beyond2(f.x[a], m.x, half.x) + beyond2(f.y[a], m.y, half.y) + beyond2(f.z[a], m.z, half.z);
        high.add(f.peak[a] - f.decay * d2);
        // ∇ of the term's logarithm is 2κ(c - x).
        here.add(f.peak[a] - f.decay * norm2(to),
                 Vec3<Real>{Real(2 * f.decay * to.x), Real(2 * f.decay * to.y), Real(2 * f.decay * to.z)});
      }
    });
    constexpr double rounding = 1e-3; // more than single precision can do
    const double slack = rounding * (f.steepest > 1 ? f.steepest : 1);
    if ((1 + slack) * std::exp(largest.finish().ln()) + 2 * total < lower) {
      state[i] = State::outside;
      return;
    }
    const LogSum<Real, true>& root = middle.finish();
    const Vec3<Real> g = root.mean();
    const double least =
        root.ln() -
        (std::abs(double(g.x)) * half.x + std::abs(double(g.y)) * half.y + std::abs(double(g.z)) * half.z) -
        f.decay * f.steepest * norm2(half);
    state[i] = std::exp(least) * (1 - 4 * total - slack) > upper + 4 * total ? State::inside : State::open;
  }
};

} // namespace molmesh::cuda
