// relax.cpp — the passes on the host's threads, elements of a star eight at a time.
#include "contour/relax.hpp"
#include "contour/detail/at.hpp"
#include "contour/detail/move_vertex.hpp"
#include "contour/detail/relax_passes.hpp"
#include "geom/predicates.hpp"
#include "improve/spokes.hpp"
#include "par/launcher.hpp"
#include <array>
#include <vector>

namespace molmesh::contour {

using detail::at;
using detail::Fate;
namespace {

/// Of detail::move_vertex; keeps its memory from star to star.
class Star {
public:
  void begin(const detail::RelaxView& r, int32_t candidate) {
    r_ = &r;
    vertex_ = r.vertex[candidate];
    element_ = r.element + r.first[candidate];
    const Vec3d x = r.e.position[vertex_];
    spokes_.clear(x);
    corner_.clear();
    moving_.clear();
    length_ = 0;
    for (const int32_t* e = element_; e < r.element + r.first[candidate + 1]; ++e) {
      const Tet& t = r.e.tet[*e];
      std::array<Vec3d, 4> p;
      size_t moving = 0;
      for (size_t i = 0; i < 4; ++i) {
        p[i] = r.e.position[t[i]];
        length_ += norm(p[i] - x);
        if (t[i] == vertex_)
          moving = i;
      }
      spokes_.add(p, static_cast<int>(moving));
      corner_.push_back(p);
      moving_.push_back(moving);
    }
    length_ /= 3. * double(spokes_.size());
  }
  double length() const { return length_; }
  float worst(Vec3d x, float above) { return spokes_.worst(x, above); }
  Vec3d ascent(Vec3d x, double step) { return spokes_.ascent(x, step); }
  bool take(Vec3d x, float worst) {
    quality_.clear();
    for (size_t k = 0; k < corner_.size(); ++k) {
      std::array<Vec3d, 4>& p = corner_[k];
      p[moving_[k]] = x;
      quality_.push_back(improve::tet_quality(p[0], p[1], p[2], p[3]));
      if (quality_.back() <= worst || orient3d(p[0], p[1], p[2], p[3]) <= 0)
        return false;
    }
    r_->e.position[vertex_] = x;
    for (size_t k = 0; k < quality_.size(); ++k)
      r_->quality[element_[k]] = quality_[k];
    return true;
  }

private:
  const detail::RelaxView* r_ = nullptr;
  const int32_t* element_ = nullptr;
  int32_t vertex_ = 0;
  double length_ = 0;
  improve::Spokes spokes_;
  std::vector<std::array<Vec3d, 4>> corner_;
  std::vector<size_t> moving_;
  std::vector<float> quality_;
};

struct MoveFirst {
  static constexpr int64_t grain = 16;
  detail::RelaxView r;
  const improve::Target* surface;
  double most_distance;
  const int32_t* active;
  Fate* fate;
  void operator()(int64_t i) const {
    if (fate[i] != Fate::stays)
      return;
    thread_local Star star;
    star.begin(r, active[i]);
    if (detail::move_vertex(r, *surface, most_distance, active[i], star))
      fate[i] = Fate::moves;
  }
};

class Mover {
public:
  Mover(par::Launcher& m, const improve::Target* surface) : m_(m), surface_(surface) {}
  void begin(const detail::RelaxView&, int64_t, int64_t) {}
  void move(const detail::RelaxView& r, const int32_t* active, int64_t n, Fate* fate, double most_distance) {
    m_.for_n("move vertices", n, MoveFirst{r, surface_, most_distance, active, fate});
  }

private:
  par::Launcher& m_;
  const improve::Target* surface_;
};

} // namespace

int64_t relax(Elements& elements, const LargeArray<uint8_t>& lattice_class, const improve::Target* surface,
              int threads) {
  par::Launcher launcher(threads);
  Mover mover(launcher, surface);
  return detail::RelaxPasses<par::Launcher, Mover>(launcher, elements.view(), lattice_class.data(),
                                                   static_cast<int64_t>(lattice_class.size()), surface != nullptr,
                                                   mover)
      .run();
}

} // namespace molmesh::contour
