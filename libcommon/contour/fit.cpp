// fit.cpp — searches tolerance and layers by counts of leaves, and meshes where these are not exact enough.
#include "contour/fit.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::contour {
namespace {

/// In grid spacings: below the first nearly all surface cells are fine, above the last topology and creases decide.
constexpr double least_adapt = 0.005, most_adapt = 4;
constexpr int most_layers = 64, most_steps = 10;
// Of the elements that may be, when the search ends. The next layer may have too many; then larger cells of the
// surface make room for it, but not where most elements are there without.
constexpr double enough = 0.92, enough_layers = 0.75;

} // namespace

Fit fit(const LeafCounter& counter, const BlockGrid& grid, Options::Meshed meshed, double most) {
  const auto at = [&](double adapt, int layers) {
    Fit f;
    f.fineness = {adapt, layers};
    f.leaves = counter.count(adapt, layers);
    f.elements = double(plan(f.leaves, std::ssize(grid.corner), meshed).elements);
    return f;
  };
  // Layers, while all surface cells are fine.
  Fit before, fine = at(least_adapt, 1);
  while (fine.elements <= most) {
    before = fine;
    if (before.fineness.layers < most_layers)
      fine = at(least_adapt, before.fineness.layers + 1);
    if (fine.elements <= before.elements) {
      before.finest = true;
      return before;
    }
  }
  if (before.elements > enough_layers * most)
    return before;
  // The tolerance. Where chords do not allow it, counts are those of a smaller one.
  const int layers = fine.fineness.layers;
  double low = least_adapt, high = most_adapt;
  Fit best = at(high, layers), coarsest = best;
  for (int step = 0; step < most_steps && !(best.elements <= most && best.elements > enough * most); ++step) {
    const Fit f = at(std::sqrt(low * high), layers);
    if (f.elements < coarsest.elements)
      coarsest = f;
    if (f.elements <= most && (best.elements > most || f.elements > best.elements))
      best = f;
    if (f.elements > most && f.leaves.adapt >= 0.999 * f.fineness.adapt)
      low = f.fineness.adapt;
    else
      high = f.fineness.adapt;
  }
  if (layers > 1)
    return best.elements <= most && best.elements > before.elements ? best : before;
  if (best.elements > most) {
    best = coarsest;
    best.coarsest = true;
  }
  return best;
}

TetMesh fitted_mesh(const LeafCounter& counter, const BlockGrid& grid, const Options& options, int64_t most,
                    const std::function<TetMesh(const Options&)>& make, Fit& fitted) {
  constexpr double wanted = 0.85;
  constexpr int most_meshes = 4;
  double ratio = usual_ratio; // elements over planned ones
  TetMesh best;
  for (int made = 0; made < most_meshes; ++made) {
    const Fit f = fit(counter, grid, options.meshed, double(most) / ratio);
    if (f.coarsest && f.elements * least_ratio > double(most)) {
      if (best.tet.empty())
        fitted = f;
      break;
    }
    Options here = options;
    here.adapt = f.fineness.adapt;
    here.layers = f.fineness.layers;
    TetMesh mesh = make(here);
    const auto n = std::ssize(mesh.tet);
    const double true_ratio = double(n) / f.elements;
    if (n <= most && n > std::ssize(best.tet)) {
      fitted = f;
      fitted.elements = double(n);
      best = std::move(mesh);
    }
    if (n <= most ? double(n) >= wanted * double(most) || f.finest : f.coarsest) {
      if (best.tet.empty()) {
        fitted = f;
        fitted.elements = double(n);
      }
      break;
    }
    ratio = n > most ? std::max(1.005 * true_ratio, 1.01 * ratio) : 1.005 * true_ratio;
  }
  return best;
}

} // namespace molmesh::contour
