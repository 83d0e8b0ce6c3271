// near_sums.cpp — bounds every group over a box, from the atoms up, then drops from the root down.
#include "label/near_sums.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace molmesh::label {
namespace {

using density::Box;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Squared, from any point of a to any of b.
double farthest2(const Box& a, const Box& b) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = std::max(b.hi[k] - a.lo[k], a.hi[k] - b.lo[k]);
    sum += d * d;
  }
  return sum;
}

} // namespace

void NearSums::gather(const Box& box, const std::vector<int32_t>& cluster) {
  std::vector<int32_t> list = cluster;
  const auto copy_clusters = [&] {
    near_.group.clear();
    near_.box.clear();
    near_.ln_peak.clear();
    for (const int32_t c : list) {
      near_.group.push_back(f_.group[c]);
      near_.box.push_back(f_.box[c]);
      near_.ln_peak.push_back(f_.ln_peak[c]);
    }
  };
  copy_clusters();
  bound(box);
  drop();
  list.clear();
  for (const Bounded& b : bounded_[0])
    if (b.kept)
      list.insert(list.end(), cluster.begin() + b.first, cluster.begin() + b.last);
  copy_clusters();
  near_.begin.assign(1, 0);
  near_.body.clear();
  for (std::vector<double>* v : {&near_.x, &near_.y, &near_.z, &near_.peak})
    v->clear();
  near_.source.clear();
  for (const int32_t c : list) {
    const auto first = static_cast<size_t>(f_.begin[c]), last = static_cast<size_t>(f_.begin[c + 1]);
    near_.begin.push_back(near_.begin.back() + static_cast<int32_t>(last - first));
    near_.body.push_back(f_.body.empty() ? -1 : f_.body_of(c));
    for (size_t a = first; a < last; ++a) {
      near_.x.push_back(f_.x[a]);
      near_.y.push_back(f_.y[a]);
      near_.z.push_back(f_.z[a]);
      near_.peak.push_back(f_.peak[a]);
      near_.source.push_back(f_.source[a]);
    }
  }
  const size_t most = near_.source.size();
  for (AlignedVector<double>* v : {&atom_.x, &atom_.y, &atom_.z, &atom_.peak})
    v->resize(most);
  ln_term_.resize(most);
  near_atom_.resize(most);
  body_.resize(most);
}

void NearSums::bound(const Box& box) {
  bounded_.resize(level_.size());
  for (std::vector<Bounded>& b : bounded_)
    b.clear();
  std::vector<Bounded>& unit = bounded_[0];
  for (size_t c = 0; c < near_.group.size(); ++c) {
    if (unit.empty() || unit.back().group != near_.group[c])
      unit.push_back({near_.group[c], -infinity, -infinity, static_cast<int32_t>(c), 0});
    Bounded& u = unit.back();
    u.last = static_cast<int32_t>(c) + 1;
    u.most = std::max(u.most, near_.ln_peak[c] - f_.decay * distance2(box, near_.box[c]));
    u.least = std::max(u.least, near_.ln_peak[c] - f_.decay * farthest2(box, near_.box[c]));
  }
  for (size_t l = 0;; ++l) {
    for (Bounded& b : bounded_[l])
      b.most += std::log(static_cast<double>(b.last - b.first));
    if (l + 1 == level_.size())
      return;
    std::vector<Bounded>& outer = bounded_[l + 1];
    for (size_t i = 0; i < bounded_[l].size(); ++i) {
      const Bounded& b = bounded_[l][i];
      const int64_t parent = f_.level[l].parent[b.group];
      if (outer.empty() || outer.back().group != parent)
        outer.push_back({parent, -infinity, -infinity, static_cast<int32_t>(i), 0});
      Bounded& o = outer.back();
      o.last = static_cast<int32_t>(i) + 1;
      o.most = std::max(o.most, exponent(l, b.group) * b.most);
      o.least = std::max(o.least, exponent(l, b.group) * b.least);
    }
  }
}

void NearSums::drop() {
  size_t groups = 0;
  for (const std::vector<Bounded>& b : bounded_)
    groups += b.size();
  floor_ = left_out_ - std::log(2. * static_cast<double>(groups));
  double least = -infinity; // ln G
  for (const Bounded& b : bounded_.back())
    least = std::max(least, exponent(level_.size() - 1, b.group) * b.least);
  const auto judge = [&](size_t l, Bounded& b, double matters, double least_sum) {
    const double p = exponent(l, b.group), with_it = matters + std::min(0., p * b.most - least_sum);
    b.kept = with_it >= floor_;
    b.matters = with_it + std::log(std::max(p, 1.));
  };
  for (Bounded& b : bounded_.back())
    judge(level_.size() - 1, b, 0, least);
  for (size_t l = level_.size() - 1; l-- > 0;)
    for (const Bounded& outer : bounded_[l + 1])
      for (int32_t i = outer.first; i < outer.last; ++i)
        if (outer.kept)
          judge(l, bounded_[l][i], outer.matters, outer.least);
        else
          bounded_[l][i].kept = false;
}

