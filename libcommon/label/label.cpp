// label.cpp — evaluates the tree of sums at each place, from the clusters near its tile of places.
#include "label/label.hpp"
#include "base/error.hpp"
#include "density/culling/kd_tree.hpp"
#include "geom/morton.hpp"
#include "label/reach.hpp"
#include "molecule/bodies.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace molmesh::label {
namespace {

using density::Box;
using density::Field;
using density::KdTree;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// e^-18 of G in one term, or e^-16 in all the clusters left out, is not looked for.
constexpr double small_term = 18, small_clusters = 16;

/// A sum of terms known by their logarithms, and its largest term.
struct Sum {
  int64_t group;
  double ln;          ///< of the sum
  size_t first, last; ///< its terms are [first, last) of the level below
  size_t best;        ///< the largest of them; of an innermost group, that atom in the field
  double top;         ///< ln of that
};

/// The tree of sums at one place. Reused from place to place.
class Place {
public:
  Place(const Field& f, const Reach& reach) : f_(f), reach_(reach), sum_(f.level.size()) {}

  /// ln G from these clusters (ascending).
  double evaluate(Vec3d p, const std::vector<int32_t>& cluster) {
    collect(p, cluster);
    for (Sum& s : sum_[0]) {
      // What a residue is without matters by its share of G, at most e^(Q·ln S - ln G).
      const double range = reach_.bounded() ? small_term + reach_.power(s.group) * s.top - least_ : 2 * small_term;
      add_up(s, std::max(range, 1.0));
    }
    for (size_t l = 1; l < sum_.size(); ++l) {
      sum_[l].clear();
      term_.clear();
      for (const Sum& child : sum_[l - 1]) {
        const int64_t parent = f_.level[l - 1].parent[child.group];
        open(l, parent);
        add_term(l, power(l - 1, child));
      }
      for (Sum& s : sum_[l])
        add_up(s, 2 * small_term);
    }
    term_.clear();
    root_ = {0, 0, 0, 0, 0, -infinity};
    for (const Sum& s : sum_.back()) {
      term_.push_back(power(sum_.size() - 1, s));
      if (term_.back() > root_.top)
        root_.top = term_.back(), root_.best = term_.size() - 1;
    }
    root_.last = term_.size();
    add_up(root_, 2 * small_term);
    return root_.ln;
  }

  /// ln of the shares of all groups of one level; level as in the field. take(group, ln share).
  template <class Take>
  void shares(size_t level, Take take) {
    share_.assign(1, 0);
    std::vector<double> inner;
    for (size_t l = sum_.size(); l-- > level;) {
      inner.assign(sum_[l].size(), -infinity);
      const auto hand_down = [&](const Sum& s, double ln_share) {
        for (size_t c = s.first; c < s.last; ++c)
          inner[c] = ln_share + power(l, sum_[l][c]) - s.ln;
      };
      if (l + 1 == sum_.size())
        hand_down(root_, 0);
      else
        for (size_t p = 0; p < sum_[l + 1].size(); ++p)
          hand_down(sum_[l + 1][p], share_[p]);
      share_.swap(inner);
    }
    for (size_t i = 0; i < share_.size(); ++i)
      take(sum_[level][i].group, share_[i]);
  }

  /// take(level, index, share), level as in the field: innermost groups 0, outermost last; atoms -1.
  template <class Take>
  void descend(Take take) const {
    double ln_share = root_.top - root_.ln;
    size_t at = root_.best;
    for (size_t l = sum_.size(); l-- > 0;) {
      const Sum& s = sum_[l][at];
      take(static_cast<int>(l), s.group, std::exp(ln_share));
      ln_share += s.top - s.ln;
      at = s.best;
    }
    take(-1, f_.source[at], std::exp(ln_share));
  }

private:
  double power(size_t level, const Sum& s) const { return f_.level[level].exponent[s.group] * s.ln; }
  /// The sum of `group`, which comes after those before or is the last of them.
  void open(size_t level, int64_t group) {
    if (sum_[level].empty() || sum_[level].back().group != group)
      sum_[level].push_back({group, 0, term_.size(), term_.size(), term_.size(), -infinity});
  }
  void add_term(size_t level, double ln) {
    Sum& s = sum_[level].back();
    if (ln > s.top)
      s.top = ln, s.best = term_.size();
    term_.push_back(ln);
    s.last = term_.size();
  }

