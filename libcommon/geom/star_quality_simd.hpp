// star_quality_simd.hpp — qualities of the elements of a vertex star at one place, an element a lane, or at many, a
// place a lane; vectorized for the best instruction set of this machine.
#pragma once
#include "geom/star_quality_items.hpp"
#include <cstdint>

namespace molmesh {

/// Sixteen elements, field by field in the order of StarElement; lanes beyond the last repeat the group's first.
struct alignas(64) StarElementGroup {
  static constexpr int lanes = 16, fields = 16;
  float field[fields][lanes];
};
static_assert(sizeof(StarElement<float>) == StarElementGroup::fields * sizeof(float));

/// Corners a, b, c of sixteen elements, x y z of each in turn, as the mesh has them.
struct alignas(64) StarCorners {
  static constexpr int fields = 9;
  double field[fields][StarElementGroup::lanes];
};
/// Single precision relative to `origin`, in units of 1 / inverse.
void make_star_elements(const StarCorners& from, Vec3d origin, double inverse, StarElementGroup& to);

struct StarView {
  const StarElementGroup* group;
  int32_t count;
  int32_t* order;   ///< [count] in which elements are asked about many places: worst first is best
  int32_t* decided; ///< a lane of the group that last decided about one place: the likely one next time
  float shape;      ///< of Q, as tet_quality has it
};

/// Smallest quality with the vertex at x, or some value ≤ above as soon as elements are no better than that.
float worst_in_star(const StarView& s, Vec3f x, float above);

/// quality[count], and room for up to 15 more.
void star_qualities(const StarView& s, Vec3f x, float* quality);

/// Of one element, at x and at ± d along each axis: out[2 a], out[2 a + 1].
void judge_around(const StarView& s, int32_t element, Vec3f x, float d, float (&out)[6]);

struct alignas(64) Places {
  static constexpr int most = 16;
  float x[most] = {}, y[most] = {}, z[most] = {};
};
/// The first place in [from, n) at which all elements are above; n: none. q: the smallest quality there.
int first_place_above(const StarView& s, const Places& places, int from, int n, float above, float& q);

} // namespace molmesh
