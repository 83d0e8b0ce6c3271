// log_sums_simd.cpp — compiled once per instruction set by Highway's foreach_target.
#include "density/values/log_sums_simd.hpp"
#include "base/dispatch.hpp"
#include <algorithm>
#include <bit>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "density/values/log_sums_simd.cpp"
#include <hwy/foreach_target.h>

#include "density/values/powers-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace molmesh::density {
namespace HWY_NAMESPACE {
namespace {

using D = Tag<double>;
using VD = hn::Vec<D>;
constexpr D d{};
constexpr int32_t wide = HWY_MIN(8, lanes_of<double>);
constexpr double half_diagonal = 0.8660254037844386; // steps, of a cube of 2³ points

/// to += 2^term at the points from i on.
HWY_INLINE void add_log(VD term, LogSums& to, int32_t i) {
  const VD before = hn::Load(d, to.largest + i), parts = hn::Load(d, to.parts + i), more = hn::Max(before, term),
           part = exp2(d, hn::Sub(hn::Min(before, term), more)), one = hn::Set(d, 1.0);
  hn::Store(more, d, to.largest + i);
  hn::Store(hn::IfThenElse(hn::Gt(term, before), hn::MulAdd(parts, part, one), hn::Add(parts, part)), d,
            to.parts + i);
}

HWY_INLINE VD logs(const LogSums& from, int32_t i) {
  return hn::Add(hn::Load(d, from.largest + i), log2(d, hn::Load(d, from.parts + i)));
}

/// Steps to n³ points, `apart` from each other, from their middle.
template <int n>
struct Lattice {
  alignas(64) double x[n * n * n], y[n * n * n], z[n * n * n];
  constexpr explicit Lattice(int apart) : x(), y(), z() {
    for (int i = 0; i < n * n * n; ++i) {
      const auto along = [&](int k) { return apart * (k - 0.5 * (n - 1)); };
      x[i] = along(i / (n * n)), y[i] = along(i / n % n), z[i] = along(i % n);
    }
  }
};
constexpr Lattice<4> cubes(2);  // their middles, of a block
constexpr Lattice<2> points(1); // of a cube
/// Those from the v-th on.
struct InCube {
  VD x, y, z;
  HWY_INLINE explicit InCube(int32_t v)
      : x(hn::Load(d, points.x + v)), y(hn::Load(d, points.y + v)), z(hn::Load(d, points.z + v)) {}
};
HWY_INLINE VD dot(VD ax, VD ay, VD az, VD bx, VD by, VD bz) {
  return hn::MulAdd(ax, bx, hn::MulAdd(ay, by, hn::Mul(az, bz)));
}

/// What log2 of an atom's term has beyond that at a cube's middle, at most.
double spread_of(const ExactUnits& units, size_t a) {
  return 0.5 * (std::abs(units.atom_x[a]) + std::abs(units.atom_y[a]) + std::abs(units.atom_z[a]));
}

/// What the logarithms of atoms' terms have beyond those at a cube's middle, at its points [8 n], and at most [n].
void spread_atoms(const ExactUnits& units, size_t begin, size_t n, LogScratch& w) {
  w.change.resize(std::max(w.change.size(), 8 * n));
  for (AlignedVector<double>* v : {&w.spread, &w.middle})
    v->resize(std::max(v->size(), n + 16));
  w.shown.resize(std::max(w.shown.size(), n + 16));
  for (int32_t v = 0; v < 8; v += wide) {
    const InCube in_cube(v);
    for (size_t a = 0; a < n; ++a)
      hn::Store(dot(hn::Set(d, units.atom_x[begin + a]), hn::Set(d, units.atom_y[begin + a]),
                    hn::Set(d, units.atom_z[begin + a]), in_cube.x, in_cube.y, in_cube.z),
                d, &w.change[8 * a + static_cast<size_t>(v)]);
  }
  for (size_t a = 0; a < n; ++a)
    w.spread[a] = spread_of(units, begin + a);
}

/// Those of a unit's n atoms whose terms show in a cube: w.shown. Returns how many.
size_t shown_atoms(const ExactUnits& units, size_t begin, size_t n, int32_t at, double least_part, LogScratch& w) {
  const VD x = hn::Set(d, cubes.x[at]), y = hn::Set(d, cubes.y[at]), z = hn::Set(d, cubes.z[at]);
  VD least = hn::Set(d, -1e290); // of the largest term in the cube
  for (size_t a = 0; a < n; a += wide) {
    const VD middle = hn::Add(hn::LoadU(d, &units.atom_constant[begin + a]),
                              dot(hn::LoadU(d, &units.atom_x[begin + a]), hn::LoadU(d, &units.atom_y[begin + a]),
                                  hn::LoadU(d, &units.atom_z[begin + a]), x, y, z));
    hn::Store(middle, d, &w.middle[a]);
    const auto own = hn::Lt(hn::Iota(d, static_cast<double>(a)), hn::Set(d, static_cast<double>(n)));
    least = hn::IfThenElse(own, hn::Max(least, hn::Sub(middle, hn::Load(d, &w.spread[a]))), least);
  }
  const double limit = hn::GetLane(hn::MaxOfLanes(d, least)) + least_part;
  size_t shown = 0;
  for (size_t a = 0; a < n; ++a) {
    w.shown[shown] = static_cast<int32_t>(a);
    shown += w.middle[a] + w.spread[a] >= limit;
  }
  return shown;
}

/// T of unit u at the points of cube `at`.
void sum_atoms(const ExactUnits& units, size_t begin, size_t n, int32_t at, double least_part, LogScratch& w) {
  const size_t shown = shown_atoms(units, begin, n, at, least_part, w);
  for (int32_t v = 0; v < 8; v += wide) {
    const auto term = [&](size_t i) {
      const auto a = static_cast<size_t>(w.shown[i]);
      return hn::Add(hn::Set(d, w.middle[a]), hn::Load(d, &w.change[8 * a + static_cast<size_t>(v)]));
    };
    VD largest = term(0), parts = hn::Zero(d);
    for (size_t i = 1; i < shown; ++i)
      largest = hn::Max(largest, term(i));
    for (size_t i = 0; i < shown; ++i)
      parts = hn::Add(parts, exp2(d, hn::Sub(term(i), largest)));
    hn::Store(largest, d, w.t.largest + 8 * at + v);
    hn::Store(parts, d, w.t.parts + 8 * at + v);
  }
}

/// A unit as a ball about its atom c: log2 S in a cube is at least c's own term at the farthest corner, and at most
/// all atoms' with the highest peak at the ball's nearest place. Lengths in steps of the grid.
struct UnitBall {
  double x, y, z, peak, highest, radius = 0, bend, p;
  UnitBall(const ExactUnits& units, const BlockShape<double>& shape, size_t u)
      : bend(-shape.curvature), p(units.exponent[u]) {
    const double a_step = shape.slope / (2 * bend); // per Å
    x = a_step * units.x[u], y = a_step * units.y[u], z = a_step * units.z[u];
    peak = highest = units.log2_term[u] + bend * (x * x + y * y + z * z);
    const auto begin = static_cast<size_t>(units.begin[u]), end = static_cast<size_t>(units.begin[u + 1]);
    for (size_t a = begin; a < end; ++a) {
      const double dx = units.atom_x[a] / (2 * bend), dy = units.atom_y[a] / (2 * bend),
                   dz = units.atom_z[a] / (2 * bend);
      radius = std::max(radius, dx * dx + dy * dy + dz * dz);
      highest = std::max(highest, units.log2_term[u] + units.atom_constant[a] +
                                      bend * ((x + dx) * (x + dx) + (y + dy) * (y + dy) + (z + dz) * (z + dz)));
    }
    radius = std::sqrt(radius);
    highest += std::log2(static_cast<double>(end - begin));
  }
  /// Of log2 S^P in the cubes from the n-th on: use(n, least, most).
  template <class Use>
  HWY_INLINE void bounds(Use&& use) const {
    for (int32_t n = 0; n < 64; n += wide) {
      const VD to_x = hn::Sub(hn::Load(d, cubes.x + n), hn::Set(d, x)),
               to_y = hn::Sub(hn::Load(d, cubes.y + n), hn::Set(d, y)),
               to_z = hn::Sub(hn::Load(d, cubes.z + n), hn::Set(d, z));
      const VD far = hn::Sqrt(dot(to_x, to_y, to_z, to_x, to_y, to_z)),
               corner = hn::Add(far, hn::Set(d, half_diagonal)),
               near = hn::Max(hn::Zero(d), hn::Sub(far, hn::Set(d, half_diagonal + radius)));
      const auto at_distance = [&](double top, VD r) {
        return hn::Mul(hn::Set(d, p), hn::NegMulAdd(hn::Set(d, bend), hn::Mul(r, r), hn::Set(d, top)));
      };
      use(n, at_distance(peak, corner), at_distance(highest, near));
    }
  }
};

/// Adds S^P of unit u in those cubes.
void add_unit(const ExactUnits& units, const BlockShape<double>& shape, size_t u, uint64_t where, double least_part,
              LogScratch& w, LogSums& to) {
  const auto begin = static_cast<size_t>(units.begin[u]), n = static_cast<size_t>(units.begin[u + 1]) - begin;
  spread_atoms(units, begin, n, w);
  for (uint64_t left = where; left; left &= left - 1)
    sum_atoms(units, begin, n, std::countr_zero(left), least_part, w);
  const VD p = hn::Set(d, units.exponent[u]), bend = hn::Set(d, shape.curvature),
           term = hn::Set(d, units.log2_term[u]), x = hn::Set(d, shape.slope * units.x[u]),
           y = hn::Set(d, shape.slope * units.y[u]), z = hn::Set(d, shape.slope * units.z[u]);
  for (int32_t v = 0; v < 8; v += wide) {
    const InCube in_cube(v);
    for (uint64_t left = where; left; left &= left - 1) {
      const int32_t at = std::countr_zero(left);
      const VD at_x = hn::Add(in_cube.x, hn::Set(d, cubes.x[at])),
               at_y = hn::Add(in_cube.y, hn::Set(d, cubes.y[at])),
               at_z = hn::Add(in_cube.z, hn::Set(d, cubes.z[at]));
      const VD factor = hn::Add(term, dot(at_x, at_y, at_z, hn::MulAdd(bend, at_x, x), hn::MulAdd(bend, at_y, y),
                                          hn::MulAdd(bend, at_z, z)));
      add_log(hn::Mul(p, hn::Add(factor, logs(w.t, 8 * at + v))), to, 8 * at + v);
    }
  }
}

/// A unit's factors along the axes, at the points of all cubes: log2 of what multiplies T^P is, beside its value at
/// a cube's middle and the points' distance from that, linear along each.
struct PowerFactors {
  HWY_ALIGN double x[4][8], yz[16][8];
  PowerFactors(const ExactUnits& units, const BlockShape<double>& shape, size_t u) {
    HWY_ALIGN double y[4][8], z[4][8];
    for (int32_t i = 0; i < 4; ++i)
      for (int32_t v = 0; v < 8; v += wide) {
        const InCube in_cube(v);
        const auto factor = [&](double at, VD point) {
          return exp2(d, hn::Mul(hn::Set(d, units.exponent[u] * slope(shape, at, 2 * i - 3)), point));
        };
        hn::Store(factor(units.x[u], in_cube.x), d, x[i] + v);
        hn::Store(factor(units.y[u], in_cube.y), d, y[i] + v);
        hn::Store(factor(units.z[u], in_cube.z), d, z[i] + v);
      }
    for (int32_t n = 0; n < 16; ++n)
      for (int32_t v = 0; v < 8; v += wide)
        hn::Store(hn::Mul(hn::Load(d, y[n >> 2] + v), hn::Load(d, z[n & 3] + v)), d, yz[n] + v);
  }
  static double slope(const BlockShape<double>& shape, double at, double middle) {
    return shape.slope * at + 2 * shape.curvature * middle;
  }
  /// Of log2 of what multiplies S, from a cube's middle to its points.
  static double most_change(const ExactUnits& units, const BlockShape<double>& shape, size_t u) {
    double sum = 0;
    for (const double at : {units.x[u], units.y[u], units.z[u]})
      sum += 0.5 * std::max(std::abs(slope(shape, at, 3)), std::abs(slope(shape, at, -3)));
    return sum;
  }
};

/// Whether doubles hold the products below.
bool is_product(const ExactUnits& units, const BlockShape<double>& shape, size_t u, double above_floor) {
  double change = 0; // of an atom's term, from the block's middle to its corner
  for (auto a = static_cast<size_t>(units.begin[u]); a < static_cast<size_t>(units.begin[u + 1]); ++a)
    change = std::max(change, 7 * spread_of(units, a));
  const double p = units.exponent[u];
  return std::max(1.0, p) * change < 900 && above_floor < 500 &&
         p * PowerFactors::most_change(units, shape, u) < 200;
}

/// w.change [8 n]: of each atom's term at a cube's points beside its middle, which is the same in every cube.
/// w.middle [64 n]: the term in the cubes' middles. Too small for a double counts as 0: the unit's own atom has 1.
void find_products(const ExactUnits& units, size_t begin, size_t n, LogScratch& w) {
  w.change.resize(std::max(w.change.size(), 8 * n));
  w.middle.resize(std::max(w.middle.size(), 64 * n));
  HWY_ALIGN double yz[16];
  for (size_t a = 0; a < n; ++a) {
    const VD x = hn::Set(d, units.atom_x[begin + a]), y = hn::Set(d, units.atom_y[begin + a]),
             z = hn::Set(d, units.atom_z[begin + a]), constant = hn::Set(d, units.atom_constant[begin + a]);
    for (int32_t v = 0; v < 8; v += wide) {
      const InCube in_cube(v);
      hn::Store(exp2(d, dot(x, y, z, in_cube.x, in_cube.y, in_cube.z)), d,
                &w.change[8 * a + static_cast<size_t>(v)]);
    }
    for (int32_t n_yz = 0; n_yz < 16; n_yz += wide)
      hn::Store(exp2(d, hn::MulAdd(y, hn::Load(d, cubes.y + n_yz), hn::Mul(z, hn::Load(d, cubes.z + n_yz)))), d,
                yz + n_yz);
    for (int32_t i = 0; i < 4; ++i) {
      const VD along = exp2(d, hn::MulAdd(x, hn::Set(d, cubes.x[16 * i]), constant));
      for (int32_t n_yz = 0; n_yz < 16; n_yz += wide)
        hn::Store(hn::Mul(along, hn::Load(d, yz + n_yz)), d,
                  &w.middle[64 * a + static_cast<size_t>(16 * i + n_yz)]);
    }
  }
}

/// sum[512] += S^P of unit u in those cubes, each relative to 2^floor of its cube.
template <class Power>
HWY_INLINE void add_products(const ExactUnits& units, const BlockShape<double>& shape, size_t u, uint64_t where,
                             const double* floor, Power power, LogScratch& w, double* sum) {
  const auto begin = static_cast<size_t>(units.begin[u]), n = static_cast<size_t>(units.begin[u + 1]) - begin;
  find_products(units, begin, n, w);
  const PowerFactors factors(units, shape, u);
  const VD p = hn::Set(d, units.exponent[u]), bend = hn::Set(d, shape.curvature),
           term = hn::Set(d, units.log2_term[u] + 0.75 * shape.curvature), x = hn::Set(d, shape.slope * units.x[u]),
           y = hn::Set(d, shape.slope * units.y[u]), z = hn::Set(d, shape.slope * units.z[u]);
  for (int32_t first = 0; first < 64; first += wide) {
    uint64_t left = where >> first & ((uint64_t{1} << wide) - 1);
    if (left == 0)
      continue;
    const VD at_x = hn::Load(d, cubes.x + first), at_y = hn::Load(d, cubes.y + first),
             at_z = hn::Load(d, cubes.z + first);
    const VD factor = hn::Add(term, dot(at_x, at_y, at_z, hn::MulAdd(bend, at_x, x), hn::MulAdd(bend, at_y, y),
                                        hn::MulAdd(bend, at_z, z)));
    HWY_ALIGN double scale[wide];
    hn::Store(exp2(d, hn::MulSub(p, factor, hn::Load(d, floor + first))), d, scale);
    for (; left; left &= left - 1) {
      const int32_t lane = std::countr_zero(left), at = first + lane;
      const double* const middle = &w.middle[static_cast<size_t>(at)];
      for (int32_t v = 0; v < 8; v += wide) {
        VD t = hn::Zero(d);
        for (size_t a = 0; a < n; ++a)
          t = hn::MulAdd(hn::Set(d, middle[64 * a]), hn::Load(d, &w.change[8 * a + static_cast<size_t>(v)]), t);
        const VD all = hn::Mul(hn::Mul(hn::Set(d, scale[lane]), hn::Load(d, factors.x[at >> 4] + v)),
                               hn::Load(d, factors.yz[at & 15] + v));
        double* const to = sum + 8 * at + v;
        hn::Store(hn::MulAdd(all, power(d, t), hn::Load(d, to)), d, to);
      }
    }
  }
}

/// to += 2^floor · sum, which is 0 again.
void add_sums(const double* floor, double* sum, LogSums& to) {
  for (int32_t i = 0; i < 512; i += wide) {
    const VD before = hn::Load(d, to.largest + i), base = hn::Set(d, floor[i >> 3]), more = hn::Max(before, base);
    hn::Store(hn::MulAdd(hn::Load(d, to.parts + i), exp2(d, hn::Sub(before, more)),
                         hn::Mul(hn::Load(d, sum + i), exp2(d, hn::Sub(base, more)))),
              d, to.parts + i);
    hn::Store(more, d, to.largest + i);
    hn::Store(hn::Zero(d), d, sum + i);
  }
}

void add_log_units_simd(const ExactUnits& units, const BlockShape<double>& shape, int32_t first, int32_t last,
                        double loss, LogScratch& w, LogSums& to) {
  const auto begin = static_cast<size_t>(first), end = static_cast<size_t>(last);
  int32_t atoms = 0;          // of one unit
  HWY_ALIGN double floor[64]; // of log2 of the sum in a cube
  std::fill_n(floor, 64, -1e290);
  w.most.resize(std::max(w.most.size(), 64 * (end - begin)));
  for (size_t u = begin; u < end; ++u) {
    atoms = std::max(atoms, units.begin[u + 1] - units.begin[u]);
    UnitBall(units, shape, u).bounds([&](int32_t n, VD least, VD most) {
      hn::Store(hn::Max(least, hn::Load(d, floor + n)), d, floor + n);
      hn::Store(most, d, &w.most[64 * (u - begin) + static_cast<size_t>(n)]);
    });
  }
  const double least_part = std::log2(0.5 * loss / std::max(atoms, last - first));
  bool products = false;
  for (size_t u = begin; u < end; ++u) {
    uint64_t where = 0;
    VD above = hn::Zero(d);
    for (int32_t n = 0; n < 64; n += wide) {
      const VD beyond =
          hn::Sub(hn::Load(d, &w.most[64 * (u - begin) + static_cast<size_t>(n)]), hn::Load(d, floor + n));
      uint8_t bits[8] = {};
      hn::StoreMaskBits(d, hn::Ge(beyond, hn::Set(d, least_part)), bits);
      where |= uint64_t{bits[0]} << n;
      above = hn::Max(above, beyond);
    }
    if (!is_product(units, shape, u, hn::GetLane(hn::MaxOfLanes(d, above)))) {
      add_unit(units, shape, u, where, least_part, w, to);
      continue;
    }
    products = true;
    const double p = units.exponent[u];
    const auto add = [&](auto power) { add_products(units, shape, u, where, floor, power, w, w.sum); };
    p == 1 || units.begin[u + 1] - units.begin[u] == 1 ? add(One{}) : with_power(p, add);
  }
  if (products)
    add_sums(floor, w.sum, to);
}

void raise_log_group_simd(double p, LogSums& from, LogSums& to) {
  for (int32_t i = 0; i < 512; i += wide)
    add_log(hn::Mul(hn::Set(d, p), logs(from, i)), to, i);
  from.clear();
}

void sums_of_logs_simd(const LogSums& from, double start, float* sum) {
  HWY_ALIGN double values[wide];
  for (int32_t i = 0; i < 512; i += wide) {
    hn::Store(hn::Add(hn::Set(d, start), exp2(d, hn::Min(logs(from, i), hn::Set(d, 1023.0)))), d, values);
    for (int32_t k = 0; k < wide; ++k)
      sum[LogSums::slot(i + k)] = static_cast<float>(values[k]);
  }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace molmesh::density
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace molmesh::density {

HWY_EXPORT(add_log_units_simd);
HWY_EXPORT(raise_log_group_simd);
HWY_EXPORT(sums_of_logs_simd);

void add_log_units(const ExactUnits& units, const BlockShape<double>& shape, int32_t first, int32_t last,
                   double loss, LogScratch& scratch, LogSums& to) {
  MOLMESH_DISPATCH(add_log_units_simd)(units, shape, first, last, loss, scratch, to);
}
void raise_log_group(double p, LogSums& from, LogSums& to) {
  MOLMESH_DISPATCH(raise_log_group_simd)(p, from, to);
}
void sums_of_logs(const LogSums& from, double start, float* sum) {
  MOLMESH_DISPATCH(sums_of_logs_simd)(from, start, sum);
}

} // namespace molmesh::density
#endif
