// field.cpp — divides atoms into clusters and flattens the hierarchy.
#include "density/field/field.hpp"
#include "base/error.hpp"
#include "density/field/cutoff.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

namespace molmesh::density {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr double widest = 64; // Å; a wider cluster would be near everything in between

/// Splits atoms [begin, end) of `order` at the median of their longest axis until every piece is a cluster.
void split(const Hierarchy& h, LargeArray<int64_t>& order, int64_t begin, int64_t end, std::vector<int64_t>& cuts) {
  Vec3d lo{infinity, infinity, infinity}, hi = -lo;
  for (int64_t i = begin; i < end; ++i)
    for (int a = 0; a < 3; ++a) {
      const double c = h.atom[order[i]].center[a];
      lo[a] = std::min(lo[a], c);
      hi[a] = std::max(hi[a], c);
    }
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (hi[a] - lo[a] > hi[axis] - lo[axis])
      axis = a;
  if (end - begin <= Field::cluster_size && hi[axis] - lo[axis] <= widest) {
    cuts.push_back(begin);
    return;
  }
  const int64_t middle = begin + (end - begin) / 2;
  std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, [&](int64_t a, int64_t b) {
    const double ca = h.atom[a].center[axis], cb = h.atom[b].center[axis];
    return ca != cb ? ca < cb : a < b;
  });
  split(h, order, begin, middle, cuts);
  split(h, order, middle, end, cuts);
}

void add_levels(Field& f, const Hierarchy& h) {
  if (h.level.empty()) {
    f.level.push_back({{1.0}, {}});
    return;
  }
  for (size_t l = h.level.size(); l-- > 0;) {
    FieldLevel level;
    for (const Group& g : h.level[l].group)
      level.exponent.push_back(g.exponent);
    if (l > 0) {
      level.parent.resize(level.exponent.size());
      for (size_t p = 0; p < h.level[l - 1].group.size(); ++p)
        for (int64_t c = h.level[l - 1].group[p].begin; c < h.level[l - 1].group[p].end; ++c)
          level.parent[c] = static_cast<int64_t>(p);
    }
    f.level.push_back(std::move(level));
  }
}

/// ln of the factor on the terms of each innermost group's atoms that does what the weights of its groups do:
/// W (w S)^P = (W^(1/P) w S)^P. Empty without weights.
std::vector<double> ln_weights(const Hierarchy& h) {
  const auto weighted = [](const Level& l) {
    return std::any_of(l.group.begin(), l.group.end(), [](const Group& g) { return g.weight != 1; });
  };
  std::vector<double> outer, ln;
  if (std::none_of(h.level.begin(), h.level.end(), weighted))
    return ln;
  for (size_t l = 0; l < h.level.size(); ++l) {
    const std::vector<Group>& group = h.level[l].group;
    ln.assign(group.size(), 0);
    for (size_t p = 0; p < outer.size(); ++p)
      for (int64_t c = h.level[l - 1].group[p].begin; c < h.level[l - 1].group[p].end; ++c)
        ln[c] = outer[p] / group[c].exponent;
    for (size_t g = 0; g < group.size(); ++g) {
      ln[g] += std::log(group[g].weight);
      if (!(std::abs(ln[g]) < 1e8)) {
        char text[160];
        std::snprintf(text, sizeof text,
                      "a group's weight counts e^%g for each of its atoms, expected less than e^1e8 and more than "
                      "its inverse: a larger exponent",
                      ln[g]);
        fail(Status::usage, text);
      }
    }
    outer = ln;
  }
  return ln;
}

/// exp() with a small cache: atoms have few radii, so the arguments repeat.
class FewExponentials {
public:
  double operator()(double x) {
    const auto bits = std::bit_cast<uint64_t>(x);
    auto& [key, value] = kept_[bits * 0x9e3779b97f4a7c15 >> 58];
    if (key != bits) {
      key = bits;
      value = std::exp(x);
    }
    return value;
  }

private:
  struct Pair {
    uint64_t key = 0; ///< of 0
    double value = 1;
  };
  std::array<Pair, 64> kept_ = {};
};

