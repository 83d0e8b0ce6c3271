// target_size.cpp — sizes on the surface from normals at the ends of its edges, then shortest paths along the
// mesh's edges.
#include "optimize/mesh/target_size.hpp"
#include "isosurface/reference_surface.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <atomic>
#include <cmath>

namespace molmesh::optimize {
namespace {

constexpr float unbound = 1e30F;
constexpr double longest = 4; // mean edges at the vertex: a flat surface sets no size

void lower(float& value, float to) {
  std::atomic_ref<float> now(value);
  for (float old = now.load(std::memory_order_relaxed); to < old;)
    if (now.compare_exchange_weak(old, to, std::memory_order_relaxed))
      return;
}

/// The edges of curved triangles at a vertex, one for each triangle at it.
struct SurfaceEdges {
  double length = 0, curvature = 0; ///< sum (Å); the largest (1/Å)
  int32_t n = 0;
};

// Serial: the surface's edges are few, and sums would depend on the order.
std::vector<SurfaceEdges> surface_edges(const DynamicMesh& m, const Target* target) {
  std::vector<SurfaceEdges> at(m.point.size());
  std::vector<Vec3d> normal(m.point.size());
  for (size_t v = 0; v < m.point.size(); ++v) {
    const uint8_t label = m.vertex[v].label;
    double distance;
    Vec3d n;
    if (m.incident[v] >= 0 && label != 0 && m.labels[label].curved() && may_coarsen(m, target, label) &&
        (m.labels[label].target ? m.labels[label].target : target)->probe(m.point[v], distance, n))
      normal[v] = n;
  }
  for (int64_t s = 0; s < static_cast<int64_t>(m.labelled.size()); ++s) {
    if (!m.labelled[s])
      continue;
    m.for_chunk(s, [&](int64_t t) {
      const Element& e = m.element[t];
      for (size_t f = 0; f < 4 && e.alive(); ++f) {
        if (!m.counts_here(e, f) || !m.labels[e.label[f]].curved())
          continue;
        const auto corner = outward_triangle(e.v, f);
        for (size_t k = 0; k < 3; ++k) {
          const int32_t a = corner[k], b = corner[(k + 1) % 3];
          const Vec3d d = m.point[b] - m.point[a];
          const bool known = norm2(normal[a]) > 0 && norm2(normal[b]) > 0;
          const double curvature = known ? std::abs(dot(normal[b] - normal[a], d)) / norm2(d) : 0;
          for (const int32_t v : {a, b}) {
            at[v].length += norm(d);
            at[v].curvature = std::max(at[v].curvature, curvature);
            ++at[v].n;
          }
        }
      }
    });
  }
  return at;
}

} // namespace

bool may_coarsen(const DynamicMesh& m, const Target* target, uint8_t label) {
  const Target* own = m.labels[label].target ? m.labels[label].target : target;
  return own && !dynamic_cast<const ReferenceSurface*>(own);
}

std::vector<float> target_sizes(const DynamicMesh& m, const Target* target, double tolerance, int threads) {
  std::vector<float> size(m.point.size(), unbound);
  const std::vector<SurfaceEdges> at = surface_edges(m, target);
  for (size_t v = 0; v < at.size(); ++v)
    if (at[v].n > 0) {
      const double mean = at[v].length / at[v].n;
      double own = mean;
      if (may_coarsen(m, target, m.vertex[v].label)) // a centroid is edge² curvature / 6 below the sphere
        own = std::clamp(std::sqrt(6 * tolerance / std::max(at[v].curvature, 1e-9)), mean, longest * mean);
      size[v] = static_cast<float>(own);
    }
  // Sums along paths do not depend on who comes first, and the least of them is what remains.
  std::atomic<bool> changed{true};
  while (changed.exchange(false))
    par::for_n(static_cast<int64_t>(m.element.size()), threads, 4096, [&](int64_t t) {
      const Element& e = m.element[t];
      if (!e.alive())
        return;
      for (const auto& [i, j] : edges) {
        const int32_t a = e.v[i], b = e.v[j];
        const float sa = std::atomic_ref(size[a]).load(std::memory_order_relaxed),
                    sb = std::atomic_ref(size[b]).load(std::memory_order_relaxed);
        const float grown = size_growth * static_cast<float>(norm(m.point[a] - m.point[b]));
        if (sa + grown < sb) {
          lower(size[b], sa + grown);
          changed.store(true, std::memory_order_relaxed);
        } else if (sb + grown < sa) {
          lower(size[a], sb + grown);
          changed.store(true, std::memory_order_relaxed);
        }
      }
    });
  return size;
}

} // namespace molmesh::optimize
