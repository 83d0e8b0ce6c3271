// brick_search.cpp — bounds and evaluates a brick's blocks, then finds its active points.
#include "density/band/brick_search.hpp"
#include "base/galloping_search.hpp"
#include "density/values/classify_simd.hpp"
#include "grid/pack_simd.hpp"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace molmesh::density {
namespace {

/// What G is multiplied with from a point to the next, at most, in all but a few places: near the surface the atoms
/// that matter are 2 Å away.
float usual_step(const Field& f, double h) {
  return static_cast<float>(std::exp(std::min(40.0, 4 * f.decay * f.steepest * h)));
}

/// Blocks of the first of the eight parts of a brick.
constexpr uint64_t part_of_brick = 0x330033;

} // namespace

BrickSearch::BrickSearch(const Field& f, const GridFrame& frame, const SearchOptions& o, const BlockRange& own,
                         const BrickList& bricks)
    : f_(f), frame_(frame), own_(own), bricks_(bricks), full_(o.full), lower_(float_band(o).lower),
      upper_(float_band(o).upper), far_below_(lower_ / usual_step(f, frame.spacing)),
      far_above_(upper_ * usual_step(f, frame.spacing)) {
  if (const double digits = budget_for(o).digits; digits > 0)
    dropped_bits_ = std::clamp(24 + static_cast<int>(std::floor(std::log2(digits))), 0, 20);
}

/// Values of the block at work, not rounded.
void BrickSearch::evaluate(Workspace& w, float* value) const {
  w.evaluator.evaluate(f_, w.block, frame_.spacing, value);
  ++w.counts.blocks_evaluated;
  w.counts.group_visits += w.block.units;
  w.counts.atom_visits += w.block.atoms;
}

void BrickSearch::work_through_block(int b, int octant, Vec3i corner, BrickState& s, Workspace& w) const {
  const uint64_t bit = uint64_t{1} << b;
  ++w.counts.blocks_visited;
  w.block.select(octant, !full_);
  if (w.block.side == Side::inside)
    s.inside |= bit;
  if (w.block.side != Side::mixed)
    return;
  float* const value = w.value[b];
  evaluate(w, value);
  w.points += frame_.points_of_block(8 * corner);
  uint64_t *const below = w.below.word[b], *const above = w.above.word[b];
  classify_points(value, dropped_bits_, {lower_, upper_}, {far_below_, far_above_}, {below, above},
                  {w.far_below.word[b], w.far_above.word[b]});
  const auto all = [](const uint64_t* word) { return std::all_of(word, word + 8, [](uint64_t v) { return !~v; }); };
  if (full_ && (all(below) || all(above))) { // as bounds would have it
    std::fill_n(w.far_below.word[b], 8, every_block);
    std::fill_n(w.far_above.word[b], 8, 0);
    s.inside |= all(above) ? bit : 0;
    return;
  }
  s.known |= bit;
}

uint64_t BrickSearch::wanted(Vec3i brick) const {
  if (own_.meets(brick, brick_blocks))
    return every_block;
  uint64_t blocks = 0;
  for (int b = 0; b < blocks_a_brick; ++b)
    blocks |= uint64_t{own_.meets(brick + block_at(b) - Vec3i{1, 1, 1}, 3)} << b;
  return blocks;
}

void BrickSearch::work_through(const Brick& brick, BrickState& s, Workspace& w) const {
  const uint64_t blocks = wanted(brick.corner);
  const int64_t points = w.points;
  for (BrickWords* const words : {&w.below, &w.far_below})
    std::fill_n(&words->word[0][0], 8 * blocks_a_brick, every_block);
  for (BrickWords* const words : {&w.above, &w.far_above})
    std::fill_n(&words->word[0][0], 8 * blocks_a_brick, 0);
  w.block.enter(middle_of(brick.corner, brick_blocks), bricks_.clusters(brick));
  for (int octant = 0; octant < 8; ++octant) {
    const Vec3i part = 2 * Vec3i{octant >> 2, octant >> 1 & 1, octant & 1};
    if (!in_grid(frame_, brick.corner + part) || !(blocks & part_of_brick << (16 * part.x + 4 * part.y + part.z)) ||
        (!w.block.narrow(middle_of(brick.corner + part, 2), frame_.spacing) && !full_))
      continue;
    for (int i = 0; i < 8; ++i) {
      const Vec3i at = part + Vec3i{i >> 2, i >> 1 & 1, i & 1};
      const int b = 16 * at.x + 4 * at.y + at.z;
      if (in_grid(frame_, brick.corner + at) && blocks >> b & 1)
        work_through_block(b, i, brick.corner + at, s, w);
    }
  }
  settle(s, w);
  if (blocks != every_block) // another tile's, which counts them
    w.points = points;
  need_neighbors(s, w.near_found);
}

/// Sides by rows, where the brick lies on more than one.
void BrickSearch::settle(BrickState& s, Workspace& w) const {
  if (s.known == 0 && (s.inside == 0 || s.inside == every_block))
    return;
  for (int b = 0; b < blocks_a_brick; ++b)
    if (s.inside >> b & 1)
      for (const auto& [below, above] : {std::pair{&w.below, &w.above}, std::pair{&w.far_below, &w.far_above}}) {
        std::fill_n(below->word[b], 8, 0);
        std::fill_n(above->word[b], 8, every_block);
      }
  s.sides = w.spares.sides();
  faced_from_words(w.below, s.sides->below);
  faced_from_words(w.above, s.sides->above);
  if (s.known && own_.meets(s.corner, brick_blocks))
    store(s, w);
}

