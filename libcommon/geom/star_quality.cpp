// star_quality.cpp — groups the corners of elements for SIMD.
#include "geom/star_quality.hpp"
#include <algorithm>

namespace molmesh {

void StarQuality::add(const std::array<Vec3d, 4>& p, int moving) {
  const auto corner = [&](int i) { return p[star_corner(moving, i)]; };
  if (inverse_ == 0)
    inverse_ = 1 / std::max(norm(corner(1) - corner(2)), 1e-300);
  const auto lane = order_.size() % StarElementGroup::lanes;
  if (lane == 0) {
    if (!made_)
      make_last_group();
    group_.emplace_back();
  }
  for (int i = 0; i < 3; ++i)
    for (int a = 0; a < 3; ++a)
      last_.field[3 * i + a][lane] = corner(i + 1)[a];
  made_ = false;
  order_.push_back(static_cast<int32_t>(order_.size()));
}

void StarQuality::make_last_group() {
  const size_t used = (order_.size() - 1) % StarElementGroup::lanes + 1;
  for (double* const field : last_.field)
    std::fill(field + used, field + StarElementGroup::lanes, field[0]);
  make_star_elements(last_, origin_, inverse_, group_.back());
  made_ = true;
}

Vec3d StarQuality::ascent(Vec3d x, double step, float* worst_quality) {
  const Vec3f y = local(x);
  quality_.resize(group_.size() * StarElementGroup::lanes);
  star_qualities(view(), y, quality_.data());
  const auto worst = std::min_element(quality_.begin(), quality_.begin() + static_cast<std::ptrdiff_t>(size()));
  std::swap(*std::find(order_.begin(), order_.end(), static_cast<int32_t>(worst - quality_.begin())),
            order_.front());
  if (worst_quality)
    *worst_quality = *worst;
  float side[6];
  judge_around(view(), static_cast<int32_t>(worst - quality_.begin()), y, static_cast<float>(step * inverse_),
               side);
  Vec3d g;
  for (int a = 0; a < 3; ++a)
    g[a] = double(side[2 * a]) - double(side[2 * a + 1]);
  const double length = norm(g);
  return length > 0 ? g / length : Vec3d{};
}

int StarQuality::first_above(const Vec3d* y, int from, int n, float above, float& q) {
  Places places;
  for (int k = from; k < n; ++k) {
    const Vec3f u = local(y[k]);
    places.x[k] = u.x, places.y[k] = u.y, places.z[k] = u.z;
  }
  return first_place_above(view(), places, from, n, above, q);
}

} // namespace molmesh
