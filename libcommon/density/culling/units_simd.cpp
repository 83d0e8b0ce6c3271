// units_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/culling/units_simd.hpp"
#include "base/dispatch.hpp"
#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/culling/units_simd.cpp"
#include <hwy/foreach_target.h>

#include "density/values/simd_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

/// log2 of the terms of atoms, from the a-th, at a point.
struct TermsAt {
  V x, y, z, k;
  HWY_INLINE V operator()(const LocalClusters& u, size_t a) const {
    const V dx = hn::Sub(hn::LoadU(f, &u.atom_x[a]), x), dy = hn::Sub(hn::LoadU(f, &u.atom_y[a]), y),
            dz = hn::Sub(hn::LoadU(f, &u.atom_z[a]), z);
    return hn::NegMulAdd(hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))), k, hn::LoadU(f, &u.atom_peak[a]));
  }
};

/// The atom of each unit with the largest term in the middle: of T its term is 1 everywhere (field.md §4). Returns
/// the most clusters that a unit has.
int32_t find_centers(const LocalClusters& brick, const NearUnits& from, const int32_t* list, int32_t n,
                     const TermsAt& middle, BlockUnits& to) {
  // The compiler cannot know that what is stored is none of these.
  float *log2_atom = to.log2_atom.data(), *const exponent = to.exponent.data(),
        *const log2_term = to.log2_term.data(), *const x = to.x.data(), *const y = to.y.data(),
        *const z = to.z.data();
  const float *const atom_x = brick.atom_x.data(), *const atom_y = brick.atom_y.data(),
                     *const atom_z = brick.atom_z.data();
  int32_t* const slot = to.center_slot.data();
  const int32_t *const begin = from.begin.data(), *const cluster = from.cluster.data();
  int32_t most = 1;
  for (int32_t u = 0; u < n; ++u) {
    const int32_t at = list[u], clusters = begin[at + 1] - begin[at];
    most = std::max(most, clusters);
    V largest = hn::Set(f, -2e30f);
    auto where = hn::Zero(I());
    for_atoms(cluster + begin[at], clusters, [&](size_t a) {
      const V term = middle(brick, a);
      hn::StoreU(term, f, log2_atom);
      log2_atom += lanes;
      const auto more = hn::Gt(term, largest);
      largest = hn::IfThenElse(more, term, largest);
      where = hn::IfThenElse(hn::RebindMask(I(), more), hn::Set(I(), static_cast<int32_t>(a)), where);
    });
    const V log2_largest = hn::MaxOfLanes(f, largest);
    const size_t lane = hn::FindKnownFirstTrue(f, hn::Eq(largest, log2_largest));
    HWY_ALIGN int32_t at_lane[lanes];
    hn::Store(where, I(), at_lane);
    const size_t first = lane + static_cast<size_t>(at_lane[lane]);
    slot[u] = static_cast<int32_t>(first);
    exponent[u] = from.exponent[at];
    log2_term[u] = hn::GetLane(log2_largest);
    x[u] = atom_x[first];
    y[u] = atom_y[first];
    z[u] = atom_z[first];
  }
  return most;
}

/// The largest slope·t - bend·t² up to t = 3.5; without the bend when not absolute.
template <bool absolute>
struct Curve {
  explicit Curve(float bend = 1) : bend_(hn::Set(f, bend)), peak_(hn::Set(f, 0.5f / bend)) {}
  HWY_INLINE V highest(V slope) const {
    const V up = hn::Abs(slope), last = hn::Set(f, 3.5f);
    if constexpr (!absolute)
      return hn::Mul(last, up);
    const V t = hn::Min(hn::Mul(up, peak_), last);
    return hn::Mul(t, hn::NegMulAdd(bend_, t, up));
  }

private:
  V bend_, peak_;
};