/// Box and ln_peak of cluster c.
void measure_cluster(Field& f, size_t c, FewExponentials& exp) {
  const auto begin = static_cast<size_t>(f.begin[c]), end = static_cast<size_t>(f.begin[c + 1]);
  Box b{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  double largest = -infinity, sum = 0;
  for (size_t a = begin; a < end; ++a) {
    b.lo = {std::min(b.lo.x, f.x[a]), std::min(b.lo.y, f.y[a]), std::min(b.lo.z, f.z[a])};
    b.hi = {std::max(b.hi.x, f.x[a]), std::max(b.hi.y, f.y[a]), std::max(b.hi.z, f.z[a])};
    largest = std::max(largest, f.peak[a]);
  }
  for (size_t a = begin; a < end; ++a)
    sum += exp(f.peak[a] - largest);
  if (const int32_t body = f.body_of(static_cast<int64_t>(c)); body >= 0)
    b = {f.body[static_cast<size_t>(body)].core.low(), f.body[static_cast<size_t>(body)].core.high()};
  f.box[c] = b;
  f.ln_peak[c] = largest < infinity ? largest + std::log(sum) : largest;
}

/// The body that this atom stands for, or the end.
std::vector<Body>::const_iterator body_at(const Hierarchy& h, int64_t atom) {
  const auto found =
      std::lower_bound(h.body.begin(), h.body.end(), atom, [](const Body& b, int64_t a) { return b.atom < a; });
  return found != h.body.end() && found->atom == atom ? found : h.body.end();
}

/// Puts the bodies among atoms [begin, end) of `order` behind the others. Returns how many there are.
int64_t bodies_last(const Hierarchy& h, LargeArray<int64_t>& order, int64_t begin, int64_t end) {
  if (h.body.empty())
    return 0;
  const auto first = std::stable_partition(order.begin() + begin, order.begin() + end,
                                           [&](int64_t a) { return body_at(h, a) == h.body.end(); });
  return order.begin() + end - first;
}

void add_clusters(Field& f, const Hierarchy& h, int threads) {
  const auto n = static_cast<int64_t>(h.atom.size());
  LargeArray<int64_t> order(h.atom.size());
  for (LargeArray<double>* v : {&f.x, &f.y, &f.z, &f.peak})
    v->resize(order.size());
  const std::vector<Group> all{{"", 1, 0, n}}, &innermost = h.level.empty() ? all : h.level.back().group;
  const auto groups = static_cast<int64_t>(innermost.size());
  struct Piece {
    std::vector<int64_t> cuts, group;
    std::vector<size_t> bodies; ///< positions in `cuts`
  };
  const std::vector<double> ln_weight = ln_weights(h);
  constexpr int64_t grain = 256; // groups
  std::vector<Piece> piece(static_cast<size_t>((groups + grain - 1) / grain));
  par::for_n(static_cast<int64_t>(piece.size()), threads, 1, [&](int64_t p) {
    auto& [cuts, group, bodies] = piece[p];
    for (int64_t g = p * grain; g < std::min(groups, (p + 1) * grain); ++g) {
      const auto begin = innermost[g].begin, end = innermost[g].end;
      std::iota(order.begin() + begin, order.begin() + end, begin);
      const int64_t last_atom = end - bodies_last(h, order, begin, end);
      if (last_atom > begin)
        split(h, order, begin, last_atom, cuts);
      for (int64_t b = last_atom; b < end; ++b) {
        bodies.push_back(cuts.size());
        cuts.push_back(b);
      }
      group.resize(cuts.size(), g);
      const double ln_factor = ln_weight.empty() ? 0 : ln_weight[g];
      for (auto a = static_cast<size_t>(begin); a < static_cast<size_t>(end); ++a) {
        const Atom& atom = h.atom[order[a]];
        f.x[a] = atom.center.x;
        f.y[a] = atom.center.y;
        f.z[a] = atom.center.z;
        f.peak[a] = f.decay * atom.radius * atom.radius + ln_factor;
      }
    }
  });
  for (const Piece& p : piece) {
    for (const size_t b : p.bodies)
      f.body.push_back({static_cast<int64_t>(f.begin.size() + b), Core(*body_at(h, order[p.cuts[b]]))});
    f.begin.insert(f.begin.end(), p.cuts.begin(), p.cuts.end());
    f.group.insert(f.group.end(), p.group.begin(), p.group.end());
  }
  f.begin.push_back(n);
  f.source = std::move(order);
  f.box.resize(f.group.size());
  f.ln_peak.resize(f.group.size());
  const int64_t n_clusters = f.clusters(), at_once = 1024;
  par::for_n((n_clusters + at_once - 1) / at_once, threads, 1, [&](int64_t part) {
    FewExponentials exp;
    for (int64_t c = part * at_once; c < std::min(n_clusters, (part + 1) * at_once); ++c)
      measure_cluster(f, static_cast<size_t>(c), exp);
  });
}

/// Field::ln_highest: from the largest term, the largest exponents and the number of groups where that suffices.
double highest_logarithm(const Field& f) {
  double top = *std::max_element(f.ln_peak.begin(), f.ln_peak.end()) + std::log(double(f.clusters())),
         highest = std::max(top, 0.0);
  for (const FieldLevel& l : f.level) {
    top = std::max(top, 0.0) * *std::max_element(l.exponent.begin(), l.exponent.end()) +
          std::log(double(l.exponent.size()));
    highest = std::max(highest, top);
  }
  if (highest <= Field::single_ln)
    return highest;
  const std::vector<std::vector<double>> largest = largest_sums(f);
  highest = largest.back()[0];
  for (size_t l = 0; l < f.level.size(); ++l)
    for (size_t g = 0; g < largest[l].size(); ++g)
      highest = std::max(highest, std::max(1.0, f.level[l].exponent[g]) * largest[l][g]);
  return highest;
}

void set_extremes(Field& f) {
  f.all_atoms = f.atoms();
  for (size_t c = 0; c < f.group.size(); ++c) {
    const double p = f.level[0].exponent[f.group[c]];
    f.least_power = std::min(f.least_power, p * (f.ln_peak[c] - f.decay * f.cutoff2[c]));
    f.largest_peak = std::max(f.largest_peak, f.ln_peak[c]);
    f.farthest_cutoff = std::max(f.farthest_cutoff, std::sqrt(f.cutoff2[c]));
  }
}

double steepest_path(const Field& f) {
  std::vector<double> outer{1.0}, path;
  for (size_t l = f.level.size(); l-- > 0;) {
    path = f.level[l].exponent;
    if (l + 1 < f.level.size())
      for (size_t g = 0; g < path.size(); ++g)
        path[g] *= outer[f.level[l].parent[g]];
    outer = path;
  }
  return *std::max_element(path.begin(), path.end());
}

} // namespace

