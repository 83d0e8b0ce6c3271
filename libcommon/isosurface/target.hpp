// target.hpp — the surface that boundary points are kept on: the isosurface of the density, or the input mesh's
// own surface.
#pragma once
#include "isosurface/probe_simd.hpp"
#include <cmath>
#include <cstdint>
#include <vector>

namespace molmesh {

/// Where what is inside or outside is narrow.
struct Neck {
  Vec3d at, along; ///< the narrowest place; the way through, unit
};

/// Read-only and safe to share between threads.
class Target {
public:
  virtual ~Target() = default;
  /// Moves p onto the surface. False (p undefined) when that takes more than `reach` (Å) or the surface is not
  /// known there.
  virtual bool project(Vec3d& p, double reach) const = 0;
  /// Along the plane that p is in, normal to that axis. False too where the surface is nearly parallel to it.
  virtual bool project_in_plane(Vec3d& /*p*/, int /*axis*/, double /*reach*/) const { return false; }
  /// Signed distance of p (Å, positive outside) to first order and the unit normal, pointing out. False when not
  /// known.
  virtual bool probe(Vec3d p, double& distance, Vec3d& normal) const = 0;
  /// probe() at the first n places.
  virtual void probe_eight(const EightPlaces& p, int n, EightProbes& out) const { probe_each(*this, p, n, out); }
  /// project() of the first n places. Bit i: it is true of place i.
  virtual uint32_t project_eight(EightPlaces& p, int n, double reach) const {
    return project_each(*this, p, n, reach);
  }
  /// A point in the nearest closed piece of the surface that is hardly larger than the grid's cells, of holes in
  /// what is inside, or of what is not a hole. False where none is near.
  virtual bool pocket(Vec3d /*p*/, bool /*hole*/, Vec3d& /*inside*/) const { return false; }
  /// Of what p, off the surface, is not in, near p. False where that is wide for the grid.
  virtual bool neck(Vec3d /*p*/, Neck& /*neck*/) const { return false; }
  /// How far outside the surface that is meant points are put (Å).
  virtual double offset() const { return 0; }
  /// How far off where points are put a place is, from its distance: in units of a fiftieth of a spacing (what I8
  /// allows).
  double off_by(double distance) const { return std::abs(distance + offset()) / (0.02 * spacing()); }
  /// What a question costs, about, in looks at an element's quality.
  virtual int64_t looks() const { return 8; }
  /// Length that distances are measured against: the grid spacing, or the mean edge of the surface (Å).
  virtual double spacing() const = 0;
};

/// Of the points v[0 … n - 1], eight at most.
inline EightProbes probe_some(const Target& target, const std::vector<Vec3d>& point, const int32_t* v, size_t n) {
  EightPlaces places;
  EightProbes probes;
  for (size_t i = 0; i < n; ++i)
    places.set(i, point[v[i]]);
  target.probe_eight(places, static_cast<int>(n), probes);
  return probes;
}

} // namespace molmesh