  /// The terms of all atoms that can matter here.
  void collect(Vec3d p, const std::vector<int32_t>& cluster) {
    term_.clear();
    sum_[0].clear();
    least_ = -infinity;
    bound_.clear();
    if (reach_.bounded() && !cluster.empty()) {
      size_t best = 0;
      for (const int32_t c : cluster) {
        const auto s = static_cast<size_t>(c);
        const Core* const core = core_of(s);
        const double d2 = core == nullptr ? distance2({p, p}, f_.box[s]) : core->distance2(p);
        bound_.push_back(reach_.power(f_.group[s]) * (f_.ln_peak[s] - f_.decay * d2));
        if (bound_.back() > bound_[best])
          best = bound_.size() - 1;
      }
      const auto s = static_cast<size_t>(cluster[best]);
      const Core* const core = core_of(s);
      for (auto a = static_cast<size_t>(f_.begin[s]); a < static_cast<size_t>(f_.begin[s + 1]); ++a)
        least_ = std::max(least_, reach_.power(f_.group[s]) * term(core, a, p));
    }
    const double floor = least_ - small_clusters - std::log(static_cast<double>(cluster.size()));
    for (size_t i = 0; i < cluster.size(); ++i) {
      const auto s = static_cast<size_t>(cluster[i]);
      if (!bound_.empty() && bound_[i] < floor)
        continue;
      open(0, f_.group[s]);
      Sum& sum = sum_[0].back();
      const auto begin = static_cast<size_t>(f_.begin[s]), n = static_cast<size_t>(f_.begin[s + 1]) - begin;
      if (sum.first == sum.last)
        sum.best = begin;
      term_.resize(sum.last + n);
      double* const ln = term_.data() + sum.last;
      sum.last += n;
      const Core* const core = core_of(s);
      for (size_t k = 0; k < n; ++k)
        ln[k] = term(core, begin + k, p);
      for (size_t k = 0; k < n; ++k) // atoms do not stand in the order of the file
        if (ln[k] > sum.top || (ln[k] == sum.top && f_.source[begin + k] < f_.source[sum.best]))
          sum.top = ln[k], sum.best = begin + k;
    }
  }
  /// Of the body that a cluster is; null: it is of atoms.
  const Core* core_of(size_t cluster) const {
    const int32_t body = f_.body.empty() ? -1 : f_.body_of(static_cast<int64_t>(cluster));
    return body < 0 ? nullptr : &f_.body[body].core;
  }
  /// ln of the term of atom a, or of the body that it stands for.
  double term(const Core* core, size_t a, Vec3d p) const {
    if (core != nullptr)
      return f_.peak[a] - f_.decay * core->distance2(p);
    const double x = f_.x[a] - p.x, y = f_.y[a] - p.y, z = f_.z[a] - p.z;
    return f_.peak[a] - f_.decay * (x * x + y * y + z * z);
  }

  /// ln of the sum, without terms below the largest by more than `range`.
  void add_up(Sum& s, double range) const {
    if (s.top == -infinity) { // no terms, or all at distances whose squares overflow
      s.ln = -infinity;
      return;
    }
    double sum = 0;
    for (size_t t = s.first; t < s.last; ++t)
      if (term_[t] > s.top - range)
        sum += std::exp(term_[t] - s.top);
    s.ln = s.top + std::log(sum);
  }

  const Field& f_;
  const Reach& reach_;
  std::vector<std::vector<Sum>> sum_; ///< by level, innermost first
  Sum root_{};
  std::vector<double> term_;  ///< of the level in work
  std::vector<double> bound_; ///< [clusters] Q·ln of the largest its sum can be
  std::vector<double> share_; ///< [groups of a level] ln
  double least_ = 0;          ///< ln G is not below this
};

/// Places in cubes of a few Å, in Morton order.
struct Tiles {
  std::vector<std::pair<uint64_t, int64_t>> item; ///< key, place
  std::vector<int64_t> begin;                     ///< [tiles + 1]
};

Tiles make_tiles(const std::vector<Vec3d>& place, int threads) {
  constexpr double edge = 3; // Å: some hundred places on a grid of 0.5 Å
  Vec3d lo = place.front(), hi = lo;
  for (const Vec3d& p : place)
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::min(lo[a], p[a]);
      hi[a] = std::max(hi[a], p[a]);
    }
  double size = edge;
  for (int a = 0; a < 3; ++a)
    size = std::max(size, (hi[a] - lo[a]) / (1 << 20));
  Tiles t;
  t.item.resize(place.size());
  par::for_n(static_cast<int64_t>(place.size()), threads, [&](int64_t i) {
    const Vec3d v = (place[i] - lo) / size;
    t.item[i] = {morton(Vec3i{static_cast<int32_t>(v.x), static_cast<int32_t>(v.y), static_cast<int32_t>(v.z)}), i};
  });
  par::sort(t.item, threads);
  for (size_t i = 0; i < t.item.size(); ++i)
    if (i == 0 || t.item[i].first != t.item[i - 1].first)
      t.begin.push_back(static_cast<int64_t>(i));
  t.begin.push_back(static_cast<int64_t>(t.item.size()));
  return t;
}

/// The field of a hierarchy, to be asked at places.
struct Evaluator {
  Field f;
  double enough; ///< ln: where G is less, what was left out may be felt
  KdTree tree{f};
  Reach reach{f};

