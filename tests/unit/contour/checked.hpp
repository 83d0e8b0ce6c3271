// checked.hpp — meshes made for a test, and their validity.
#pragma once
#include "contour/contour.hpp"
#include "mesh/validity.hpp"
#include <catch2/catch.hpp>

namespace molmesh::test {

inline TetMesh mesh_of(const BlockGrid& grid, const contour::Options& options, contour::Summary& summary) {
  return contour::contour(grid, options, summary, [](const std::string&) {});
}
inline TetMesh mesh_of(const BlockGrid& grid, const contour::Options& options) {
  contour::Summary summary;
  return mesh_of(grid, options, summary);
}

inline Validity checked(const TetMesh& mesh) {
  const Validity v = check_validity(mesh, 1);
  for (const Fault& f : v.faults)
    UNSCOPED_INFO(f.rule << " " << f.count << " " << f.example);
  CHECK(v.faults.empty());
  return v;
}

inline double region_volume(const Validity& v, int32_t region) {
  for (const RegionSummary& r : v.region)
    if (r.region == region)
      return r.volume;
  return 0;
}

} // namespace molmesh::test
