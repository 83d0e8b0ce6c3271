// spokes.cpp — from corners to the kernels' groups.
#include "improve/spokes.hpp"
#include <algorithm>
#include <bit>

namespace molmesh::improve {

void Spokes::add(const std::array<Vec3d, 4>& p, int moving) {
  const auto corner = [&](int i) { return p[size_t(spoke_corner(moving, i))]; };
  if (inverse_ == 0)
    inverse_ = 1 / std::max(norm(corner(1) - corner(2)), 1e-300);
  const auto field = std::bit_cast<std::array<float, SpokeGroup::fields>>(
      make_spoke(local(corner(1)), local(corner(2)), local(corner(3))));
  const auto lane = static_cast<int>(order_.size() % SpokeGroup::lanes);
  if (lane == 0) {
    group_.emplace_back();
    for (size_t k = 0; k < field.size(); ++k)
      std::fill_n(group_.back().field[k], SpokeGroup::lanes, field[k]);
  } else {
    for (size_t k = 0; k < field.size(); ++k)
      group_.back().field[k][lane] = field[k];
  }
  order_.push_back(static_cast<int32_t>(order_.size()));
}

Vec3d Spokes::ascent(Vec3d x, double step) {
  const Vec3f y = local(x);
  quality_.resize(group_.size() * SpokeGroup::lanes);
  judge_spokes(view(), y, quality_.data());
  const auto worst = std::min_element(quality_.begin(), quality_.begin() + static_cast<std::ptrdiff_t>(size()));
  std::swap(*std::find(order_.begin(), order_.end(), static_cast<int32_t>(worst - quality_.begin())),
            order_.front());
  float side[6];
  judge_around(view(), static_cast<int32_t>(worst - quality_.begin()), y, static_cast<float>(step * inverse_),
               side);
  Vec3d g;
  for (int a = 0; a < 3; ++a)
    g[a] = double(side[2 * a]) - double(side[2 * a + 1]);
  const double length = norm(g);
  return length > 0 ? g / length : Vec3d{};
}

int Spokes::first_above(const Vec3d* y, int from, int n, float above, float& q) {
  Places places;
  for (int k = from; k < n; ++k) {
    const Vec3f u = local(y[k]);
    places.x[k] = u.x, places.y[k] = u.y, places.z[k] = u.z;
  }
  return first_place_above(view(), places, from, n, above, q);
}

} // namespace molmesh::improve
