// measures.cpp — extremes among elements of low quality; sums over surface triangles and points.
#include "optimize/mesh/measures.hpp"
#include "geom/tet_measures.hpp"
#include "isosurface/near_isosurface.hpp"
#include "mesh/worst_elements.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::optimize {
namespace {

Angles of_element(const DynamicMesh& m, const Element& e) {
  const auto p = [&](size_t i) { return m.point[e.v[i]]; };
  Angles a;
  for (const double angle : dihedrals(p(0), p(1), p(2), p(3)).degree) {
    a.min = std::min(a.min, angle);
    a.max = std::max(a.max, angle);
  }
  a.below_25 = a.min < 25;
  a.above_140 = a.max > 140;
  return a;
}

Angles both(Angles a, const Angles& b) {
  a.min = std::min(a.min, b.min);
  a.max = std::max(a.max, b.max);
  a.below_25 += b.below_25;
  a.above_140 += b.above_140;
  return a;
}

Angles measure_up_to(const DynamicMesh& m, float quality, int threads) {
  constexpr int64_t grain = 16;
  return par::reduce(
      static_cast<int64_t>(m.dirty.size()), threads, Angles{},
      [&](int64_t s) {
        Angles a;
        if (!m.dirty[s] && m.worst[s] > quality)
          return a;
        m.for_chunk(s, [&](int64_t t) {
          if (const Element& e = m.element[t]; e.q <= quality && e.alive())
            a = both(a, of_element(m, e));
        });
        return a;
      },
      both, grain);
}

void add_triangle(const DynamicMesh& m, const Isosurface& surface, const Element& e, size_t face, Fidelity& sum) {
  const auto t = outward_triangle(e.v, face);
  const Vec3d a = m.point[t[0]], b = m.point[t[1]], c = m.point[t[2]];
  const Vec3d n = tri_normal(a, b, c), centre = (a + b + c) / 3.;
  const double area = norm(n) / 2;
  ++sum.triangles;
  sum.area += area;
  const IsosurfaceView view = surface.view();
  const NearIsosurface near(view); // all in a cell or two
  double distance;
  Vec3d normal;
  // Exterior meshes alone see the molecule from outside.
  const double side = m.labels[e.label[face]].reversed ? -1 : 1;
  if (!near.probe(centre, distance, normal)) {
    ++sum.centroids_off;
    ++sum.turned;
  } else {
    sum.centroids_off += std::abs(distance + surface.offset()) > 0.25 * surface.spacing();
    sum.turned += side * dot(n, normal) < std::sqrt(0.5) * norm(n);
  }
  for (const Vec3d& p : {a, b, c}) // the three-point rule, exact where the distance is quadratic
    if (near.probe(0.5 * centre + 0.5 * p, distance, normal))
      sum.missing -= (distance + surface.offset()) * area / 3;
}

Fidelity add(Fidelity a, const Fidelity& b) {
  a.points += b.points;
  a.triangles += b.triangles;
  a.points_off += b.points_off;
  a.points_off_cavity += b.points_off_cavity;
  a.points_off_wall += b.points_off_wall;
  a.centroids_off += b.centroids_off;
  a.turned += b.turned;
  a.interface_points += b.interface_points;
  a.interface_points_off += b.interface_points_off;
  a.volume += b.volume;
  a.missing += b.missing;
  a.area += b.area;
  return a;
}

// Elements of one sum: with others it would be another one in its last digits.
constexpr int64_t chunk = 4096;
static_assert(chunk % DynamicMesh::chunk == 0);
constexpr int64_t chunks = chunk / DynamicMesh::chunk;

// add(f(chunk), …) in a fixed order.
template <class T, class F, class Add>
T sum_of_chunks(const DynamicMesh& m, int threads, F&& f, Add&& add_to) {
  const auto all = static_cast<int64_t>(m.labelled.size());
  return par::reduce((all + chunks - 1) / chunks, threads, T{},
                     [&](int64_t c) {
                       T sum{};
                       for (int64_t s = c * chunks; s < std::min(all, (c + 1) * chunks); ++s)
                         f(s, sum);
                       return sum;
                     },
                     add_to, 1);
}

/// 1: the triangle faces the isosurface's way, -1: the other; 0: there is none.
int64_t sense_at(const DynamicMesh& m, const Isosurface& surface, const Element& e, size_t face) {
  const auto t = outward_triangle(e.v, face);
  const Vec3d a = m.point[t[0]], b = m.point[t[1]], c = m.point[t[2]];
  double distance;
  Vec3d normal;
  if (!surface.probe((a + b + c) / 3., distance, normal))
    return 0;
  return (dot(tri_normal(a, b, c), normal) > 0) != m.labels[e.label[face]].reversed ? 1 : -1;
}

/// Over the triangles of the surface: each(element, face, sum).
template <class T, class Each, class AddTo>
T sum_of_triangles(const DynamicMesh& m, int threads, Each each, AddTo add_to) {
  return sum_of_chunks<T>(
      m, threads,
      [&](int64_t s, T& sum) {
        if (!m.labelled[s])
          return;
        m.for_chunk(s, [&](int64_t t) {
          if (const Element& e = m.element[t]; e.alive())
            for (size_t f = 0; f < 4; ++f)
              if (m.counts_here(e, f) && m.labels[e.label[f]].curved() && !m.labels[e.label[f]].target)
                each(e, f, sum);
        });
      },
      add_to);
}

Fidelity measure_triangles(const DynamicMesh& m, const Isosurface& surface, int threads) {
  return sum_of_triangles<Fidelity>(
      m, threads, [&](const Element& e, size_t face, Fidelity& sum) { add_triangle(m, surface, e, face, sum); },
      add);
}

/// What an element's region is compared to.
struct Regions {
  int32_t lowest = INT32_MAX;  ///< the molecule, or what an exterior mesh has
  std::vector<int32_t> cavity; ///< points in it
};

Regions find_regions(const DynamicMesh& m, int threads) {
  const auto all = static_cast<int64_t>(m.labelled.size());
  std::vector<Regions> part(size_t((all + chunks - 1) / chunks));
  par::for_n(static_cast<int64_t>(part.size()), threads, 1, [&](int64_t c) {
    Regions& r = part[c];
    for (int64_t s = c * chunks; s < std::min(all, (c + 1) * chunks); ++s)
      m.for_chunk(s, [&](int64_t t) {
        const Element& e = m.element[t];
        if (!e.alive())
          return;
        r.lowest = std::min(r.lowest, e.region);
        if (e.region == cavity)
          r.cavity.insert(r.cavity.end(), e.v.begin(), e.v.end());
      });
  });
  Regions sum;
  for (const Regions& r : part) {
    sum.lowest = std::min(sum.lowest, r.lowest);
    sum.cavity.insert(sum.cavity.end(), r.cavity.begin(), r.cavity.end());
  }
  return sum;
}

} // namespace

