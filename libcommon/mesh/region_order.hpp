// region_order.hpp — which regions lie inside the surface, and which way triangles between two regions point.
#pragma once
#include "mesh/tet_mesh.hpp"

namespace molmesh {

/// The text of a mesh that names its regions, lines "ID NAME".
inline constexpr const char* region_names_text = "region_names";
/// The text of a mesh with domains: those of 4 and more are groups of this level.
inline constexpr const char* region_level_text = "region_level";

/// Regions 4 to last_domain are parts of the molecule where the mesh has a region_level: they come before all
/// others.
struct RegionOrder {
  int32_t last_domain = Region::cavity;

  RegionOrder() = default;
  explicit RegionOrder(const TetMesh& m);

  bool is_domain(int32_t region) const { return region > Region::cavity && region <= last_domain; }
  /// The molecule, or a domain of it.
  bool is_inside(int32_t region) const { return region == Region::molecule || is_domain(region); }
  /// A triangle between the two points out of a. Of a mesh without domains: the lower number's.
  bool is_first(int32_t a, int32_t b) const { return rank(a) < rank(b); }

private:
  int32_t rank(int32_t region) const { return is_domain(region) ? region - last_domain : region; }
};

} // namespace molmesh
