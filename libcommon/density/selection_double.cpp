// selection_double.cpp — the units of a block in double precision, relative to the mean of their atoms.
#include "density/selection.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace molmesh::density {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

} // namespace

/// Units with the atoms' logarithms and positions, not yet relative to the unit's middle.
void Selection::take_double(Vec3d middle) {
  unit.clear();
  for (std::vector<double>* v : {&ln_weight, &offset_x, &offset_y, &offset_z})
    v->clear();
  for (const int32_t k : kept()) {
    const auto n = static_cast<size_t>(k);
    const int64_t group = near_.group[n];
    Unit u{group, f_.level[0].exponent[static_cast<size_t>(group)], static_cast<int32_t>(ln_weight.size()), 0, 0,
           {}};
    double largest = -infinity;
    for (auto i = static_cast<size_t>(near_.begin[n]); i < static_cast<size_t>(near_.begin[n + 1]); ++i) {
      const auto cluster = static_cast<size_t>(local_.cluster[static_cast<size_t>(near_.cluster[i])]);
      for (auto a = static_cast<size_t>(f_.begin[cluster]); a < static_cast<size_t>(f_.begin[cluster + 1]); ++a) {
        const Vec3d d{f_.x[a] - middle.x, f_.y[a] - middle.y, f_.z[a] - middle.z};
        ln_weight.push_back(f_.peak[a] - f_.decay * norm2(d));
        largest = std::max(largest, ln_weight.back());
        offset_x.push_back(f_.x[a]);
        offset_y.push_back(f_.y[a]);
        offset_z.push_back(f_.z[a]);
      }
    }
    u.end = static_cast<int32_t>(ln_weight.size());
    double sum = 0;
    Vec3d moment{};
    for (auto a = static_cast<size_t>(u.begin); a < static_cast<size_t>(u.end); ++a) {
      const double w = std::exp(ln_weight[a] - largest);
      sum += w;
      moment += w * Vec3d{offset_x[a], offset_y[a], offset_z[a]};
    }
    u.ln_center = largest + std::log(sum);
    u.centroid = moment / sum;
    unit.push_back(u);
  }
}

/// Drops atoms as take_single does; makes logarithms and positions relative to the unit's middle and centroid.
void Selection::filter(Vec3d middle, Vec3d half) {
  size_t to = 0;
  double range = 0;
  for (Unit& u : unit) {
    const double ln_small = std::log(within_ / (u.end - u.begin));
    const auto begin = static_cast<size_t>(u.begin), end = static_cast<size_t>(u.end);
    u.begin = static_cast<int32_t>(to);
    for (size_t a = begin; a < end; ++a) {
      const Vec3d offset = Vec3d{offset_x[a], offset_y[a], offset_z[a]} - u.centroid;
      const double swing =
          2 * f_.decay * (half.x * std::abs(offset.x) + half.y * std::abs(offset.y) + half.z * std::abs(offset.z));
      const double ln = ln_weight[a] - u.ln_center;
      if (ln + swing < ln_small)
        continue;
      range = std::max(range, swing);
      ln_weight[to] = ln;
      offset_x[to] = offset.x;
      offset_y[to] = offset.y;
      offset_z[to] = offset.z;
      ++to;
    }
    u.end = static_cast<int32_t>(to);
    const Vec3d away = middle - u.centroid;
    range =
        std::max(range, 2 * f_.decay * u.exponent *
                            (half.x * std::abs(away.x) + half.y * std::abs(away.y) + half.z * std::abs(away.z)));
  }
  for (std::vector<double>* v : {&ln_weight, &offset_x, &offset_y, &offset_z})
    v->resize(to);
  units = static_cast<int64_t>(unit.size());
  atoms = static_cast<int64_t>(to);
  if (range > 690)
    arithmetic = Arithmetic::in_logarithms;
}

} // namespace molmesh::density