bool runs_against(const DynamicMesh& m, const Isosurface& surface, int threads) {
  return sum_of_triangles<int64_t>(
             m, threads, [&](const Element& e, size_t face, int64_t& sum) { sum += sense_at(m, surface, e, face); },
             [](int64_t a, int64_t b) { return a + b; }) < 0;
}

Fidelity measure_fidelity(const DynamicMesh& m, const Isosurface& surface, int threads) {
  Fidelity sum = measure_triangles(m, surface, threads);
  const Regions regions = find_regions(m, threads);
  const bool has_domains = m.order.last_domain > molmesh::Region::cavity;
  sum.volume += sum_of_chunks<double>(
      m, threads,
      [&](int64_t s, double& volume) {
        m.for_chunk(s, [&](int64_t t) {
          if (const Element& e = m.element[t];
              e.alive() && (has_domains ? m.order.is_inside(e.region) : e.region == regions.lowest))
            volume += tet_volume(m.point[e.v[0]], m.point[e.v[1]], m.point[e.v[2]], m.point[e.v[3]]);
        });
      },
      [](double a, double b) { return a + b; });
  const bool coarse = std::abs(surface.offset()) > most_offset * surface.spacing();
  const double most_off = (coarse ? most_coarse_offset + 0.0025 : 0.02) * surface.spacing();
  std::vector<uint8_t> in_cavity(m.point.size());
  for (const int32_t v : regions.cavity)
    in_cavity[v] = 1;
  return add(sum, par::reduce(
                      static_cast<int64_t>(m.point.size()), threads, Fidelity{},
                      [&](int64_t v) {
                        Fidelity one;
                        if (m.incident[v] < 0 || !follows_target(m.vertex[v].kind))
                          return one;
                        if (const Target* own = m.labels[m.vertex[v].label].target) {
                          double distance;
                          Vec3d normal;
                          one.interface_points = 1;
                          one.interface_points_off =
                              !own->probe(m.point[v], distance, normal) || own->off_by(distance) > 1;
                          return one;
                        }
                        one.points = 1;
                        double distance;
                        Vec3d normal;
                        one.points_off = !surface.probe(m.point[v], distance, normal) ||
                                         std::abs(distance + surface.offset()) > most_off;
                        one.points_off_cavity = one.points_off && in_cavity[v];
                        one.points_off_wall = one.points_off && m.vertex[v].kind == Kind::trace;
                        return one;
                      },
                      add));
}

double chord_offset(const DynamicMesh& m, const Isosurface& surface, int threads, double most) {
  const Fidelity f = measure_triangles(m, surface, threads);
  const double now = surface.offset();
  most *= surface.spacing();
  return f.area > 0 ? std::clamp(now + f.missing / f.area, -most, most) - now : 0;
}

double mean_surface_edge(const DynamicMesh& m, int threads) {
  struct Triangles {
    int64_t n = 0;
    double area = 0;
  };
  const auto sum = sum_of_chunks<Triangles>(
      m, threads,
      [&](int64_t s, Triangles& part) {
        if (!m.labelled[s])
          return;
        m.for_chunk(s, [&](int64_t t) {
          double area = 0;
          const Element& e = m.element[t];
          for (size_t f = 0; f < 4 && e.alive(); ++f)
            if (m.counts_here(e, f) && m.labels[e.label[f]].curved()) {
              const auto v = outward_triangle(e.v, f);
              area += norm(tri_normal(m.point[v[0]], m.point[v[1]], m.point[v[2]])) / 2;
              ++part.n;
            }
          part.area += area;
        });
      },
      [](Triangles a, Triangles b) {
        return Triangles{a.n + b.n, a.area + b.area};
      });
  return sum.n > 0 ? std::sqrt(4 / std::sqrt(3.) * sum.area / double(sum.n)) : 0;
}

Angles measure_angles(const DynamicMesh& m, int threads) {
  // No element has more quality than any of its angles alone: those above this have none outside [27°, 137°].
  const auto enough = static_cast<float>(1.001 * std::max(angle_quality(27), angle_quality(137)));
  const Angles a = measure_up_to(m, enough, threads);
  return a.min < 27 && a.max > 137 ? a : measure_up_to(m, 2, threads);
}

std::string text(const Angles& a) {
  return range_text(a.min, a.max) + ", " + std::to_string(a.below_25) + " elements under 25°, " +
         std::to_string(a.above_140) + " over 140°";
}

} // namespace molmesh::optimize
