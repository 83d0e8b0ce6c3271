// host_star.hpp — the elements round a vertex that moves, on the host: eight elements or places at a time.
#pragma once
#include "base/at.hpp"
#include "contour/relaxation/relax_items.hpp"
#include "contour/relaxation/weighted_star.hpp"
#include "geom/predicates.hpp"
#include "geom/tet_quality_simd.hpp"
#include <array>
#include <vector>

namespace molmesh::contour {

/// Of detail::move_vertex and move_nearer; keeps its memory from star to star.
class HostStar {
public:
  void begin(const detail::RelaxView& r, int32_t candidate) {
    r_ = &r;
    vertex_ = r.vertex[candidate];
    element_ = r.element + r.first[candidate];
    elements_ = at(r.first[candidate + 1] - r.first[candidate]);
    eights_.resize((elements_ + 7) / 8);
    moving_.resize(elements_);
    asked_.resize(elements_);
    const Vec3d x = r.e.position[vertex_];
    spokes_.clear(x, r.shape);
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
      asked_[k] = r.classes.is_asked(t);
      spokes_.add(p, static_cast<int>(moving), asked_[k]);
      moving_[k] = moving;
    }
    length_ /= 3. * double(elements_);
  }
  double length() const { return length_; }
  WeightedSpokes& spokes() { return spokes_; }
  bool take(Vec3d x, float worst) {
    quality_.resize(8 * eights_.size());
    for (size_t k = 0; k < elements_; ++k)
      eights_[k / 8].set(k % 8, moving_[k], x);
    for (size_t g = 0; g < eights_.size(); ++g) {
      float q[8];
      qualities(eights_[g], q, r_->shape);
      for (size_t k = 8 * g; k < elements_ && k < 8 * g + 8; ++k) {
        const float weight = asked_[k] ? 1 : detail::unasked_weight;
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
  const detail::RelaxView* r_ = nullptr;
  const int32_t* element_ = nullptr;
  size_t elements_ = 0;
  int32_t vertex_ = 0;
  double length_ = 0;
  WeightedSpokes spokes_;
  std::vector<Tet> tet_;
  std::vector<EightElements> eights_;
  std::vector<size_t> moving_;
  std::vector<uint8_t> asked_;
  std::vector<float> quality_;
};

} // namespace molmesh::contour
