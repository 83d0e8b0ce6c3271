// block_evaluation.hpp — evaluates G on the points of blocks: sums by products of one factor per axis or, where
// single precision does not hold, sums of logarithms in double.
#pragma once
#include "cuda/density/block_bounds.hpp"
#include "cuda/density/block_key.hpp"
#include "cuda/density/log_sum.hpp"
#include "cuda/density/near_clusters.hpp"

namespace molmesh::cuda {

/// The clusters that count in a block: those within their cutoff but for some of small effect, which together
/// change G by at most `budget` (field.md §2). Dropped are clusters whose effect is at most one of a few
/// thresholds: the largest that the budget allows. (S + v)^P - S^P ≤ v^P for P ≤ 1, with v bounded over the block.
struct BlockClusters {
  NearClusters near;
  bool drop; ///< everything above the innermost level is a plain sum
  double budget;
  const Key* key;

  MOLMESH_HD float effect(int32_t c, Vec3d middle, Vec3d half) const {
    const FieldView& f = near.f;
    const double p = f.exponent[0][f.group[c]];
    if (p > 1)
      return HUGE_VALF;
    LogSum<float, false> sum;
    for (int64_t a = f.begin[c]; a < f.begin[c + 1]; ++a) {
      const double d2 =
          beyond2(f.x[a], middle.x, half.x) + beyond2(f.y[a], middle.y, half.y) + beyond2(f.z[a], middle.z, half.z);
      sum.add(f.peak[a] - f.decay * d2);
    }
    return std::exp(float(p * sum.ln()));
  }
  static constexpr int thresholds = 6;
  MOLMESH_HD float threshold(int k) const {
    const float share[thresholds] = {0.4f, 0.2f, 0.08f, 0.03f, 0.01f, 0.003f};
    return k < thresholds ? share[k] * float(budget) : -1;
  }
  struct NoneShared {};
  /// see(c, whether c is near, its effect) round block i, as NearClusters::for_each has it. Effects are asked for
  /// where `weigh`.
  template <class Team, class See>
  MOLMESH_HD void for_each(int64_t i, Team team, bool weigh, See&& see) const {
    const Vec3i block = BlockFrame::block(key[i]);
    const Box box = near.frame.box(block, 1);
    const Vec3d middle = 0.5 * (box.lo + box.hi), half = 0.5 * (box.hi - box.lo);
    near.for_each(block, box, team, [&](int32_t c, bool is_near) {
      see(c, is_near, is_near && weigh ? effect(c, middle, half) : 0);
    });
  }
};

/// Sets least[i]: clusters of less effect are dropped.
struct ChooseLeast {
  BlockClusters in;
  float* least;

  using Shared = BlockClusters::NoneShared;
  template <class Team>
  MOLMESH_HD void operator()(int64_t i, Team team, Shared&) const {
    float total[BlockClusters::thresholds] = {};
    if (in.drop)
      in.for_each(i, team, true, [&](int32_t, bool is_near, float e) {
        for (int k = 0; k < BlockClusters::thresholds; ++k)
          total[k] += is_near && e <= in.threshold(k) ? e : 0;
      });
    int k = 0;
    while (in.drop && k < BlockClusters::thresholds && team.sum(total[k]) * 1.001f > float(in.budget))
      ++k;
    if (team.rank() == 0)
      least[i] = in.threshold(k);
  }
};

/// Without a list: begin[i], how many, and atoms[i], the work they are. With one: list[begin[i] …] in ascending
/// order. One kernel, so that both decide alike however a product and a sum are rounded.
struct ListClusters {
  BlockClusters in;
  const float* least;
  int64_t* begin;
  uint32_t* atoms;
  int32_t* list;

  using Shared = BlockClusters::NoneShared;
  template <class Team>
  MOLMESH_HD void operator()(int64_t i, Team team, Shared&) const {
    int32_t* const to = list ? list + begin[i] : nullptr;
    int64_t n = 0;
    int32_t sum = 0;
    in.for_each(i, team, in.drop, [&](int32_t c, bool is_near, float e) {
      const bool kept = is_near && (!in.drop || e > least[i]);
      int all;
      const int before = team.before(kept, all);
      if (to && kept)
        to[n + before] = c;
      n += all;
      sum += kept ? int32_t(in.near.f.begin[c + 1] - in.near.f.begin[c]) : 0;
    });
    if (to)
      return;
    sum = team.sum(sum);
    if (team.rank() != 0)
      return;
    begin[i] = n;
    atoms[i] = uint32_t(sum);
  }
};

/// A sum of any number of terms that is as good as a few terms' (Kahan's).
struct LongSum {
  float sum = 0, excess = 0; ///< of sum over what it stands for
  MOLMESH_HD void add(float term) {
    const float t = term - excess, next = sum + t;
    excess = (next - sum) - t;
    sum = next;
  }
};

/// In single precision, when everything above the innermost level is a plain sum: value[512·b + 64·i + 8·j + k] of
/// block b = order[n]. A term is a product of three factors, the atom's peak in the first, the others at most 1;
/// terms of which some underflow are those that may be dropped, and nothing overflows (single_holds).
struct EvaluateBlock {
  FieldView f;
  BlockFrame frame;
  const Key* key;
  const uint32_t* order;
  const int64_t* begin; ///< [blocks + 1]
  const int32_t* list;
  float* value;

