// relax_passes.hpp — relaxation in rounds, pass by pass, over a launcher: one text, one result.
#pragma once
#include "contour/detail/passes.hpp"
#include "contour/detail/relax_items.hpp"
#include "contour/detail/star_items.hpp"

namespace molmesh::contour::detail {

/// Mover: judge(qualities) lets that item judge all elements; move(view, active, n, fate, most_distance) lets those
/// move who have the turn; begin(view, candidates, entries) before the first round over these stars.
template <class Launcher, class Mover>
class RelaxPasses {
  template <class T>
  using Array = typename Launcher::template Array<T>;

public:
  /// lattice_class: of the first `known` vertices. surface_moves: vertices on the surface do.
  RelaxPasses(Launcher& m, const ElementsView& e, const uint8_t* lattice_class, int64_t known, bool surface_moves,
              Mover& mover)
      : m_(m), mover_(mover), surface_moves_(surface_moves), quality_(m.template array<float>(e.tets)),
        bound_(m.filled(4 * e.positions, uint8_t{0})) {
    // 13.2° counts like it. Q is held to the least of the paper's improved meshes: raising it is tetsmooth's work.
    constexpr double largest_angle = 159.8, least_q = 0.1;
    r_.e = e;
    r_.quality = quality_.data();
    r_.bound = {bound_.data()};
    r_.goal = static_cast<float>(improve::angle_quality(largest_angle));
    r_.shape = improve::shape_weight_of(least_q, improve::angle_quality(largest_angle));
    mover_.judge(Qualities{e, lattice_class, known, r_.shape, r_.quality});
    m.for_n("bounds", e.tris, RaiseBounds{e, r_.bound}, {double(e.tris) * 16});
  }

  /// How often a vertex moved.
  int64_t run() {
    // Of a surface vertex from the surface, in spacings, if it was nearer: pass by pass, for what is left. Half a
    // spacing is what the surface may be off anywhere.
    constexpr double most_distance[] = {0.03, 0.06, 0.15, 0.3, 0.45};
    constexpr int most_rounds = 100;
    int64_t moved = 0;
    for (const double distance : most_distance) {
      const int64_t candidates = find_candidates();
      if (candidates == 0)
        break;
      for (int round = 0; round < most_rounds; ++round) {
        const auto active = flagged(m_, "active", candidates, r_.wakes);
        if (active.n == 0)
          break;
        move_some(active, round, distance);
      }
      moved += m_.scan("scan", moves_.data(), candidates);
    }
    return moved;
  }

private:
  using Ids = List<Launcher, int32_t>;

  /// All vertices of bad elements that may move, and their stars.
  int64_t find_candidates() {
    const ElementsView& e = r_.e;
    // What has changed or is bad is at a candidate of the pass before.
    const bool again = vertex_.n > 0;
    auto wanted = m_.filled(e.positions, uint8_t{0}), has_new = m_.filled(1, uint8_t{!again});
    const int64_t may_be_bad = again ? near_.n : e.tets;
    m_.for_n("want vertices", (may_be_bad + WantVertices::run - 1) / WantVertices::run,
             WantVertices{e, r_.bound, r_.quality, r_.goal, surface_moves_, again ? near_.data() : nullptr,
                          may_be_bad, again ? number_.data() : nullptr, wanted.data(), has_new.data()},
             {double(may_be_bad) * 4});
    vertex_ = flagged(m_, "candidates", e.positions, wanted.data());
    const int64_t n = vertex_.n;
    if (n == 0)
      return 0;
    number_ = m_.filled(e.positions, int32_t{-1});
    m_.for_n("number candidates", n, NumberCandidates{vertex_.data(), number_.data()}, {double(n) * 8});
    uint8_t all;
    m_.download(has_new, 1, &all);
    near_ = all ? gather<int32_t>(m_, "near elements", e.tets, NearTets{e.tet, wanted.data(), nullptr})
                : gather<int32_t>(m_, "near elements", near_.n, NearTets{e.tet, wanted.data(), near_.data()});
    auto described = m_.template array<NearElement>(near_.n);
    m_.for_n("describe near", near_.n,
             DescribeNear{e.tet, r_.quality, near_.data(), number_.data(), described.data()},
             {double(near_.n) * 60});
    const CornerCandidate of{described.data()};
    Array<int32_t> owner;
    int64_t entries = 0;
    place_by(m_, "stars", 4 * near_.n, n, of, [&](int64_t slots) {
      entries = slots;
      element_ = m_.template array<int32_t>(slots);
      owner = m_.template array<int32_t>(slots);
      return PlaceStars{of, element_.data(), owner.data()};
    });
    first_ = m_.filled(n + 1, entries);
    m_.for_n("first of stars", entries, FirstOfStars{owner.data(), first_.data()}, {double(entries) * 4});
    neighbour_ = m_.template array<int32_t>(3 * entries + n);
    worst_ = m_.template array<float>(n);
    m_.for_n(
        "name stars", n,
        NameStars{first_.data(), near_.data(), described.data(), element_.data(), neighbour_.data(), worst_.data()},
        {double(entries) * 28});
    turn_ = m_.filled(n, RelaxView::at_rest);
    wakes_ = m_.filled(n, uint8_t{1});
    changed_ = m_.filled(n, uint8_t{0});
    moves_ = m_.filled(n + 1, int32_t{0});
    r_.vertex = vertex_.data();
    r_.first = first_.data();
    r_.element = element_.data();
    r_.neighbour = neighbour_.data();
    r_.worst = worst_.data();
    r_.turn = turn_.data();
    r_.wakes = wakes_.data();
    r_.changed = changed_.data();
    r_.moves = moves_.data();
    mover_.begin(r_, n, entries);
    return n;
  }

  void move_some(const Ids& active, int round, double most_distance) {
    const int64_t n = active.n;
    m_.for_n("start round", n, StartRound{r_, active.data(), round}, {double(n) * 120});
    auto fate = m_.template array<Fate>(n);
    m_.for_n("choose first", n, ChooseFirst{r_, active.data(), fate.data()}, {double(n) * 120});
    mover_.move(r_, active.data(), n, fate.data(), most_distance);
    m_.for_n("wake neighbours", n, WakeNeighbours{r_, active.data(), fate.data()}, {double(n) * 17});
  }

  Launcher& m_;
  Mover& mover_;
  bool surface_moves_;
  RelaxView r_{};
  Array<float> quality_;
  Array<uint8_t> bound_;
  Ids vertex_, near_;
  Array<int32_t> number_, element_, neighbour_, moves_;
  Array<int64_t> first_;
  Array<float> worst_;
  Array<uint32_t> turn_;
  Array<uint8_t> wakes_, changed_;
};

} // namespace molmesh::contour::detail