/// What take_units does with one threshold, log2 of the largest change by an atom that is dropped.
template <bool absolute, bool direct>
HWY_INLINE bool take(const LocalClusters& brick, const NearUnits& from, const int32_t* list, int32_t n,
                     const LocalBox& b, float decay, const TermsAt& middle, const float* log2_upper,
                     float log2_least, BlockUnits& to) {
  const V sx = hn::Set(f, 2 * decay * b.half[0] / 3.5f), sy = hn::Set(f, 2 * decay * b.half[1] / 3.5f),
          sz = hn::Set(f, 2 * decay * b.half[2] / 3.5f), least = hn::Set(f, log2_least);
  V widest = hn::Zero(f), lost = widest;
  // The compiler cannot know that what is stored is none of these.
  const float *log2_atom = to.log2_atom.data(), *const atom_x = brick.atom_x.data(),
              *const atom_y = brick.atom_y.data(), *const atom_z = brick.atom_z.data();
  float *x_to = to.atom_x.data(), *y_to = to.atom_y.data(), *z_to = to.atom_z.data(),
        *constant_to = to.atom_constant.data();
  const int32_t *const begin = from.begin.data(), *const cluster = from.cluster.data();
  const V mx = middle.x, my = middle.y, mz = middle.z;
  Curve<absolute> curve[3];
  float bent_with = 0;
  size_t kept = 0;
  bool roots = direct && to.folded && n > 1;
  for (int32_t u = 0; u < n; ++u) {
    const auto s = static_cast<size_t>(u), at = static_cast<size_t>(list[u]);
    // field.md §4: what dropping an atom changes G by, or (not absolute) its unit's sum, relative;
    // log2 P ≤ (P - 1)/ln 2.
    const float p = to.exponent[s], term = to.log2_term[s], steep = 1.442696f * (p - 1);
    const bool root = direct && to.folded && p == 0.5f;
    roots = roots && root;
    to.log2_factor[s] = root ? to.root[s] : term;
    const V constant = hn::Set(f, to.log2_factor[s]);
    const V change = hn::Set(f, !absolute ? 0
                                : p <= 1  ? p * term + steep
                                          : term + steep + (p - 1) * log2_upper[at]),
            share = hn::Set(f, !absolute ? 1
                               : p <= 1  ? 1 - p
                                         : 0),
            log2_largest = hn::Set(f, term), steepness = hn::Set(f, std::max(1.0f, p)); // T^P must hold, too
    const V cx = hn::Mul(hn::Sub(hn::Set(f, to.x[s]), mx), sx), cy = hn::Mul(hn::Sub(hn::Set(f, to.y[s]), my), sy),
            cz = hn::Mul(hn::Sub(hn::Set(f, to.z[s]), mz), sz);
    // A folded root may become as small as it likes.
    const V lift = hn::Set(f, root ? std::max(0.0f, 0.5f * term) : 0),
            weighed = hn::Set(f, direct && !root ? 1 : 0);
    const auto along = [&](V x, V y, V z) {
      return hn::MulAdd(hn::Set(f, 3.5f), hn::Add(hn::Abs(x), hn::Add(hn::Abs(y), hn::Abs(z))), lift);
    };
    if (const float with = std::min(1.0f, p); absolute && with != bent_with) {
      bent_with = with;
      for (int axis = 0; axis < 3; ++axis)
        curve[axis] = Curve<absolute>(decay / 12.25f * with * b.half[axis] * b.half[axis]);
    }
    for_atoms(cluster + begin[at], begin[at + 1] - begin[at], [&](size_t a) {
      const V log2_term = hn::LoadU(f, log2_atom), weight = hn::Sub(log2_term, log2_largest);
      log2_atom += lanes;
      const V x = hn::Mul(hn::Sub(hn::LoadU(f, atom_x + a), mx), sx),
              y = hn::Mul(hn::Sub(hn::LoadU(f, atom_y + a), my), sy),
              z = hn::Mul(hn::Sub(hn::LoadU(f, atom_z + a), mz), sz);
      const V effect = hn::Add(
          hn::Add(hn::Add(weight, change), curve[0].highest(hn::NegMulAdd(share, cx, x))),
          hn::Add(curve[1].highest(hn::NegMulAdd(share, cy, y)), curve[2].highest(hn::NegMulAdd(share, cz, z))));
      // Unused slots have a peak of -1e30: never kept. The unit's center stays.
      const auto keep =
          hn::Or(hn::And(hn::Ge(effect, least), hn::Gt(weight, hn::Set(f, -1e29f))), hn::Ge(weight, hn::Zero(f)));
      if (absolute)
        lost = hn::Add(lost, hn::IfThenZeroElse(keep, exp2_above(hn::Min(effect, hn::Set(f, 100.0f)))));
      const V swing = hn::Mul(direct ? hn::MulAdd(weight, weighed, along(x, y, z))
                                     : along(hn::Sub(x, cx), hn::Sub(y, cy), hn::Sub(z, cz)),
                              steepness);
      widest = hn::Max(widest, hn::IfThenElseZero(keep, swing));
      // The places of what is kept, once: to compress each by itself takes four times as long.
      const auto which = hn::Compress(hn::Iota(I(), 0), hn::RebindMask(I(), keep));
      const auto indices = hn::IndicesFromVec(f, which);
      const auto put = [&](V v, float* all) { hn::StoreU(hn::TableLookupLanes(v, indices), f, all + kept); };
      put(direct ? x : hn::Sub(x, cx), x_to);
      put(direct ? y : hn::Sub(y, cy), y_to);
      put(direct ? z : hn::Sub(z, cz), z_to);
      put(hn::Sub(log2_term, constant), constant_to);
      if (!direct)
        hn::StoreU(hn::Add(which, hn::Set(I(), static_cast<int32_t>(a))), I(), &to.atom_slot[kept]);
      kept += hn::CountTrue(f, keep);
    });
    to.begin[s + 1] = static_cast<int32_t>(kept);
  }
  to.n = n;
  to.roots = roots;
  to.dropped = absolute ? 1.001f * hn::GetLane(hn::SumOfLanes(f, lost)) : 0;
  for (AlignedFloats* v : {&to.exponent, &to.log2_term, &to.x, &to.y, &to.z})
    std::fill_n(v->begin() + n, 16, 0.0f);
  const V twice = hn::Set(f, 2 * decay);
  const float bend = decay * (b.half[0] * b.half[0] + b.half[1] * b.half[1] + b.half[2] * b.half[2]);
  for (int32_t u = 0; u < n; u += lanes) {
    V away = hn::Zero(f);
    int axis = 0;
    for (const AlignedFloats* v : {&to.x, &to.y, &to.z}) {
      const V center = hn::LoadU(f, v->data() + u);
      away = hn::MulAdd(hn::Set(f, b.half[axis]), hn::Abs(hn::Sub(center, hn::Set(f, b.middle[axis]))), away);
      ++axis;
    }
    away = direct ? hn::MulAdd(away, twice, hn::Set(f, bend))
                  : hn::Mul(hn::Mul(away, twice), hn::LoadU(f, to.exponent.data() + u));
    auto used = hn::Lt(hn::Iota(f, static_cast<float>(u)), hn::Set(f, static_cast<float>(n)));
    if (direct && to.folded)
      used = hn::And(used, hn::Ne(hn::LoadU(f, to.exponent.data() + u), hn::Set(f, 0.5f)));
    widest = hn::Max(widest, hn::IfThenElseZero(used, away));
  }
  return hn::GetLane(hn::MaxOfLanes(f, widest)) <= log2_range;
}