double log_add(double a, double b) {
  const double m = std::max(a, b);
  return m == -infinity ? m : m + std::log1p(std::exp(std::min(a, b) - m));
}

int32_t Field::body_of(int64_t cluster) const {
  const auto found = std::lower_bound(body.begin(), body.end(), cluster,
                                      [](const FieldBody& b, int64_t c) { return b.cluster < c; });
  return found != body.end() && found->cluster == cluster ? static_cast<int32_t>(found - body.begin()) : -1;
}

Box Field::bounds() const {
  Box b = box.front();
  for (const Box& c : box)
    for (int a = 0; a < 3; ++a) {
      b.lo[a] = std::min(b.lo[a], c.lo[a]);
      b.hi[a] = std::max(b.hi[a], c.hi[a]);
    }
  return b;
}

Field make_field(const Hierarchy& h, double decay, double far_error, int threads) {
  Field f;
  f.decay = decay;
  f.far_error = far_error;
  add_levels(f, h);
  add_clusters(f, h, threads);
  f.steepest = steepest_path(f);
  f.ln_highest = highest_logarithm(f);
  if (!(f.ln_highest < 1e8)) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "the field's logarithm reaches %g, expected less than 1e8: a smaller decay, radius or exponent",
                  f.ln_highest);
    fail(Status::usage, text, {"decay"});
  }
  for (size_t l = 1; l < f.level.size(); ++l)
    for (const double p : f.level[l].exponent)
      f.plain_above = f.plain_above && p == 1;
  set_cutoffs(f);
  set_extremes(f);
  return f;
}

void keep_near(Field& f, const Box& box) {
  size_t clusters = 0;
  int64_t atoms = 0;
  std::vector<FieldBody> bodies;
  for (size_t c = 0; c < f.group.size(); ++c) { // places that are read are not yet written over
    if (!(distance2(box, f.box[c]) < f.cutoff2[c]))
      continue;
    if (const int32_t body = f.body_of(static_cast<int64_t>(c)); body >= 0)
      bodies.push_back({static_cast<int64_t>(clusters), f.body[static_cast<size_t>(body)].core});
    const int64_t first = atoms;
    for (int64_t a = f.begin[c]; a < f.begin[c + 1]; ++a, ++atoms) {
      for (LargeArray<double>* v : {&f.x, &f.y, &f.z, &f.peak})
        (*v)[atoms] = (*v)[a];
      f.source[atoms] = f.source[a];
    }
    f.begin[clusters] = first;
    f.group[clusters] = f.group[c];
    f.box[clusters] = f.box[c];
    f.ln_peak[clusters] = f.ln_peak[c];
    f.cutoff2[clusters] = f.cutoff2[c];
    ++clusters;
  }
  f.begin.resize(clusters + 1);
  f.begin[clusters] = atoms;
  const auto shrink = [](auto& v, size_t n) {
    v.resize(n);
    v.shrink_to_fit();
  };
  for (LargeArray<double>* v : {&f.x, &f.y, &f.z, &f.peak})
    shrink(*v, static_cast<size_t>(atoms));
  shrink(f.source, static_cast<size_t>(atoms));
  for (std::vector<double>* v : {&f.ln_peak, &f.cutoff2})
    shrink(*v, clusters);
  shrink(f.group, clusters);
  shrink(f.box, clusters);
  f.body = std::move(bodies);
}

} // namespace molmesh::density
