// units_kernel.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/units_kernel.hpp"
#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/units_kernel.cpp"
#include <hwy/foreach_target.h>

#include "density/simd_math-inl.hpp"

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

/// The atom of each unit with the largest term in the middle: of T its term is 1 everywhere (field.md §4).
void find_centers(const LocalClusters& node, const NearUnits& from, const int32_t* list, int32_t n,
                  const TermsAt& middle, BlockUnits& to) {
  float* log2_atom = to.log2_atom.data();
  for (int32_t u = 0; u < n; ++u) {
    const auto s = static_cast<size_t>(u), at = static_cast<size_t>(list[u]);
    const int32_t begin = from.begin[at], clusters = from.begin[at + 1] - begin;
    const int32_t* const cluster = from.cluster.data() + begin;
    V largest = hn::Set(f, -2e30f);
    auto where = hn::Zero(I());
    for_atoms(cluster, clusters, [&](size_t a) {
      const V term = middle(node, a);
      hn::StoreU(term, f, log2_atom);
      log2_atom += lanes;
      const auto more = hn::Gt(term, largest);
      largest = hn::IfThenElse(more, term, largest);
      where = hn::IfThenElse(hn::RebindMask(I(), more), hn::Set(I(), static_cast<int32_t>(a)), where);
    });
    const V log2_largest = hn::MaxOfLanes(f, largest);
    const size_t lane = hn::FindKnownFirstTrue(f, hn::Eq(largest, log2_largest));
    size_t first = lane;
    if (clusters > 1 || lanes < 16) {
      HWY_ALIGN int32_t at_lane[lanes];
      hn::Store(where, I(), at_lane);
      first += static_cast<size_t>(at_lane[lane]);
    } else {
      first += 16 * static_cast<size_t>(*cluster);
    }
    to.center_slot[s] = static_cast<int32_t>(first);
    to.exponent[s] = from.exponent[at];
    to.log2_term[s] = hn::GetLane(log2_largest);
    to.x[s] = node.atom_x[first];
    to.y[s] = node.atom_y[first];
    to.z[s] = node.atom_z[first];
  }
}

