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

/// ln of the sum over children [begin, end) of level l, or over atoms past the innermost level.
inline double log_children(const Hierarchy& h, size_t l, int64_t begin, int64_t end, double decay, Vec3d p) {
  std::vector<double> ln;
  for (int64_t i = begin; i < end; ++i) {
    const auto s = static_cast<size_t>(i);
    if (l == h.level.size()) {
      ln.push_back(-decay * (norm2(p - h.atom[s].center) - h.atom[s].radius * h.atom[s].radius));
    } else {
      const Group& g = h.level[l].group[s];
      ln.push_back(g.exponent * log_children(h, l + 1, g.begin, g.end, decay, p));
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
