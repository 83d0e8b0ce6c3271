// cutoff.cpp — takes the error that one cluster may cause from G down the levels to its group's sum.
#include "density/field/cutoff.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace molmesh::density {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// For every innermost group the logarithm of the largest change of its sum that changes G by at most `allowed`.
std::vector<double> allowed_change(const Field& f, double allowed) {
  const bool steep = std::any_of(f.level.begin(), f.level.end(), [](const FieldLevel& l) {
    return std::any_of(l.exponent.begin(), l.exponent.end(), [](double p) { return p > 1; });
  });
  const std::vector<std::vector<double>> largest = steep ? largest_sums(f) : std::vector<std::vector<double>>();
  std::vector<double> outer, change;
  for (size_t l = f.level.size(); l-- > 0;) {
    change.resize(f.level[l].exponent.size());
    for (size_t g = 0; g < change.size(); ++g) {
      const double p = f.level[l].exponent[g];
      const double t = l + 1 < f.level.size() ? outer[f.level[l].parent[g]] : std::log(allowed);
      change[g] = p <= 1 ? t / p : t - std::log(p) - (p - 1) * largest[l][g];
    }
    outer = change;
  }
  return change;
}

} // namespace

std::vector<std::vector<double>> largest_sums(const Field& f) {
  std::vector<std::vector<double>> largest(f.level.size() + 1);
  for (size_t l = 0; l <= f.level.size(); ++l) {
    largest[l].assign(l < f.level.size() ? f.level[l].exponent.size() : 1, -infinity);
    if (l == 0)
      for (size_t c = 0; c < f.group.size(); ++c) {
        double& sum = largest[0][f.group[c]];
        sum = log_add(sum, f.ln_peak[c]);
      }
    else
      for (size_t g = 0; g < f.level[l - 1].exponent.size(); ++g) {
        double& sum = largest[l][l < f.level.size() ? static_cast<size_t>(f.level[l - 1].parent[g]) : 0];
        sum = log_add(sum, f.level[l - 1].exponent[g] * largest[l - 1][g]);
      }
  }
  return largest;
}

void set_cutoffs(Field& f) {
  const std::vector<double> change = allowed_change(f, f.far_error / static_cast<double>(f.clusters()));
  f.cutoff2.reserve(f.group.size());
  for (size_t c = 0; c < f.group.size(); ++c)
    f.cutoff2.push_back(std::max(0.0, (f.ln_peak[c] - change[f.group[c]]) / f.decay));
}

} // namespace molmesh::density
