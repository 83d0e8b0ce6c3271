// other_selection.cpp — compares a mesh's surface with the atoms that should have made it.
#include "label/other_selection.hpp"
#include "base/grouped.hpp"
#include "molecule/bodies.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::label {
namespace {

constexpr double most_share = 0.05;

bool same_file(const Hierarchy& h, const TetMesh& mesh) {
  return !h.source.empty() && h.source == mesh.source;
}

/// Share of the triangles where G is not near the isovalue of any surface: e^-25 is 3.6 Å beyond a carbon atom.
double share_bare(const TetMesh& mesh, const Places& places, const Labels& labels) {
  const auto first = labels.ln_field.begin() + places.tets, last = labels.ln_field.end();
  const auto bare =
      std::count_if(first, last, [&](double ln) { return !(std::fabs(ln - std::log(mesh.isovalue)) <= 25); });
  return first == last ? 0 : double(bare) / double(last - first);
}

/// Share of the atoms beyond the box of the mesh's molecule; 0 where the mesh has walls, which may cut it. Parts
/// that density2tet drops are few atoms.
double share_beyond(const Hierarchy& h, const TetMesh& mesh, const Places& places) {
  constexpr double room = 3; // Å
  if (places.centroid.empty() || h.atom.empty() ||
      std::any_of(mesh.boundary.begin(), mesh.boundary.end(), [](int32_t b) { return b != Boundary::surface; }))
    return 0;
  Vec3d lo = places.centroid[0], hi = lo;
  for (const Vec3d& p : places.centroid)
    for (int k = 0; k < 3; ++k)
      lo[k] = std::min(lo[k], p[k]), hi[k] = std::max(hi[k], p[k]);
  const auto beyond = std::count_if(h.atom.begin(), h.atom.end(), [&](const Atom& a) {
    bool out = false;
    for (int k = 0; k < 3; ++k)
      out = out || a.center[k] < lo[k] - room || a.center[k] > hi[k] + room;
    return out;
  });
  return double(beyond) / double(h.atom.size());
}

} // namespace

std::string other_number(const Hierarchy& h, const TetMesh& mesh) {
  if (!same_file(h, mesh) || may_be_of(h, mesh.atoms))
    return "";
  const int64_t n = atoms_with_body(h);
  return grouped(n) + (n == 1 ? " atom" : " atoms") + " where the mesh has " + grouped(mesh.atoms);
}

std::string other_selection(const Hierarchy& h, const TetMesh& mesh, const Places& places, const Labels& labels) {
  if (!same_file(h, mesh))
    return "";
  const double bare = share_bare(mesh, places, labels), beyond = share_beyond(h, mesh, places);
  if (std::max(bare, beyond) <= most_share)
    return "";
  return std::to_string(std::lround(100 * std::max(bare, beyond))) +
         (bare >= beyond ? " % of the surface is far from its atoms" : " % of its atoms lie beyond the mesh");
}

} // namespace molmesh::label
