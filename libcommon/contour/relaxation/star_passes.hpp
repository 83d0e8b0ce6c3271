// star_passes.hpp — the elements round the vertices that may move, and rounds in which vertices without common
// elements move; pass by pass, over a launcher.
#pragma once
#include "contour/relaxation/relax_items.hpp"
#include "contour/relaxation/star_items.hpp"
#include "par/passes.hpp"
#include <utility>

namespace molmesh::contour {

/// Elements at a wanted vertex; among: null: of all.
template <par::Launcher Launcher>
par::List<Launcher, int32_t> near_elements(Launcher& m, const ElementsView& e, const uint8_t* wanted,
                                           const par::List<Launcher, int32_t>* among) {
  return par::gather<int32_t>(m, "near elements", among ? among->n : e.tets,
                              NearTets{e.tet, wanted, among ? among->data() : nullptr});
}

/// The entries of each candidate in order, those of candidate c from first[c] on, by Place{of, entry, owner}; of:
/// the candidate of a corner, -1: none. Returns how many there are.
template <class Place, par::Launcher Launcher, class Of, class Entries, class Firsts>
int64_t place_stars(Launcher& m, const char* name, int64_t corners, int64_t candidates, const Of& of,
                    Entries& entry, Firsts& first) {
  Entries owner;
  int64_t entries = 0;
  par::place_by(m, name, corners, candidates, of, [&](int64_t slots) {
    entries = slots;
    entry = m.template array<int32_t>(slots);
    owner = m.template array<int32_t>(slots);
    return Place{of, entry.data(), owner.data()};
  });
  first = m.filled(candidates + 1, entries);
  m.for_n("first of stars", entries, FirstOfStars{owner.data(), first.data()}, {double(entries) * 4});
  return entries;
}

template <par::Launcher Launcher>
class StarPasses {
  template <class T>
  using Array = typename Launcher::template Array<T>;

public:
  using Ids = par::List<Launcher, int32_t>;

  explicit StarPasses(Launcher& m) : m_(m) {}

  /// Of the candidates `vertex`, ascending; near: all elements at them.
  void gather_stars(RelaxView& r, Ids vertex, Ids near) {
    if (number_.size() == 0) // at first
      number_ = m_.filled(r.e.positions, int32_t{-1});
    else
      m_.for_n("forget candidates", vertex_.n, ForgetCandidates{vertex_.data(), number_.data()});
    vertex_ = std::move(vertex);
    near_ = std::move(near);
    const int64_t n = vertex_.n;
    m_.for_n("number candidates", n, NumberCandidates{vertex_.data(), number_.data()}, {double(n) * 8});
    auto described = m_.template array<NearElement>(near_.n);
    m_.for_n("describe near", near_.n,
             DescribeNear{r.e.tet, r.quality, near_.data(), number_.data(), described.data()},
             {double(near_.n) * 60});
    const CornerCandidate of{described.data()};
    entries_ = place_stars<PlaceStars>(m_, "stars", 4 * near_.n, n, of, element_, first_);
    neighbour_ = m_.template array<int32_t>(3 * entries_ + n);
    worst_ = m_.template array<float>(n);
    m_.for_n("list neighbours", n,
             ListNeighbours{first_.data(), near_.data(), described.data(), element_.data(), neighbour_.data(),
                            worst_.data()},
             {double(entries_) * 28});
    turn_ = m_.filled(n, RelaxView::at_rest);
    wakes_ = m_.filled(n, uint8_t{1});
    changed_ = m_.filled(n, uint8_t{0});
    moves_ = m_.filled(n + 1, int32_t{0});
    r.vertex = vertex_.data();
    r.first = first_.data();
    r.element = element_.data();
    r.neighbour = neighbour_.data();
    r.worst = worst_.data();
    r.turn = turn_.data();
    r.wakes = wakes_.data();
    r.changed = changed_.data();
    r.moves = moves_.data();
  }

  /// Start: item that says whose turn it is, made of (active, round); move(active, n, fate) lets those move who
  /// have it. Returns how often a candidate moved.
  template <class Start, class Move>
  int64_t run_rounds(const RelaxView& r, int most_rounds, Start start, Move move) {
    for (int round = 0; round < most_rounds; ++round) {
      const auto active = par::flagged(m_, "active", vertex_.n, r.wakes);
      const int64_t n = active.n;
      if (n == 0)
        break;
      m_.for_n("start round", n, start(active.data(), round), {double(n) * 120});
      auto fate = m_.template array<Fate>(n);
      m_.for_n("choose first", n, ChooseFirst{r, active.data(), fate.data()}, {double(n) * 120});
      move(active.data(), n, fate.data());
      m_.for_n("wake neighbours", n, WakeNeighbours{r, active.data(), fate.data()}, {double(n) * 17});
    }
    return m_.scan("scan", moves_.data(), vertex_.n);
  }

  bool empty() const { return vertex_.n == 0; }
  const Ids& near() const { return near_; }                ///< all elements at candidates
  const int32_t* number() const { return number_.data(); } ///< [vertices] of the candidates, else -1
  int64_t candidates() const { return vertex_.n; }
  int64_t entries() const { return entries_; } ///< of all stars

private:
  Launcher& m_;
  Ids vertex_, near_;
  int64_t entries_ = 0;
  Array<int32_t> number_, element_, neighbour_, moves_;
  Array<int64_t> first_;
  Array<float> worst_;
  Array<uint32_t> turn_;
  Array<uint8_t> wakes_, changed_;
};

} // namespace molmesh::contour