  Evaluator(const Hierarchy& h, const Options& o)
      : f(density::make_field(h, o.decay, 1e-8 * o.isovalue)), enough(std::log(1e7 * f.far_error)) {}

  /// take(i, at, ln G) at place i, from any thread.
  template <class Take>
  void for_places(const std::vector<Vec3d>& place, int threads, Take take) const {
    if (place.empty())
      return;
    const Tiles tiles = make_tiles(place, threads);
    par::for_n(static_cast<int64_t>(tiles.begin.size()) - 1, threads, 1, [&](int64_t t) {
      const auto begin = static_cast<size_t>(tiles.begin[t]),
                 end = static_cast<size_t>(tiles.begin[static_cast<size_t>(t) + 1]);
      Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
      for (size_t i = begin; i < end; ++i)
        for (int a = 0; a < 3; ++a) {
          const double v = place[tiles.item[i].second][a];
          box.lo[a] = std::min(box.lo[a], v);
          box.hi[a] = std::max(box.hi[a], v);
        }
      const std::vector<int32_t> near = tree.near(box);
      std::vector<int32_t> far;
      Place at(f, reach);
      for (size_t i = begin; i < end; ++i) {
        const auto p = static_cast<size_t>(tiles.item[i].second);
        double ln = at.evaluate(place[p], near);
        if (!(ln >= enough)) {
          if (far.empty())
            far = reach.matter(box);
          ln = at.evaluate(place[p], far);
        }
        take(p, at, ln);
      }
    });
  }
};

} // namespace

Labels find_labels(const Hierarchy& h, const std::vector<Vec3d>& place, const Options& options) {
  if (h.atom.size() > static_cast<size_t>(std::numeric_limits<int32_t>::max()))
    fail_input("over 2^31 - 1 atoms, expected fewer");
  if (!all_have_bodies(h)) {
    const Bodies bodies = bodies_of(h);
    Labels labels = find_labels(bodies.hierarchy, place, options);
    for (size_t l = 0; l < labels.index.size(); ++l)
      for (int32_t& index : labels.index[l])
        index = index < 0 ? index : static_cast<int32_t>(bodies.index[l][index]);
    return labels;
  }
  Labels labels;
  for (const Level& l : h.level)
    labels.level.push_back(l.name);
  labels.level.push_back("atom");
  const size_t levels = labels.level.size();
  labels.index.assign(levels, std::vector<int32_t>(place.size()));
  labels.share.assign(levels, std::vector<double>(place.size()));
  labels.ln_field.resize(place.size());
  if (place.empty())
    return labels;

  Evaluator(h, options).for_places(place, options.threads, [&](size_t p, const Place& at, double ln) {
    labels.ln_field[p] = ln;
    if (!(ln > -infinity)) {
      for (size_t l = 0; l < levels; ++l)
        labels.index[l][p] = -1;
      return;
    }
    at.descend([&](int level, int64_t index, double share) {
      const size_t l = levels - 2 - static_cast<size_t>(level); // atoms: levels - 1
      if (l >= levels)
        return; // the field's one group of a hierarchy without levels
      labels.index[l][p] = static_cast<int32_t>(index);
      labels.share[l][p] = share;
    });
  });
  return labels;
}

struct ShareFinder::Impl {
  Evaluator field;
  size_t level;               ///< as in the field
  std::vector<int64_t> group; ///< [group of the field] that group's index; empty: the same

  Impl(const Hierarchy& h, size_t l, const Options& o) : field(h, o), level(h.level.size() - 1 - l) {}
  Impl(const Bodies& b, size_t l, const Options& o) : Impl(b.hierarchy, l, o) { group = b.index[l]; }
};

ShareFinder::ShareFinder(const Hierarchy& h, size_t level, const Options& options)
    : options_(options),
      impl_(all_have_bodies(h) ? new Impl(h, level, options) : new Impl(bodies_of(h), level, options)) {}
ShareFinder::~ShareFinder() = default;

std::vector<Shares> ShareFinder::at(const std::vector<Vec3d>& place) const {
  std::vector<Shares> all(place.size());
  impl_->field.for_places(place, options_.threads, [&](size_t p, Place& at, double ln) {
    Shares& s = all[p];
    s.ln_field = ln;
    if (!(ln > -infinity))
      return;
    at.shares(impl_->level, [&](int64_t g, double share) {
      const int64_t group = impl_->group.empty() ? g : impl_->group[g];
      for (size_t k = 0; k < Shares::most; ++k)
        if (share > s.ln[k]) {
          for (size_t i = Shares::most - 1; i > k; --i)
            s.ln[i] = s.ln[i - 1], s.group[i] = s.group[i - 1];
          s.ln[k] = share;
          s.group[k] = static_cast<int32_t>(group);
          return;
        }
    });
  });
  return all;
}

} // namespace molmesh::label