void NearSums::take_atoms(const Bounded& unit, const Box& box) {
  const Vec3d middle = 0.5 * (box.lo + box.hi), half = f_.decay * (box.hi - box.lo);
  const auto first = static_cast<size_t>(near_.begin[unit.first]),
             last = static_cast<size_t>(near_.begin[unit.last]);
  for (size_t a = first; a < last; ++a) {
    const double x = near_.x[a] - middle.x, y = near_.y[a] - middle.y, z = near_.z[a] - middle.z;
    ln_term_[a] = near_.peak[a] - f_.decay * (x * x + y * y + z * z);
  }
  const bool bodies =
      !f_.body.empty() && *std::max_element(near_.body.begin() + unit.first, near_.body.begin() + unit.last) >= 0;
  const auto own = static_cast<int32_t>(level_[0].group.size());
  if (bodies)
    with_body_.push_back(own);
  const size_t best = static_cast<size_t>(std::max_element(ln_term_.begin() + static_cast<std::ptrdiff_t>(first),
                                                           ln_term_.begin() + static_cast<std::ptrdiff_t>(last)) -
                                          ln_term_.begin());
  const double x = near_.x[best], y = near_.y[best], z = near_.z[best],
               least = bodies
                           ? -infinity
                           : ln_term_[best] - (unit.matters - floor_ + std::log(static_cast<double>(last - first)));
  for (size_t a = first; a < last; ++a)
    ln_term_[a] +=
        std::abs(near_.x[a] - x) * half.x + std::abs(near_.y[a] - y) * half.y + std::abs(near_.z[a] - z) * half.z;
  int32_t cluster = unit.first;
  for (size_t a = first; a < last; ++a) {
    if (!(ln_term_[a] >= least))
      continue;
    while (bodies && static_cast<size_t>(near_.begin[cluster + 1]) <= a)
      ++cluster;
    near_atom_[atoms_] = static_cast<int32_t>(a);
    body_[atoms_] = bodies ? near_.body[cluster] : -1;
    atom_.x[atoms_] = near_.x[a];
    atom_.y[atoms_] = near_.y[a];
    atom_.z[atoms_] = near_.z[a];
    atom_.peak[atoms_++] = near_.peak[a] / ln2;
  }
}

void NearSums::choose(const Box& box) {
  bound(box);
  drop();
  atoms_ = 0;
  with_body_.clear();
  for (size_t l = 0; l < level_.size(); ++l) {
    Chosen& to = level_[l];
    to.group.clear();
    to.exponent.clear();
    to.begin.assign(1, 0);
    int32_t below = 0; // those that are kept, so far
    for (const Bounded& b : bounded_[l]) {
      if (!b.kept)
        continue;
      if (l == 0) {
        take_atoms(b, box);
        below = static_cast<int32_t>(atoms_);
      } else {
        for (int32_t i = b.first; i < b.last; ++i)
          below += bounded_[l - 1][i].kept;
      }
      to.group.push_back(b.group);
      to.exponent.push_back(exponent(l, b.group));
      to.begin.push_back(below);
    }
    to.sum.resize(lanes * to.group.size());
  }
  root_begin_[1] = static_cast<int32_t>(level_.back().group.size());
}

void NearSums::evaluate(const Vec3d* place, int n) {
  for (int i = 0; i < lanes; ++i) {
    const Vec3d& p = place[std::min(i, n - 1)];
    place_.x[i] = p.x, place_.y[i] = p.y, place_.z[i] = p.z;
  }
  const auto sums = [](const Chosen& c) { return static_cast<int32_t>(c.group.size()); };
  sum_lane_atoms(atom_, level_[0].begin.data(), sums(level_[0]), f_.decay / ln2, place_, scratch_,
                 level_[0].sum.data());
  if (!with_body_.empty())
    add_bodies(place, n);
  for (size_t l = 1; l < level_.size(); ++l)
    sum_lane_powers(level_[l - 1].sum.data(), level_[l - 1].exponent.data(), level_[l].begin.data(),
                    sums(level_[l]), level_[l].sum.data());
  sum_lane_powers(level_.back().sum.data(), level_.back().exponent.data(), root_begin_, 1, root_);
}

void NearSums::add_bodies(const Vec3d* place, int n) {
  for (const int32_t unit : with_body_)
    for (int lane = 0; lane < lanes; ++lane) {
      const Vec3d p = place[std::min(lane, n - 1)];
      const auto first = static_cast<size_t>(level_[0].begin[unit]),
                 last = static_cast<size_t>(level_[0].begin[unit + 1]);
      double top = -infinity, sum = 0;
      for (size_t i = first; i < last; ++i)
        top = std::max(top, atom_term(i, p));
      for (size_t i = first; i < last; ++i)
        sum += std::exp(atom_term(i, p) - top);
      level_[0].sum[static_cast<size_t>(lanes * unit + lane)] = (top + std::log(sum)) / ln2;
    }
}

double NearSums::atom_term(size_t i, Vec3d p) const {
  const auto a = static_cast<size_t>(near_atom_[i]);
  if (body_[i] >= 0)
    return near_.peak[a] - f_.decay * f_.body[body_[i]].core.distance2(p);
  const double x = near_.x[a] - p.x, y = near_.y[a] - p.y, z = near_.z[a] - p.z;
  return near_.peak[a] - f_.decay * (x * x + y * y + z * z);
}

NearSums::Best NearSums::best_atom(size_t unit, int lane) const {
  const Vec3d p{place_.x[lane], place_.y[lane], place_.z[lane]};
  Best best{-infinity, -1};
  for (auto i = static_cast<size_t>(level_[0].begin[unit]); i < static_cast<size_t>(level_[0].begin[unit + 1]);
       ++i) {
    const double ln = atom_term(i, p);
    const int64_t source = near_.source[near_atom_[i]];
    if (best.source < 0 || ln > best.ln || (ln == best.ln && source < best.source)) // not in the order of the file
      best = {ln, source};
  }
  return best;
}

double NearSums::ln_field(int lane) const {
  return root_[lane] * ln2;
}

double NearSums::share_of(double log2_share) {
  return std::exp2(log2_share);
}

} // namespace molmesh::label
