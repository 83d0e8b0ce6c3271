// star_quality.hpp — the worst quality of the elements at a moving vertex, for many elements or places at a time.
#pragma once
#include "geom/star_quality_simd.hpp"
#include "geom/tet_quality.hpp"
#include <array>
#include <cstdint>
#include <vector>

namespace molmesh {

/// Single precision relative to where the vertex began: for comparing places. What is taken is judged in double.
class StarQuality {
public:
  static constexpr int most_places = Places::most; ///< of first_above
  /// Lengths are measured from `origin` in units of the first element's first edge. shape: as tet_quality has it.
  void clear(Vec3d origin, double shape = shape_weight) {
    origin_ = origin;
    shape_ = static_cast<float>(shape);
    inverse_ = 0;
    decided_ = 0;
    made_ = true;
    group_.clear();
    order_.clear();
  }
  /// p: corners of a positive element; p[moving] is the vertex, wherever it is now.
  void add(const std::array<Vec3d, 4>& p, int moving);
  size_t size() const { return order_.size(); }
  /// Smallest quality with the vertex at x, or some value ≤ above as soon as elements are no better than that.
  float worst(Vec3d x, float above) { return worst_in_star(view(), local(x), above); }
  /// Direction (unit) in which the worst element at x, of equals the first, improves fastest, by differences over
  /// `step`; zero when flat. worst: its quality. Not of an empty star.
  Vec3d ascent(Vec3d x, double step, float* worst = nullptr);
  /// The first of places y[from … n - 1] at which worst() is above; n: none. q: worst() there.
  int first_above(const Vec3d* y, int from, int n, float above, float& q);

private:
  void make_last_group();
  StarView view() {
    if (!made_)
      make_last_group();
    return {group_.data(), static_cast<int32_t>(order_.size()), order_.data(), &decided_, shape_};
  }
  Vec3f local(Vec3d x) const {
    const Vec3d u = (x - origin_) * inverse_;
    return {static_cast<float>(u.x), static_cast<float>(u.y), static_cast<float>(u.z)};
  }
  Vec3d origin_;
  float shape_ = 0;
  double inverse_ = 0; ///< of the unit of length
  int32_t decided_ = 0;
  std::vector<StarElementGroup> group_;
  StarCorners last_; ///< of the last group
  bool made_ = true; ///< the last group is, from all of last_
  std::vector<int32_t> order_;
  std::vector<float> quality_;
};

} // namespace molmesh