/// What take_units does with one threshold, log2 of the largest change by an atom that is dropped.
template <bool absolute, bool direct>
HWY_INLINE bool take(const LocalClusters& node, const NearUnits& from, const int32_t* list, int32_t n,
                     const LocalBox& b, float decay, const TermsAt& middle, const float* log2_upper,
                     float log2_least, BlockUnits& to) {
  const V sx = hn::Set(f, 2 * decay * b.half[0] / 3.5f), sy = hn::Set(f, 2 * decay * b.half[1] / 3.5f),
          sz = hn::Set(f, 2 * decay * b.half[2] / 3.5f), least = hn::Set(f, log2_least);
  V widest = hn::Zero(f), lost = widest;
  const float* log2_atom = to.log2_atom.data();
  size_t kept = 0;
  for (int32_t u = 0; u < n; ++u) {
    const auto s = static_cast<size_t>(u), at = static_cast<size_t>(list[u]);
    // field.md §4: what dropping an atom changes G by, or (not absolute) its unit's sum, relative;
    // log2 P ≤ (P - 1)/ln 2.
    const float p = to.exponent[s], term = to.log2_term[s], steep = 1.442696f * (p - 1);
    to.log2_factor[s] = direct && to.folded && p == 0.5f ? to.root[s] : term;
    const V constant = hn::Set(f, to.log2_factor[s]);
    const V change = hn::Set(f, !absolute ? 0
                                : p <= 1  ? p * term + steep
                                          : term + steep + (p - 1) * log2_upper[at]),
            share = hn::Set(f, !absolute ? 1
                               : p <= 1  ? 1 - p
                                         : 0),
            log2_largest = hn::Set(f, term), steepness = hn::Set(f, std::max(1.0f, p)); // T^P must hold, too
    const V cx = hn::Mul(hn::Sub(hn::Set(f, to.x[s]), middle.x), sx),
            cy = hn::Mul(hn::Sub(hn::Set(f, to.y[s]), middle.y), sy),
            cz = hn::Mul(hn::Sub(hn::Set(f, to.z[s]), middle.z), sz);
    const auto along = [&](V x, V y, V z) {
      return hn::Mul(hn::Set(f, 3.5f), hn::Add(hn::Abs(x), hn::Add(hn::Abs(y), hn::Abs(z))));
    };
    // The largest slope·t - bend·t² up to t = 3.5.
    const float bent = !absolute ? 0 : decay / 12.25f * std::min(1.0f, p);
    const auto most = [&](V slope, float half) {
      const float bend = bent * half * half;
      const V up = hn::Abs(slope),
              t = absolute ? hn::Min(hn::Mul(up, hn::Set(f, 0.5f / bend)), hn::Set(f, 3.5f)) : hn::Set(f, 3.5f);
      return hn::Mul(t, absolute ? hn::NegMulAdd(hn::Set(f, bend), t, up) : up);
    };
    for_atoms(from.cluster.data() + from.begin[at], from.begin[at + 1] - from.begin[at], [&](size_t a) {
      const V log2_term = hn::LoadU(f, log2_atom), weight = hn::Sub(log2_term, log2_largest);
      log2_atom += lanes;
      V x = hn::Mul(hn::Sub(hn::LoadU(f, &node.atom_x[a]), middle.x), sx),
        y = hn::Mul(hn::Sub(hn::LoadU(f, &node.atom_y[a]), middle.y), sy),
        z = hn::Mul(hn::Sub(hn::LoadU(f, &node.atom_z[a]), middle.z), sz);
      const V effect = hn::Add(
          hn::Add(hn::Add(weight, change), most(hn::NegMulAdd(share, cx, x), b.half[0])),
          hn::Add(most(hn::NegMulAdd(share, cy, y), b.half[1]), most(hn::NegMulAdd(share, cz, z), b.half[2])));
      // Unused slots have a peak of -1e30: never kept. The unit's center stays.
      const auto keep =
          hn::Or(hn::And(hn::Ge(effect, least), hn::Gt(weight, hn::Set(f, -1e29f))), hn::Ge(weight, hn::Zero(f)));
      if (absolute)
        lost = hn::Add(lost, hn::IfThenZeroElse(keep, exp2_above(hn::Min(effect, hn::Set(f, 100.0f)))));
      if (!direct) {
        hn::StoreU(hn::Compress(hn::Iota(I(), static_cast<int32_t>(a)), hn::RebindMask(I(), keep)), I(),
                   &to.atom_slot[kept]);
        x = hn::Sub(x, cx);
        y = hn::Sub(y, cy);
        z = hn::Sub(z, cz);
      }
      const V swing = direct ? hn::Add(along(x, y, z), weight) : hn::Mul(along(x, y, z), steepness);
      widest = hn::Max(widest, hn::IfThenElseZero(keep, swing));
      hn::StoreU(hn::Compress(x, keep), f, &to.atom_x[kept]);
      hn::StoreU(hn::Compress(y, keep), f, &to.atom_y[kept]);
      hn::StoreU(hn::Compress(z, keep), f, &to.atom_z[kept]);
      hn::StoreU(hn::Compress(hn::Sub(log2_term, constant), keep), f, &to.atom_constant[kept]);
      kept += hn::CountTrue(f, keep);
    });
    to.begin[s + 1] = static_cast<int32_t>(kept);
  }
  to.n = n;
  to.dropped = absolute ? 1.001f * hn::GetLane(hn::SumOfLanes(f, lost)) : 0;
  for (Floats* v : {&to.exponent, &to.log2_term, &to.x, &to.y, &to.z})
    std::fill_n(v->begin() + n, 16, 0.0f);
  const V twice = hn::Set(f, 2 * decay);
  const float bend = decay * (b.half[0] * b.half[0] + b.half[1] * b.half[1] + b.half[2] * b.half[2]);
  for (int32_t u = 0; u < n; u += lanes) {
    V away = hn::Zero(f);
    int axis = 0;
    for (const Floats* v : {&to.x, &to.y, &to.z}) {
      const V center = hn::LoadU(f, v->data() + u);
      away = hn::MulAdd(hn::Set(f, b.half[axis]), hn::Abs(hn::Sub(center, hn::Set(f, b.middle[axis]))), away);
      ++axis;
    }
    away = direct ? hn::MulAdd(away, twice, hn::Set(f, bend))
                  : hn::Mul(hn::Mul(away, twice), hn::LoadU(f, to.exponent.data() + u));
    const auto used = hn::Lt(hn::Iota(f, static_cast<float>(u)), hn::Set(f, static_cast<float>(n)));
    widest = hn::Max(widest, hn::IfThenElseZero(used, away));
  }
  return hn::GetLane(hn::MaxOfLanes(f, widest)) <= log2_range;
}

