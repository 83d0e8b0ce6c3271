// relax.cpp — relaxation on the host's threads, many elements or places at a time.
#include "contour/relaxation/relax.hpp"
#include "base/error.hpp"
#include "contour/relaxation/host_star.hpp"
#include "contour/relaxation/relax_passes.hpp"
#include "contour/surface_distance/move_nearer.hpp"
#include "geom/tet_quality_simd.hpp"
#include "isosurface/isosurface.hpp"
#include "isosurface/near_isosurface.hpp"
#include "par/launcher.hpp"
#include <algorithm>
#include <array>
#include <vector>

namespace molmesh::contour {

namespace {

/// A chunk of elements: those of the lattice apart, the others eight at a time.
struct JudgeChunk {
  static constexpr int64_t grain = 1, chunk = 4096;
  Qualities all;
  void operator()(int64_t c) const {
    const ElementsView& e = all.e;
    std::array<int64_t, size_t(chunk)> others;
    size_t n = 0;
    for (int64_t t = c * chunk, end = std::min(e.tets, t + chunk); t < end; ++t) { // no branches: no telling
      all.quality[t] = 1;
      others[n] = t;
      for (const int32_t v : e.tet[t])
        __builtin_prefetch(&e.position[v]);
      n += !all.classes.of_lattice(e.tet[t]);
    }
    judge_each(
        n, [&](size_t k, size_t i) { return e.position[e.tet[others[k]][i]]; },
        [&](size_t k, float q) {
          all.quality[others[k]] = all.weighted(e.tet[others[k]], q);
          return true;
        },
        all.shape);
  }
};

/// The view that is fastest for one vertex.
NearIsosurface near(const IsosurfaceView& surface) {
  return NearIsosurface(surface);
}
template <class Surface>
const Surface& near(const Surface& surface) {
  return surface;
}

/// Those who have the turn; try_one(candidate, star) moves one.
template <class TryOne>
struct MoveFirst {
  static constexpr int64_t grain = 16;
  RelaxView r;
  const int32_t* active;
  Fate* fate;
  TryOne try_one;
  void operator()(int64_t i) const {
    if (fate[i] != Fate::stays)
      return;
    thread_local HostStar star;
    star.begin(r, active[i]);
    if (try_one(active[i], star))
      fate[i] = Fate::moves;
  }
};

/// A chunk of triangles, those of the surface eight at a time.
template <class Surface>
struct MeasureChunk {
  static constexpr int64_t grain = 256;
  MeasureTriangles<const Surface&> all;
  void run(int64_t begin, int64_t end) const {
    for (int64_t t = begin; t < end; ++t)
      for (const int32_t v : all.e.tri[t])
        __builtin_prefetch(&all.e.position[v]);
    EightPlaces c;
    std::array<int64_t, 8> which;
    size_t n = 0;
    const auto measure = [&] {
      EightProbes probes;
      near(all.isosurface).probe_eight(c, static_cast<int>(n), probes);
      for (size_t i = 0; i < n; ++i)
        all.off[which[i]] = probes.is_known(i)
                                ? CentroidDistance::measured(all.isosurface, c[i], probes.distance[i])
                                : CentroidDistance::beyond;
      n = 0;
    };
    for (int64_t t = begin; t < end; ++t) {
      all.off[t] = CentroidDistance::of_a_wall;
      if (!all.is_surface(t))
        continue;
      c.set(n, all.centroid(t));
      which[n] = t;
      if (++n == which.size())
        measure();
    }
    measure();
  }
};

template <class Surface>
class Mover {
public:
  Mover(par::HostLauncher& m, const Surface& surface) : m_(m), surface_(surface) {}
  void judge(const Qualities& all) {
    m_.for_n("element qualities", (all.e.tets + JudgeChunk::chunk - 1) / JudgeChunk::chunk, JudgeChunk{all});
  }
  void begin(const RelaxView&, int64_t, int64_t) {}
  void move(const RelaxView& r, const int32_t* active, int64_t n, Fate* fate, double most_distance) {
    const auto try_one = [&](int32_t c, HostStar& star) {
      const auto& here = near(surface_);
      return move_vertex(r, here, most_distance, c, star);
    };
    m_.for_n("move vertices", n, MoveFirst<decltype(try_one)>{r, active, fate, try_one});
  }
  void measure(const ElementsView& e, float* off) {
    m_.for_n("measure triangles", e.tris, MeasureChunk<Surface>{{e, surface_, off}});
  }
  void move_nearer(const NearerView& v, const int32_t* active, int64_t n, Fate* fate) {
    const auto try_one = [&](int32_t c, HostStar& star) {
      const auto& here = near(surface_);
      return move_nearer_or_make_room(v, here, c, star);
    };
    m_.for_n("move nearer", n, MoveFirst<decltype(try_one)>{v.r, active, fate, try_one});
  }

private:
  par::HostLauncher& m_;
  const Surface& surface_;
};

/// Without a surface: vertices on it do not move.
struct NoSurface {
  bool probe(Vec3d, double&, Vec3d&) const { return false; }
  void probe_eight(const EightPlaces&, int, EightProbes& out) const { out.known = 0; }
  bool project(Vec3d&, double) const { return false; }
  double spacing() const { return 0; }
};

template <class Surface>
int64_t relax_on(const Surface& surface, bool surface_moves, Elements& elements,
                 const LargeArray<uint8_t>& lattice_class, int threads) {
  par::HostLauncher launcher(threads);
  Mover<Surface> mover(launcher, surface);
  return RelaxPasses<par::HostLauncher, Elements, Mover<Surface>>(launcher, elements, lattice_class.data(),
                                                                  static_cast<int64_t>(lattice_class.size()),
                                                                  surface_moves, mover)
      .run();
}

} // namespace

LargeArray<uint8_t> lattice_classes(const Complex& complex, int threads) {
  par::HostLauncher launcher(threads);
  LargeArray<uint8_t> of(static_cast<size_t>(complex.view.vertices()));
  launcher.for_n("lattice classes", complex.view.vertices(), LatticeClasses{complex.view, of.data()});
  return of;
}

int64_t relax(Elements& elements, const LargeArray<uint8_t>& lattice_class, const Target* surface, int threads) {
  if (!surface)
    return relax_on(NoSurface{}, false, elements, lattice_class, threads);
  if (const auto* isosurface = dynamic_cast<const Isosurface*>(surface))
    return relax_on(isosurface->view(), true, elements, lattice_class, threads);
  return relax_on(*surface, true, elements, lattice_class, threads);
}

} // namespace molmesh::contour