  struct Shared {
    float factor[density::Field::cluster_size][24]; ///< of an atom: 8 for x, 8 for y, 8 for z
  };

  template <class Team>
  MOLMESH_HD void operator()(int64_t n, Team team, Shared& s) const {
    constexpr int columns = 64 / Team::size; // of eight points along x, per thread
    const int64_t b = order[n];
    const Vec3d low = frame.grid.position(frame.corner(BlockFrame::block(key[b])));
    const double h = frame.grid.spacing;
    constexpr double log2e = 1.4426950408889634;
    const float decay = float(log2e * f.decay);
    LongSum total[columns][8], sum[columns][8];
    const auto close = [&](int64_t group) {
      const float p = float(f.exponent[0][group]);
      for (int c = 0; c < columns; ++c)
        for (int i = 0; i < 8; ++i) {
          const float t = sum[c][i].sum;
          total[c][i].add(p == 1 ? t : p == 0.5f ? std::sqrt(t) : t > 0 ? std::exp2(p * std::log2(t)) : 0.0f);
          sum[c][i] = {};
        }
    };
    int64_t open = -1;
    for (int64_t l = begin[b]; l < begin[b + 1]; ++l) {
      const int32_t c = list[l];
      if (open >= 0 && f.group[c] != open)
        close(open);
      open = f.group[c];
      const int64_t first = f.begin[c];
      const int atoms = int(f.begin[c + 1] - first);
      team.sync(); // the factors of the cluster before are no longer read
      for (int k = team.rank(); k < 24 * atoms; k += Team::size) {
        const int a = k / 24, axis = k % 24 / 8;
        const double at = axis == 0 ? f.x[first + a] : axis == 1 ? f.y[first + a] : f.z[first + a];
        const float d = float(low[axis] + (k % 8) * h - at);
        s.factor[a][k % 24] = std::exp2((axis == 0 ? float(log2e * f.peak[first + a]) : 0.0f) - decay * d * d);
      }
      team.sync();
      for (int col = 0; col < columns; ++col) {
        const int jk = col * Team::size + team.rank();
        float part[8] = {};
        for (int a = 0; a < atoms; ++a) {
          const float* const x = s.factor[a];
          const float yz = x[8 + jk / 8] * x[16 + jk % 8];
          for (int i = 0; i < 8; ++i)
            part[i] += x[i] * yz;
        }
        for (int i = 0; i < 8; ++i)
          sum[col][i].add(part[i]);
      }
    }
    if (open >= 0)
      close(open);
    for (int col = 0; col < columns; ++col)
      for (int i = 0; i < 8; ++i)
        value[512 * b + 64 * i + col * Team::size + team.rank()] = total[col][i].sum;
  }
};

/// In double precision and logarithms, for any exponents: point i % 512 of block order[i / 512].
struct EvaluatePoint {
  FieldView f;
  BlockFrame frame;
  const Key* key;
  const uint32_t* order;
  const int64_t* begin;
  const int32_t* list;
  float* value;

  MOLMESH_HD void operator()(int64_t i) const {
    const int64_t b = order[i / 512];
    const int s = int(i % 512);
    const Vec3d p = frame.grid.position(frame.corner(BlockFrame::block(key[b])) + within_block(s));
    OpenLevels<LogSum<double, false>> levels(f);
    for (int64_t l = begin[b]; l < begin[b + 1]; ++l) {
      const int32_t c = list[l];
      LogSum<double, false>& sum = levels.enter(f.group[c]);
      for (int64_t a = f.begin[c]; a < f.begin[c + 1]; ++a)
        sum.add(f.peak[a] - f.decay * norm2(Vec3d{f.x[a], f.y[a], f.z[a]} - p));
    }
    value[512 * b + s] = float(std::exp(levels.finish().ln()));
  }
};

/// Bits of the points below and above the band: word i % 8 of block i / 8 in mask[16·b + …], below first.
struct PointMasks {
  float lower, upper;
  const float* value;
  uint64_t* mask;

  MOLMESH_HD void operator()(int64_t i) const {
    uint64_t below = 0, above = 0;
    for (int s = 0; s < 64; ++s) {
      const float v = value[64 * i + s];
      below |= uint64_t{v < lower} << s;
      above |= uint64_t{v > upper} << s;
    }
    mask[16 * (i / 8) + i % 8] = below;
    mask[16 * (i / 8) + 8 + i % 8] = above;
  }
};

} // namespace molmesh::cuda
