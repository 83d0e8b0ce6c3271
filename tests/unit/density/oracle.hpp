// oracle.hpp — the field by its definition: every atom, double precision, in logarithms so that nothing underflows.
#pragma once
#include "grid/block_grid.hpp"
#include "molecule/hierarchy.hpp"
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace molmesh::test {

inline double log_sum(const std::vector<double>& ln) {
  double top = -std::numeric_limits<double>::infinity(), sum = 0;
  for (const double v : ln)
    top = std::max(top, v);
  for (const double v : ln)
    sum += std::exp(v - top);
  return top + std::log(sum);
}

/// Squared distance from the core of a body, by its definition.
inline double core_distance2(const Body& b, Vec3d p) {
  const auto beyond = [](double x, double half) { return std::max(std::abs(x) - half, 0.0); };
  const Vec3d q = p - b.center;
  const double u = norm(b.u), along = u > 0 ? dot(q, b.u) / u : 0, round = b.size - b.skin;
  switch (b.shape) {
  case Body::Shape::sphere:
    return std::pow(std::max(norm(q) - round, 0.0), 2);
  case Body::Shape::capsule:
    return std::pow(std::max(std::hypot(beyond(along, u), norm(cross(q, b.u)) / u) - round, 0.0), 2);
  case Body::Shape::cylinder:
    return std::pow(beyond(along, u - b.skin), 2) + std::pow(std::max(norm(cross(q, b.u)) / u - round, 0.0), 2);
  case Body::Shape::box: {
    const Vec3d w = cross(b.u, b.v);
    return std::pow(beyond(along, u - b.skin), 2) +
           std::pow(beyond(dot(q, b.v) / norm(b.v), norm(b.v) - b.skin), 2) +
           std::pow(beyond(dot(q, w) / norm(w), round), 2);
  }
  case Body::Shape::slab:
    break;
  }
  Vec3d side; // the axis that is least along u, the first of equals, without its part along u
  int least = std::abs(b.u.y) < std::abs(b.u.x) ? 1 : 0;
  least = std::abs(b.u.z) < std::abs(b.u[least]) ? 2 : least;
  side[least] = 1;
  side = side - dot(side, b.u) / (u * u) * b.u;
  const Vec3d other = cross(b.u, side);
  return std::pow(beyond(along, u - b.skin), 2) + std::pow(beyond(dot(q, side) / norm(side), round), 2) +
         std::pow(beyond(dot(q, other) / norm(other), round), 2);
}

/// Squared distance of p from what makes the term of atom i: its center, or a body's core.
inline double term_distance2(const Hierarchy& h, int64_t i, Vec3d p) {
  for (const Body& b : h.body)
    if (b.atom == i)
      return core_distance2(b, p);
  return norm2(p - h.atom[static_cast<size_t>(i)].center);
}

/// ln of the sum over children [begin, end) of level l, or over atoms past the innermost level.
inline double log_children(const Hierarchy& h, size_t l, int64_t begin, int64_t end, double decay, Vec3d p) {
  std::vector<double> ln;
  for (int64_t i = begin; i < end; ++i) {
    const auto s = static_cast<size_t>(i);
    if (l == h.level.size()) {
      ln.push_back(-decay * (term_distance2(h, i, p) - h.atom[s].radius * h.atom[s].radius));
    } else {
      const Group& g = h.level[l].group[s];
      ln.push_back(g.exponent * (std::log(g.weight) + log_children(h, l + 1, g.begin, g.end, decay, p)));
    }
  }
  return log_sum(ln);
}

/// G by equations 1, 4 and 6.
inline double exact_density(const Hierarchy& h, double decay, Vec3d p) {
  const size_t n = h.level.empty() ? h.atom.size() : h.level[0].group.size();
  return std::exp(log_children(h, 0, 0, static_cast<int64_t>(n), decay, p));
}

/// Chains of `residues` residues of `atoms` atoms on a random walk; exponents by level, innermost first.
inline Hierarchy random_chains(int chains, int residues, int atoms, std::vector<double> exponents, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> step(0, 1);
  std::uniform_real_distribution<double> u(0, 1);
  Hierarchy h;
  const size_t levels = exponents.size();
  h.level.resize(levels);
  for (size_t l = 0; l < levels; ++l)
    h.level[l].name = "level" + std::to_string(l);
  for (int c = 0; c < chains; ++c) {
    Vec3d at{6 * step(random), 6 * step(random), 6 * step(random)};
    for (int r = 0; r < residues; ++r) {
      at += Vec3d{1.5 * step(random), 1.5 * step(random), 1.5 * step(random)};
      for (int a = 0; a < atoms; ++a)
        h.atom.push_back({at + Vec3d{step(random), step(random), step(random)}, 1.2 + 0.8 * u(random)});
      const auto end = static_cast<int64_t>(h.atom.size());
      if (levels > 0)
        h.level[levels - 1].group.push_back({"r", exponents[0], end - atoms, end});
    }
    for (size_t l = levels - 1; levels > 1 && l-- > 0;) // one group a chain on every level above
      h.level[l].group.push_back({"c", exponents[levels - 1 - l], l + 2 == levels ? int64_t{c} * residues : c,
                                  l + 2 == levels ? int64_t{c + 1} * residues : c + 1});
  }
  return h;
}

/// One of each shape behind the atoms, each in an innermost group of its own, all in a chain of their own.
inline Hierarchy with_bodies(Hierarchy h) {
  using Shape = Body::Shape;
  const Vec3d u = {4, 3, 1.5}, v = {-1.5, 0, 4};
  std::vector<Body> bodies = {{Shape::sphere, {9, 0, 0}, {}, {}, 5, 1.7},
                              {Shape::capsule, {-12, 3, 2}, {3, 8, -2}, {}, 3.5, 1.4},
                              {Shape::cylinder, {2, -14, 5}, u, {}, 4, 1.7},
                              {Shape::box, {3, 12, -8}, u, v, 3, 1.2},
                              {Shape::slab, {0, 2, -16}, {0.5, 1, 2.5}, {}, 11, 2}};
  const size_t levels = h.level.size();
  std::vector<int64_t> first; // child of the new group of each level above the innermost
  for (size_t l = 0; l + 1 < levels; ++l)
    first.push_back(static_cast<int64_t>(h.level[l + 1].group.size()));
  for (Body& b : bodies) {
    b.atom = static_cast<int64_t>(h.atom.size());
    h.atom.push_back({b.center, b.skin});
    h.body.push_back(b);
    if (levels > 0)
      h.level.back().group.push_back({"body", h.level.back().group[0].exponent, b.atom, b.atom + 1});
  }
  for (size_t l = levels - 1; levels > 1 && l-- > 0;)
    h.level[l].group.push_back(
        {"bodies", h.level[l].group[0].exponent, first[l], static_cast<int64_t>(h.level[l + 1].group.size())});
  return h;
}

/// Weights from `least` to 1.5 on every group of every level.
inline Hierarchy with_weights(Hierarchy h, unsigned seed, double least = 0.3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> weight(least, 1.5);
  for (Level& level : h.level)
    for (Group& g : level.group)
      g.weight = weight(random);
  return h;
}

/// n atoms in one place: as one sum, as one power of it, and as the powers of pairs.
inline std::vector<Hierarchy> crowds(int64_t n) {
  std::mt19937 random(2);
  std::normal_distribution<double> u(0, 0.1);
  Hierarchy one;
  for (int64_t i = 0; i < n; ++i)
    one.atom.push_back({{0.2 + u(random), 0.1 + u(random), u(random)}, 1.7});
  Hierarchy power = one, pairs = one;
  power.level = {{"residue", {{"r", 0.9, 0, n}}}};
  pairs.level.push_back({"residue", {}});
  for (int64_t i = 0; i < n; i += 2)
    pairs.level[0].group.push_back({"r", 0.9, i, i + 2});
  return {one, power, pairs};
}

} // namespace molmesh::test
