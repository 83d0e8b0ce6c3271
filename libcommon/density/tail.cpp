// tail.cpp — carries a bound from the atoms up the levels.
#include "density/tail.hpp"
#include "density/field/field.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace molmesh::density {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double half_diagonal = 0.8660254037844386; // of a cell

/// The value is at most exp(log - decay·(d² + 2·radius·d)).
struct Bound {
  double log = -infinity, decay = infinity;
  void add(const Bound& b) {
    log = log_add(log, b.log);
    decay = std::min(decay, b.decay);
  }
};

class Climber {
public:
  Climber(const Hierarchy& h, double decay, double isovalue, const GridFrame& frame)
      : h_(h), kappa_(decay), ln_isovalue_(std::log(isovalue)), frame_(frame) {}
  Tail run();

private:
  /// What the groups around an atom do to its term: the product of their exponents, and ln of the factor that does
  /// what their weights do (theory/field.md, its beginning).
  struct Path {
    double exponent = 1, ln_weight = 0;
    Path into(const Group& g) const { return {exponent * g.exponent, ln_weight / g.exponent + std::log(g.weight)}; }
  };
  /// κ times this less the squared distance is ln of the atom's term, weights included.
  double radius2(const Atom& a, const Path& path) const { return a.radius * a.radius + path.ln_weight / kappa_; }
  /// Where the atom by itself reaches the isovalue. Negative: nowhere.
  double ball(const Atom& a, const Path& path) const {
    const double rho2 = radius2(a, path) - ln_isovalue_ / (kappa_ * path.exponent);
    return rho2 > 0 ? std::sqrt(rho2) : -1;
  }
  bool seen(double ball) const { return ball > half_diagonal * frame_.spacing * (1 + 1e-9); }
  template <class Use>
  void for_atoms(size_t level, int64_t begin, int64_t end, const Path& path, const Use& use) const;
  Bound sum(size_t level, int64_t begin, int64_t end, const Path& path) const;
  double nearest_inside(int64_t atom, int64_t begin, int64_t end, const Path& path) const;
  int64_t outermost() const {
    return static_cast<int64_t>(h_.level.empty() ? h_.atom.size() : h_.level[0].group.size());
  }

  const Hierarchy& h_;
  const double kappa_, ln_isovalue_;
  const GridFrame& frame_;
  double radius_ = infinity;
};

/// use(begin, end, path) for each innermost group.
template <class Use>
void Climber::for_atoms(size_t level, int64_t begin, int64_t end, const Path& path, const Use& use) const {
  if (level == h_.level.size())
    return use(begin, end, path);
  for (int64_t i = begin; i < end; ++i) {
    const Group& g = h_.level[level].group[i];
    for_atoms(level + 1, g.begin, g.end, path.into(g), use);
  }
}

/// The weights are in the terms of the atoms.
Bound Climber::sum(size_t level, int64_t begin, int64_t end, const Path& path) const {
  Bound all;
  for (int64_t i = begin; i < end; ++i) {
    if (level == h_.level.size()) {
      const Atom& a = h_.atom[i];
      if (!(a.radius > 0))
        continue;
      all.add({seen(ball(a, path)) ? ln_isovalue_ / path.exponent : kappa_ * (radius2(a, path) - radius_ * radius_),
               kappa_});
      continue;
    }
    const Group& g = h_.level[level].group[i];
    Bound b = sum(level + 1, g.begin, g.end, path.into(g));
    b.log *= g.exponent;
    b.decay *= g.exponent;
    all.add(b);
  }
  return all;
}

/// Distance from the atom's center to the nearest corner of its cell that is inside by its innermost group alone.
double Climber::nearest_inside(int64_t atom, int64_t begin, int64_t end, const Path& path) const {
  const Vec3d u = (h_.atom[atom].center - frame_.origin) / frame_.spacing;
  const Vec3d low{std::floor(u.x), std::floor(u.y), std::floor(u.z)};
  double nearest = infinity;
  for (int k = 0; k < 8; ++k) {
    const Vec3d p =
        frame_.origin + frame_.spacing * (low + Vec3d{double(k >> 2), double(k >> 1 & 1), double(k & 1)});
    const double far = norm(p - h_.atom[atom].center);
    if (far >= nearest)
      continue;
    double g = 0;
    for (int64_t a = begin; a < end; ++a)
      if (h_.atom[a].radius > 0)
        g += std::exp(kappa_ * (radius2(h_.atom[a], path) - norm2(p - h_.atom[a].center)));
    if (path.exponent * std::log(g) > ln_isovalue_ + 0.02) // more than any tolerance
      nearest = far;
  }
  return nearest;
}

Tail Climber::run() {
  for_atoms(0, 0, outermost(), {}, [&](int64_t begin, int64_t end, const Path& path) {
    for (int64_t a = begin; a < end; ++a)
      if (const double rho = ball(h_.atom[a], path); h_.atom[a].radius > 0 && seen(rho))
        radius_ = std::min(radius_, rho);
  });
  if (!std::isfinite(radius_))
    radius_ = 0;
  std::vector<uint8_t> is_body(h_.atom.size());
  for (const Body& b : h_.body)
    is_body[b.atom] = true;
  double depth = 2 * half_diagonal * frame_.spacing;
  for_atoms(0, 0, outermost(), {}, [&](int64_t begin, int64_t end, const Path& path) {
    for (int64_t a = begin; a < end && std::isfinite(depth); ++a)
      if (h_.atom[a].radius > 0 && !seen(ball(h_.atom[a], path)))
        depth = is_body[a] ? infinity // no one place stands for it
                           : std::max(depth, radius_ + nearest_inside(a, begin, end, path));
  });
  const Bound b = sum(0, 0, outermost(), {});
  if (!std::isfinite(depth) || !std::isfinite(b.log))
    return {};
  return {b.log, b.decay, radius_, depth};
}

} // namespace

Tail tail(const Hierarchy& h, double decay, double isovalue, const GridFrame& frame) {
  return Climber(h, decay, isovalue, frame).run();
}

} // namespace molmesh::density