void choose_roots_simd(const float* effect, const int32_t* list, int32_t n, float most, float* root) {
  for (int32_t u = 0; u < n; u += lanes) {
    const auto used = hn::FirstN(I(), static_cast<size_t>(n - u));
    const V e = hn::GatherIndex(f, effect, hn::IfThenElseZero(used, hn::LoadU(I(), list + u)));
    hn::StoreU(hn::IfThenZeroElse(hn::Le(e, hn::Set(f, most)), hn::Set(f, 2.0f)), f, root + u);
  }
}

bool take_units_simd(const LocalClusters& node, const NearUnits& from, const int32_t* list, int32_t n,
                     const LocalBox& block, float decay, const float* log2_upper, float within, BlockUnits& to) {
  int32_t slots = 1;
  for (int32_t u = 0; u < n; ++u)
    slots =
        std::max(slots, from.begin[static_cast<size_t>(list[u]) + 1] - from.begin[static_cast<size_t>(list[u])]);
  const TermsAt middle{hn::Set(f, block.middle[0]), hn::Set(f, block.middle[1]), hn::Set(f, block.middle[2]),
                       hn::Set(f, decay)};
  find_centers(node, from, list, n, middle, to);
  const float log2_within = within > 0 ? hn::GetLane(log2(hn::Set(f, within))) : -1e30f;
  const auto safe = [&](int32_t atoms) {
    return log2_within - hn::GetLane(log2(hn::Set(f, static_cast<float>(atoms)))) - 1e-5f;
  };
  if (!log2_upper) { // relative to each unit
    const auto relative = to.direct ? take<false, true> : take<false, false>;
    return relative(node, from, list, n, block, decay, middle, nullptr, safe(16 * slots), to);
  }
  // A threshold that mostly does; what it drops is summed. The last one cannot fail.
  const auto absolute = to.direct ? take<true, true> : take<true, false>;
  const float last = safe(16 * std::max(1, slots * n));
  for (float least = std::max(last, log2_within - 2.5f);; least = std::max(last, least - 1.5f)) {
    const bool holds = absolute(node, from, list, n, block, decay, middle, log2_upper, least, to);
    if (to.dropped <= within || least <= last)
      return holds;
  }
}