/// Values of blocks that bounds left out: they have corners of band cells, and lie where the bounds say. Those in
/// `before` have been evaluated once.
void BrickSearch::evaluate_left_out(uint64_t blocks, uint64_t before, Vec3i brick, Workspace& w) const {
  for (int octant = 0; octant < 8; ++octant) {
    const Vec3i part = 2 * Vec3i{octant >> 2, octant >> 1 & 1, octant & 1};
    const auto number = [&](int i) {
      return 16 * (part.x + (i >> 2)) + 4 * (part.y + (i >> 1 & 1)) + part.z + (i & 1);
    };
    bool entered = false;
    for (int i = 0; i < 8; ++i) {
      const int b = number(i);
      if (!(blocks >> b & 1))
        continue;
      if (!entered)
        w.block.narrow(middle_of(brick + part, 2), frame_.spacing);
      entered = true;
      ++w.counts.blocks_visited;
      w.block.select_alone(i);
      evaluate(w, w.value[b]);
      if (!(before >> b & 1))
        w.points += frame_.points_of_block(8 * (brick + block_at(b)));
      round_values(w.value[b], dropped_bits_);
    }
  }
}

const float* BrickSearch::pack(int b, const uint64_t* points, Workspace& w) const {
  float* const to = w.packed().take(512 + 16);
  w.packed().keep(static_cast<size_t>(pack_active(w.value[b], points, to)));
  return to;
}

/// Packs what looks like band while it is at hand: two thirds of the values never leave the processor's cache.
void BrickSearch::store(BrickState& s, Workspace& w) const {
  BrickPoints& to = *s.sides;
  rows_from_words(w.far_below, w.beyond.below);
  rows_from_words(w.far_above, w.beyond.above);
  likely_band_points(to, w.beyond, cells_of(s.corner), w.rows);
  words_from_rows(w.rows, to.stored);
  // Points on the brick's faces aside, of which its neighbors may know better.
  const uint64_t left_out = blocks_of_inner(to.stored) & ~s.known;
  evaluate_left_out(left_out, s.known, s.corner, w);
  s.known |= left_out;
  for (uint64_t left = s.known; left; left &= left - 1) {
    const int b = std::countr_zero(left);
    to.value[b] = pack(b, to.stored.word[b], w);
  }
}

void BrickSearch::need_neighbors(BrickState& s, RowHints& hint) const {
  const unsigned open = open_faces(s);
  for (int n = 0; open && n < 27; n += 3) {
    const Vec3i row = direction(n + 1);
    if ((row.x && !(open >> (row.x > 0) & 1)) || (row.y && !(open >> (2 + (row.y > 0)) & 1)))
      continue;
    const Vec3i first = s.corner + brick_blocks * direction(n);
    auto at = galloping_lower_bound(bricks_.brick.begin(), bricks_.brick.end(), hint[n / 3], first,
                                    [](const Brick& a, Vec3i c) { return a.corner < c; });
    for (int z = -1; z <= 1; ++z) {
      const Vec3i corner = s.corner + brick_blocks * direction(n + z + 1);
      if (at != bricks_.brick.end() && at->corner == corner)
        ++at;
      else if ((z == 0 || open >> (4 + (z > 0)) & 1) && own_.meets(corner, brick_blocks))
        s.needed.push_back(corner);
    }
  }
}

CellRange BrickSearch::cells_of(Vec3i corner) const {
  CellRange c;
  for (int a = 0; a < 3; ++a) {
    const int64_t begin = 8 * int64_t{corner[a]};
    c.first[a] = static_cast<int32_t>(std::max<int64_t>(-1, frame_.lower[a] - begin));
    c.end[a] = static_cast<int32_t>(
        std::min<int64_t>(brick_edge, int64_t{frame_.lower[a]} + frame_.points[a] - 1 - begin));
  }
  return c;
}

/// Active points of a brick among its neighbors. Values stay where they were packed: going through them again, out
/// of the processor's cache, to leave out one in nine would take a tenth of the whole search.
void BrickSearch::finish(BrickState& s, const FacedBits* const* below, const FacedBits* const* above,
                         Workspace& w) const {
  band_points(below, above, cells_of(s.corner), w.rows);
  words_from_rows(w.rows, w.active);
  w.counts.active_points += count_points(w.active);
  words_from_rows(*above[13], w.above);
  s.kept = blocks_of(w.active);
  for (uint64_t left = s.known & ~s.kept; left; left &= left - 1)
    if (const int b = std::countr_zero(left); w.above.word[b][0] & 1)
      s.closed |= uint64_t{1} << b;
  s.closed &= ~s.kept;
  // Blocks that bounds left out, or of which too few values were kept.
  const uint64_t wanting = s.kept & ~(s.known ? s.known & ~blocks_of_rest(w.active, s.sides->stored) : 0);
  if (wanting) {
    w.block.enter(middle_of(s.corner, brick_blocks), bricks_.clusters_at(s.corner));
    evaluate_left_out(wanting, s.known, s.corner, w);
  }
  s.band = w.spares.band();
  s.band.resize(static_cast<size_t>(std::popcount(s.kept)));
  BandBlock* to = s.band.data();
  for (uint64_t left = s.kept; left; left &= left - 1) {
    const int b = std::countr_zero(left);
    const bool again = wanting >> b & 1;
    const uint64_t *const active = w.active.word[b], *const stored = again ? active : s.sides->stored.word[b];
    to->corner = 8 * (s.corner + block_at(b));
    std::memcpy(to->active.data(), active, sizeof(Mask));
    std::memcpy(to->above.data(), w.above.word[b], sizeof(Mask));
    std::memcpy(to->stored.data(), stored, sizeof(Mask));
    to->value = again ? pack(b, active, w) : s.sides->value[b];
    ++to;
  }
}

} // namespace molmesh::density
