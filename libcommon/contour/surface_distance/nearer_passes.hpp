// nearer_passes.hpp — after relaxation, moves corners of surface triangles far from the isosurface nearer to it;
// pass by pass, over a launcher.
#pragma once
#include "contour/relaxation/star_passes.hpp"
#include "contour/surface_distance/nearer_items.hpp"

namespace molmesh::contour {

/// Mover: measure(e, off) measures all triangles; move_nearer(view, active, n, fate) lets those move who have the
/// turn; begin as RelaxPasses has it.
template <par::Launcher Launcher, class Mover>
class NearerPasses {
  template <class T>
  using Array = typename Launcher::template Array<T>;
  using Ids = par::List<Launcher, int32_t>;

public:
  /// stars: memory for those of this.
  NearerPasses(Launcher& m, Mover& mover, const RelaxView& r, StarPasses<Launcher>& stars)
      : m_(m), mover_(mover), stars_(stars), off_(m.template array<float>(r.e.tris)) {
    constexpr double angle = 16;
    v_.r = r;
    v_.room = static_cast<float>(angle_quality(angle));
    v_.off = off_.data();
  }

  /// How often a vertex moved.
  int64_t run() {
    constexpr int most_passes = 6, most_rounds = 20;
    mover_.measure(v_.r.e, v_.off);
    far_ = far_triangles(v_.r.e.tris, nullptr);
    int64_t moved = 0;
    for (int pass = 0; pass < most_passes && far_.n > 0; ++pass) {
      find_candidates(pass);
      const int64_t moves = stars_.run_rounds(
          v_.r, most_rounds,
          [&](const int32_t* active, int round) {
            return StartNearer{v_, active, round};
          },
          [&](const int32_t* active, int64_t n, Fate* fate) { mover_.move_nearer(v_, active, n, fate); });
      if (moves == 0)
        break;
      moved += moves;
      far_ = far_triangles(far_.n, far_.data());
    }
    return moved;
  }

private:
  /// among: null: all n.
  Ids far_triangles(int64_t n, const int32_t* among) {
    return par::gather<int32_t>(m_, "far triangles", n, FarTriangles{v_.off, among});
  }

  /// The far triangles' corners; after the first pass, for the few that elements hold back, all vertices of
  /// elements there. By moves no triangle becomes far: a pass looks among what the one before it found.
  void find_candidates(int pass) {
    const ElementsView& e = v_.r.e;
    auto wanted = m_.filled(e.positions, uint8_t{0});
    m_.for_n("want corners", far_.n, WantCorners<Tri>{e.tri, far_.data(), wanted.data()});
    near_ = par::gather<int32_t>(m_, "near triangles", pass > 0 ? near_.n : e.tris,
                                 NearTriangles{e, wanted.data(), pass > 0 ? near_.data() : nullptr});
    if (pass > 0) {
      const Ids at_far = near_elements(m_, e, wanted.data(), &stars_.near());
      m_.for_n("want neighbours", at_far.n, WantCorners<Tet>{e.tet, at_far.data(), wanted.data()});
    }
    auto vertex = par::flagged(m_, "candidates", e.positions, wanted.data());
    auto near = near_elements(m_, e, wanted.data(), pass > 1 ? &stars_.near() : nullptr);
    stars_.gather_stars(v_.r, std::move(vertex), std::move(near));
    mover_.begin(v_.r, stars_.candidates(), stars_.entries());
    gather_triangles();
  }
  void gather_triangles() {
    const int64_t n = stars_.candidates();
    const TriangleCandidate of{v_.r.e.tri, near_.data(), stars_.number()};
    place_stars<PlaceTriangleStars>(m_, "triangle stars", 3 * near_.n, n, of, triangle_, first_);
    v_.first = first_.data();
    v_.triangle = triangle_.data();
  }

  Launcher& m_;
  Mover& mover_;
  StarPasses<Launcher>& stars_;
  NearerView v_{};
  Array<float> off_;
  Ids far_, near_; ///< triangles
  Array<int32_t> triangle_;
  Array<int64_t> first_;
};

} // namespace molmesh::contour