void unit_middles_simd(const BlockUnits& u, const LocalBox& b, float decay, UnitMiddles& to) {
  for (int32_t n = 0; n < u.n; ++n) {
    const auto s = static_cast<size_t>(n);
    V w = hn::Zero(f), wx = w, wy = w, wz = w;
    for (int32_t a = u.begin[s]; a < u.begin[s + 1]; a += lanes) {
      const auto used = hn::Lt(hn::Iota(f, static_cast<float>(a - u.begin[s])),
                               hn::Set(f, static_cast<float>(u.begin[s + 1] - u.begin[s])));
      const V e = hn::IfThenElseZero(used, exp2(hn::LoadU(f, u.atom_constant.data() + a)));
      w = hn::Add(w, e);
      wx = hn::Add(hn::IfThenElseZero(used, hn::Mul(e, hn::LoadU(f, u.atom_x.data() + a))), wx);
      wy = hn::Add(hn::IfThenElseZero(used, hn::Mul(e, hn::LoadU(f, u.atom_y.data() + a))), wy);
      wz = hn::Add(hn::IfThenElseZero(used, hn::Mul(e, hn::LoadU(f, u.atom_z.data() + a))), wz);
    }
    const float total = hn::GetLane(hn::SumOfLanes(f, w)), per = 3.5f / (2 * decay * total);
    to.log2_sum[s] = total;
    to.x[s] = (u.direct ? b.middle[0] : u.x[s]) + per / b.half[0] * hn::GetLane(hn::SumOfLanes(f, wx));
    to.y[s] = (u.direct ? b.middle[1] : u.y[s]) + per / b.half[1] * hn::GetLane(hn::SumOfLanes(f, wy));
    to.z[s] = (u.direct ? b.middle[2] : u.z[s]) + per / b.half[2] * hn::GetLane(hn::SumOfLanes(f, wz));
  }
  std::fill_n(to.log2_sum.begin() + u.n, 16, 1.0f);
  for (int32_t n = 0; n < u.n; n += lanes)
    hn::StoreU(hn::Add(log2(hn::LoadU(f, to.log2_sum.data() + n)), hn::LoadU(f, u.log2_factor.data() + n)), f,
               to.log2_sum.data() + n);
}

void sum_of_powers_simd(int32_t n, const float* exponent, const float* log2_sum, const float* x, const float* y,
                        const float* z, const LocalBox& b, float decay, float* value, float* gradient) {
  V sum = hn::Zero(f), gx = sum, gy = sum, gz = sum;
  for (int32_t u = 0; u < n; u += lanes) {
    const V p = hn::LoadU(f, exponent + u);
    const auto used = hn::Lt(hn::Iota(f, static_cast<float>(u)), hn::Set(f, static_cast<float>(n)));
    const V e = hn::IfThenElseZero(used, exp2(hn::Min(hn::Mul(p, hn::LoadU(f, log2_sum + u)), hn::Set(f, 100.0f)))),
            ep = hn::Mul(e, p);
    sum = hn::Add(sum, e);
    gx = hn::MulAdd(ep, hn::Sub(hn::LoadU(f, x + u), hn::Set(f, b.middle[0])), gx);
    gy = hn::MulAdd(ep, hn::Sub(hn::LoadU(f, y + u), hn::Set(f, b.middle[1])), gy);
    gz = hn::MulAdd(ep, hn::Sub(hn::LoadU(f, z + u), hn::Set(f, b.middle[2])), gz);
  }
  *value = hn::GetLane(hn::SumOfLanes(f, sum));
  gradient[0] = 2 * decay * hn::GetLane(hn::SumOfLanes(f, gx));
  gradient[1] = 2 * decay * hn::GetLane(hn::SumOfLanes(f, gy));
  gradient[2] = 2 * decay * hn::GetLane(hn::SumOfLanes(f, gz));
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::density {

HWY_EXPORT(choose_roots_simd);
HWY_EXPORT(take_units_simd);
HWY_EXPORT(unit_middles_simd);
HWY_EXPORT(sum_of_powers_simd);

void choose_roots(const float* effect, const int32_t* list, int32_t n, float most, float* root) {
  HWY_DYNAMIC_DISPATCH(choose_roots_simd)(effect, list, n, most, root);
}
bool take_units(const LocalClusters& node, const NearUnits& from, const int32_t* list, int32_t n,
                const LocalBox& block, float decay, const float* log2_upper, float within, BlockUnits& to) {
  return HWY_DYNAMIC_DISPATCH(take_units_simd)(node, from, list, n, block, decay, log2_upper, within, to);
}
void unit_middles(const BlockUnits& units, const LocalBox& block, float decay, UnitMiddles& to) {
  HWY_DYNAMIC_DISPATCH(unit_middles_simd)(units, block, decay, to);
}
void sum_of_powers(int32_t n, const float* exponent, const float* log2_sum, const float* x, const float* y,
                   const float* z, const LocalBox& block, float decay, float* value, float* gradient) {
  HWY_DYNAMIC_DISPATCH(sum_of_powers_simd)(n, exponent, log2_sum, x, y, z, block, decay, value, gradient);
}

} // namespace molmesh::density
#endif
