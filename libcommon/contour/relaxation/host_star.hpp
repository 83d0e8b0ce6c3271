// host_star.hpp — the elements round a vertex that moves, judged on the host eight elements or places at a time.
#pragma once
#include "contour/relaxation/relax_items.hpp"
#include "geom/predicates.hpp"
#include "geom/star_quality.hpp"
#include "geom/tet_quality_simd.hpp"
#include <algorithm>
#include <array>
#include <vector>

namespace molmesh::contour {

/// As pattern_search needs it; quality counts as in Qualities.
class WeightedStar {
public:
  static constexpr int most_places = StarQuality::most_places;
  void clear(Vec3d origin, double shape) {
    meshed_.clear(origin, shape);
    other_.clear(origin, shape);
  }
  void add(const std::array<Vec3d, 4>& p, int moving, bool is_meshed) {
    (is_meshed ? meshed_ : other_).add(p, moving);
  }
  float worst(Vec3d x, float above) {
    const float w = meshed_.worst(x, above);
    return w > above && other_.size() > 0 ? std::min(w, worst_other(x, above)) : w;
  }
  Vec3d ascent(Vec3d x, double step) {
    float meshed = none, other = none;
    const Vec3d of_meshed = meshed_.size() > 0 ? meshed_.ascent(x, step, &meshed) : Vec3d{};
    const Vec3d of_other = other_.size() > 0 ? other_.ascent(x, step, &other) : Vec3d{};
    return meshed <= unmeshed_weight * other ? of_meshed : of_other;
  }
  int first_above(const Vec3d* y, int from, int n, float above, float& q) {
    for (int k = from;; ++k) {
      k = meshed_.first_above(y, k, n, above, q);
      if (k >= n || other_.size() == 0)
        return k;
      if (const float other = worst_other(y[k], above); other > above) {
        q = std::min(q, other);
        return k;
      }
    }
  }

private:
  static constexpr float none = 2; ///< better than any element
  float worst_other(Vec3d x, float above) { return unmeshed_weight * other_.worst(x, above / unmeshed_weight); }
  StarQuality meshed_, other_;
};

/// Of move_vertex and move_nearer; keeps its memory from star to star.
class HostStar {
public:
  void begin(const RelaxView& r, int32_t candidate) {
    r_ = &r;
    vertex_ = r.vertex[candidate];
    element_ = r.element + r.first[candidate];
    elements_ = static_cast<size_t>(r.first[candidate + 1] - r.first[candidate]);
    eights_.resize((elements_ + 7) / 8);
    moving_.resize(elements_);
    meshed_.resize(elements_);
    const Vec3d x = r.e.position[vertex_];
    star_quality_.clear(x, r.shape);
    length_ = 0;
    // In three steps, so that many elements and then corners are on their way from memory at once.
    tet_.resize(elements_);
    for (size_t k = 0; k < elements_; ++k)
      tet_[k] = r.e.tet[element_[k]];
    for (const Tet& t : tet_)
      for (const int32_t v : t)
        __builtin_prefetch(&r.e.position[v]);
    for (size_t k = 0; k < elements_; ++k) {
      const Tet& t = tet_[k];
      std::array<Vec3d, 4> p;
      size_t moving = 0;
      for (size_t i = 0; i < 4; ++i) {
        p[i] = r.e.position[t[i]];
        eights_[k / 8].set(k % 8, i, p[i]);
        length_ += norm(p[i] - x);
        if (t[i] == vertex_)
          moving = i;
      }
      meshed_[k] = r.classes.is_meshed(t);
      star_quality_.add(p, static_cast<int>(moving), meshed_[k]);
      moving_[k] = moving;
    }
    length_ /= 3. * double(elements_);
  }
  double length() const { return length_; }
  WeightedStar& star_quality() { return star_quality_; }
  bool take(Vec3d x, float worst) {
    quality_.resize(8 * eights_.size());
    for (size_t k = 0; k < elements_; ++k)
      eights_[k / 8].set(k % 8, moving_[k], x);
    for (size_t g = 0; g < eights_.size(); ++g) {
      float q[8];
      qualities(eights_[g], q, r_->shape);
      for (size_t k = 8 * g; k < elements_ && k < 8 * g + 8; ++k) {
        const float weight = meshed_[k] ? 1 : unmeshed_weight;
        if (weight * q[k % 8] <= worst)
          return false;
        const EightElements& e = eights_[g];
        if (q[k % 8] < surely_positive &&
            orient3d(e.corner(k % 8, 0), e.corner(k % 8, 1), e.corner(k % 8, 2), e.corner(k % 8, 3)) <= 0)
          return false;
        quality_[k] = weight * q[k % 8];
      }
    }
    r_->e.position[vertex_] = x;
    for (size_t k = 0; k < elements_; ++k)
      r_->quality[element_[k]] = quality_[k];
    return true;
  }

private:
  const RelaxView* r_ = nullptr;
  const int32_t* element_ = nullptr;
  size_t elements_ = 0;
  int32_t vertex_ = 0;
  double length_ = 0;
  WeightedStar star_quality_;
  std::vector<Tet> tet_;
  std::vector<EightElements> eights_;
  std::vector<size_t> moving_;
  std::vector<uint8_t> meshed_;
  std::vector<float> quality_;
};

} // namespace molmesh::contour
