// relax.cpp — the passes on the host's threads, many elements or places at a time.
#include "contour/relax.hpp"
#include "contour/detail/at.hpp"
#include "contour/detail/move_vertex.hpp"
#include "contour/detail/relax_passes.hpp"
#include "error.hpp"
#include "geom/predicates.hpp"
#include "improve/isosurface.hpp"
#include "improve/near_isosurface.hpp"
#include "improve/quality_kernel.hpp"
#include "improve/spokes.hpp"
#include "par/launcher.hpp"
#include <algorithm>
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
    elements_ = at(r.first[candidate + 1] - r.first[candidate]);
    eights_.resize((elements_ + 7) / 8);
    moving_.resize(elements_);
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
      spokes_.add(p, static_cast<int>(moving));
      moving_[k] = moving;
    }
    length_ /= 3. * double(elements_);
  }
  double length() const { return length_; }
  improve::Spokes& spokes() { return spokes_; }
  bool take(Vec3d x, float worst) {
    quality_.resize(8 * eights_.size());
    for (size_t k = 0; k < elements_; ++k)
      eights_[k / 8].set(k % 8, moving_[k], x);
    for (size_t g = 0; g < eights_.size(); ++g) {
      float q[8];
      improve::qualities(eights_[g], q, r_->shape);
      for (size_t k = 8 * g; k < elements_ && k < 8 * g + 8; ++k) {
        if (q[k % 8] <= worst)
          return false;
        const improve::EightElements& e = eights_[g];
        if (q[k % 8] < improve::surely_positive &&
            orient3d(e.corner(k % 8, 0), e.corner(k % 8, 1), e.corner(k % 8, 2), e.corner(k % 8, 3)) <= 0)
          return false;
        quality_[k] = q[k % 8];
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
  improve::Spokes spokes_;
  std::vector<Tet> tet_;
  std::vector<improve::EightElements> eights_;
  std::vector<size_t> moving_;
  std::vector<float> quality_;
};

/// A chunk of elements: those of the lattice apart, the others eight at a time.
struct JudgeChunk {
  static constexpr int64_t grain = 1, chunk = 4096;
  detail::Qualities all;
  void operator()(int64_t c) const {
    const ElementsView& e = all.e;
    std::array<int64_t, size_t(chunk)> others;
    size_t n = 0;
    for (int64_t t = c * chunk, end = std::min(e.tets, t + chunk); t < end; ++t) { // no branches: no telling
      all.quality[t] = 1;
      others[n] = t;
      for (const int32_t v : e.tet[t])
        __builtin_prefetch(&e.position[v]);
      n += !all.of_lattice(e.tet[t]);
    }
    improve::judge_each(
        n, [&](size_t k, size_t i) { return e.position[e.tet[others[k]][i]]; },
        [&](size_t k, float q) {
          all.quality[others[k]] = q;
          return true;
        },
        all.shape);
  }
};

/// As it is best asked for one vertex.
improve::NearIsosurface near(const improve::IsosurfaceView& surface) {
  return improve::NearIsosurface(surface);
}
template <class Surface>
const Surface& near(const Surface& surface) {
  return surface;
}

template <class Surface>
struct MoveFirst {
  static constexpr int64_t grain = 16;
  detail::RelaxView r;
  const Surface& surface;
  double most_distance;
  const int32_t* active;
  Fate* fate;
  void operator()(int64_t i) const {
    if (fate[i] != Fate::stays)
      return;
    thread_local Star star;
    star.begin(r, active[i]);
    const auto& here = near(surface);
    if (detail::move_vertex(r, here, most_distance, active[i], star))
      fate[i] = Fate::moves;
  }
};

template <class Surface>
class Mover {
public:
  Mover(par::Launcher& m, const Surface& surface) : m_(m), surface_(surface) {}
  void judge(const detail::Qualities& all) {
    m_.for_n("element qualities", (all.e.tets + JudgeChunk::chunk - 1) / JudgeChunk::chunk, JudgeChunk{all});
  }
  void begin(const detail::RelaxView&, int64_t, int64_t) {}
  void move(const detail::RelaxView& r, const int32_t* active, int64_t n, Fate* fate, double most_distance) {
    m_.for_n("move vertices", n, MoveFirst<Surface>{r, surface_, most_distance, active, fate});
  }

private:
  par::Launcher& m_;
  const Surface& surface_;
};

/// Without a surface: vertices on it do not ask.
struct NoSurface {
  bool probe(Vec3d, double&, Vec3d&) const { return false; }
  double spacing() const { return 0; }
};

template <class Surface>
int64_t relax_on(const Surface& surface, bool surface_moves, Elements& elements,
                 const LargeArray<uint8_t>& lattice_class, int threads) {
  par::Launcher launcher(threads);
  Mover<Surface> mover(launcher, surface);
  return detail::RelaxPasses<par::Launcher, Mover<Surface>>(launcher, elements.view(), lattice_class.data(),
                                                            static_cast<int64_t>(lattice_class.size()),
                                                            surface_moves, mover)
      .run();
}

} // namespace

int64_t relax(Elements& elements, const LargeArray<uint8_t>& lattice_class, const improve::Target* surface,
              int threads) {
  if (constexpr int64_t most = INT32_MAX; static_cast<int64_t>(elements.tet.size()) > most)
    fail(Status::failed, std::to_string(elements.tet.size()) + " elements on both sides, expected " +
                             std::to_string(most) + " at most: a coarser spacing or a larger --adapt");
  if (!surface)
    return relax_on(NoSurface{}, false, elements, lattice_class, threads);
  if (const auto* isosurface = dynamic_cast<const improve::Isosurface*>(surface))
    return relax_on(isosurface->view(), true, elements, lattice_class, threads);
  return relax_on(*surface, true, elements, lattice_class, threads);
}

} // namespace molmesh::contour
