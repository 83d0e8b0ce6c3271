// fitted_sphere.hpp — the sphere that points lie on.
#pragma once
#include "geom/sphere.hpp"
#include <cstdint>
#include <optional>
#include <vector>

namespace molmesh {

/// Through point[i] for each i of `on`, by least squares; none where they do not lie all round a sphere, up to its
/// rounding().
std::optional<Sphere> sphere_through(const std::vector<Vec3d>& point, const std::vector<int32_t>& on);

} // namespace molmesh
