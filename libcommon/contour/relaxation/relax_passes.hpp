// relax_passes.hpp — relaxation in rounds of independent vertices, pass by pass, over a launcher.
#pragma once
#include "base/error.hpp"
#include "contour/relaxation/star_passes.hpp"
#include "contour/surface_distance/nearer_passes.hpp"
#include <string>

namespace molmesh::contour {

/// Mover: judge(qualities) lets that item judge all elements; move(view, active, n, fate, most_distance) lets those
/// move who have the turn; begin(view, candidates, entries) before the first round over these stars; and what
/// NearerPasses needs.
template <par::Launcher Launcher, class Elements, class Mover>
class RelaxPasses {
  template <class T>
  using Array = typename Launcher::template Array<T>;

public:
  /// lattice_class: of the first `known` vertices. surface_moves: vertices on the surface do.
  RelaxPasses(Launcher& m, Elements& elements, const uint8_t* lattice_class, int64_t known, bool surface_moves,
              Mover& mover)
      : m_(m), mover_(mover), surface_moves_(surface_moves),
        quality_(m.template array<float>(numbered(elements.view().tets))),
        bound_(m.filled(4 * elements.view().positions, uint8_t{0})), stars_(m) {
    // 13.2° counts like it. Q is held to the least of the paper's improved meshes: raising it is tetsmooth's work.
    constexpr double largest_angle = 159.8, least_q = 0.1;
    const ElementsView e = r_.e = elements.view();
    r_.quality = quality_.data();
    r_.bound = {bound_.data()};
    r_.goal = static_cast<float>(angle_quality(largest_angle));
    r_.shape = shape_weight_of(least_q, angle_quality(largest_angle));
    r_.classes = {lattice_class, known};
    mover_.judge(Qualities{e, r_.classes, r_.shape, r_.quality});
    m.for_n("bounds", e.tris, RaiseBounds{e, r_.bound}, {double(e.tris) * 16});
  }

  /// So many elements, if stars can name them.
  static int64_t numbered(int64_t elements) {
    if (constexpr int64_t most = INT32_MAX; elements > most)
      fail(Status::failed,
           std::to_string(elements) + " elements on both sides, expected " + std::to_string(most) +
               " at most: a coarser spacing or a larger adapt",
           {"adapt"});
    return elements;
  }

  /// How often a vertex moved.
  int64_t run() {
    // Of a surface vertex from the surface, in spacings, if it was nearer: pass by pass, for what is left. Half a
    // spacing is what the surface may be off anywhere.
    constexpr double most_distance[] = {0.03, 0.06, 0.15, 0.3, 0.45};
    constexpr int most_rounds = 100;
    int64_t moved = 0;
    for (const double distance : most_distance) {
      if (!find_candidates())
        break;
      moved += stars_.run_rounds(
          r_, most_rounds,
          [&](const int32_t* active, int round) {
            return StartRound{r_, active, round};
          },
          [&](const int32_t* active, int64_t n, Fate* fate) { mover_.move(r_, active, n, fate, distance); });
    }
    if (surface_moves_)
      moved += NearerPasses<Launcher, Mover>(m_, mover_, r_, stars_).run();
    return moved;
  }

private:
  /// All vertices of bad elements that may move, and their stars. False: there is none.
  bool find_candidates() {
    const ElementsView& e = r_.e;
    // What has changed or is bad is at a candidate of the pass before.
    const bool again = !stars_.empty();
    auto wanted = m_.filled(e.positions, uint8_t{0}), has_new = m_.filled(1, uint8_t{!again});
    const int64_t may_be_bad = again ? stars_.near().n : e.tets;
    m_.for_n("want vertices", (may_be_bad + WantVertices::run - 1) / WantVertices::run,
             WantVertices{e, r_.bound, r_.quality, r_.goal, surface_moves_, again ? stars_.near().data() : nullptr,
                          may_be_bad, again ? stars_.number() : nullptr, wanted.data(), has_new.data()},
             {double(may_be_bad) * 4});
    auto vertex = par::flagged(m_, "candidates", e.positions, wanted.data());
    if (vertex.n == 0)
      return false;
    uint8_t all;
    m_.download(has_new, 1, &all);
    stars_.gather_stars(r_, std::move(vertex), near_elements(m_, e, wanted.data(), all ? nullptr : &stars_.near()));
    mover_.begin(r_, stars_.candidates(), stars_.entries());
    return true;
  }

  Launcher& m_;
  Mover& mover_;
  bool surface_moves_;
  RelaxView r_{};
  Array<float> quality_;
  Array<uint8_t> bound_;
  StarPasses<Launcher> stars_;
};

} // namespace molmesh::contour