bool take_units_simd(const LocalClusters& brick, const NearUnits& from, const int32_t* list, int32_t n,
                     const LocalBox& block, float decay, const float* log2_upper, float within, BlockUnits& to) {
  const TermsAt middle{hn::Set(f, block.middle[0]), hn::Set(f, block.middle[1]), hn::Set(f, block.middle[2]),
                       hn::Set(f, decay)};
  const int32_t clusters = find_centers(brick, from, list, n, middle, to);
  const float log2_within = within > 0 ? hn::GetLane(log2(hn::Set(f, within))) : -1e30f;
  const auto safe = [&](float atoms) { return log2_within - hn::GetLane(log2(hn::Set(f, atoms))) - 1e-5f; };
  if (!log2_upper) { // relative to each unit
    const auto relative = to.direct ? take<false, true> : take<false, false>;
    return relative(brick, from, list, n, block, decay, middle, nullptr, safe(16.f * float(clusters)), to);
  }
  // A threshold that mostly does; what it drops is summed. The last one cannot fail.
  const auto absolute = to.direct ? take<true, true> : take<true, false>;
  float least = log2_within - 2.5f;
  bool holds = absolute(brick, from, list, n, block, decay, middle, log2_upper, least, to);
  if (to.dropped > within)
    for (const float last = safe(16.f * std::max(1.f, float(clusters) * float(n)));
         to.dropped > within && least > last;) {
      least = std::max(last, least - 1.5f);
      holds = absolute(brick, from, list, n, block, decay, middle, log2_upper, least, to);
    }
  return holds;
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::density {

HWY_EXPORT(take_units_simd);

bool take_units(const LocalClusters& brick, const NearUnits& from, const int32_t* list, int32_t n,
                const LocalBox& block, float decay, const float* log2_upper, float within, BlockUnits& to) {
  return MOLMESH_DISPATCH(take_units_simd)(brick, from, list, n, block, decay, log2_upper, within, to);
}

} // namespace molmesh::density
#endif
