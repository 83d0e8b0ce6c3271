// plan.cpp — memory and time for each element, triangle and thin place are measured (docs/benchmarks.md, Plans).
#include "optimize/plan.hpp"
#include "geom/tet_quality.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace molmesh::optimize {
namespace {

/// Beside an ordinary effort: of the time that elements of low quality take, and edges across; and bytes for each
/// element more.
struct Effect {
  double low, across, room;
};
Effect effect_of(Effort effort) {
  switch (effort) {
  case Effort::fast:
    return {0.3, 0.5, 0};
  case Effort::best:
    return {1.2, 5, 100};
  default:
    return {1, 1, 0};
  }
}

constexpr double low_angle = 18; // degrees
// Where so many edges go across, some point is searched for, in a part of so many elements at most.
constexpr double some_across = 250, largest_part = 120e3;

} // namespace

int64_t count_low(const TetMesh& mesh, int threads) {
  const auto least = static_cast<float>(angle_quality(low_angle));
  return par::reduce(
      std::ssize(mesh.tet), threads, int64_t{0},
      [&](int64_t i) {
        const Tet& t = mesh.tet[i];
        const auto p = [&](int k) { return mesh.point[t[k]]; };
        return int64_t{tet_quality(p(0), p(1), p(2), p(3)) < least};
      },
      std::plus<int64_t>());
}

int64_t count_across(const TetMesh& mesh, int threads) {
  using Edge = std::array<int32_t, 2>;
  const auto edge = [](int32_t a, int32_t b) { return Edge{std::min(a, b), std::max(a, b)}; };
  std::vector<uint8_t> of_surface(mesh.point.size());
  std::vector<Edge> surface, all;
  for (size_t t = 0; t < mesh.tri.size(); ++t) {
    const Tri& v = mesh.tri[t];
    for (size_t i = 0; i < 3; ++i) {
      surface.push_back(edge(v[i], v[(i + 1) % 3]));
      if (mesh.boundary[t] < Boundary::box_x0 || mesh.boundary[t] > Boundary::box_z1)
        of_surface[v[i]] = 1;
    }
  }
  for (const Tet& t : mesh.tet)
    for (size_t i = 0; i < 4; ++i)
      for (size_t j = 0; j < i; ++j)
        if (of_surface[t[i]] != 0 && of_surface[t[j]] != 0)
          all.push_back(edge(t[i], t[j]));
  par::sort_unique(surface, threads);
  par::sort_unique(all, threads);
  return std::ranges::count_if(all, [&](const Edge& e) { return !std::ranges::binary_search(surface, e); });
}

Plan plan(const Work& work) {
  const auto n = static_cast<double>(work.elements), surface = static_cast<double>(work.triangles);
  const double across = work.across < 0 ? 0.025 * surface : static_cast<double>(work.across);
  const double low = work.low < 0 ? 0.0145 * n + 17 * across : static_cast<double>(work.low);
  const Effect e = effect_of(work.effort);
  const bool improves = work.iterations > 0;
  Plan p;
  p.elements = work.elements;
  const double part =
      std::min(n, largest_part) * std::min(1., across / some_across); // copied by what searches in it
  p.memory =
      std::llround(9.9e6 + 60 * n + 690 * surface + 2200 * static_cast<double>(work.blocks) +
                   (improves ? e.room * n + (work.effort == Effort::fast ? 0 : 36 * part) * work.threads : 0));
  p.seconds = 0.022 + 2.5e-7 * n + (improves ? e.low * 5e-5 * low + e.across * 8e-4 * across : 0);
  return p;
}

} // namespace molmesh::optimize
