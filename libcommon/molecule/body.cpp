// body.cpp — frames, cores and nearest places.
#include "molecule/body.hpp"
#include "molecule/limits.hpp"
#include <algorithm>
#include <array>
#include <cmath>

namespace molmesh {
namespace {

constexpr std::array<std::string_view, 5> names = {"sphere", "capsule", "cylinder", "box", "slab"};

bool finite(Vec3d v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// A unit vector across u: the axis that is least along it, made perpendicular.
Vec3d across(Vec3d u) {
  int least = 0;
  for (int a = 1; a < 3; ++a)
    if (std::abs(u[a]) < std::abs(u[least]))
      least = a;
  Vec3d e;
  e[least] = 1;
  const Vec3d w = e - dot(e, u) * u;
  return w / norm(w);
}

} // namespace

std::string_view shape_name(Body::Shape shape) {
  return names[static_cast<size_t>(shape)];
}

std::optional<Body::Shape> shape_of(std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    return std::nullopt;
  return static_cast<Body::Shape>(found - names.begin());
}

std::string fault_of(const Body& b) {
  using Shape = Body::Shape;
  if (!finite(b.center) || !finite(b.u) || !finite(b.v))
    return "finite numbers";
  if (!(b.size > 0 && b.size <= largest_coordinate))
    return "a size > 0 and at most 1e7 Å";
  if (!(b.skin > 0 && b.skin <= largest_radius))
    return "a skin > 0 and at most 10000 Å";
  double thinnest = b.size;
  if (b.shape != Shape::sphere) {
    const double u = norm(b.u);
    if (!(u > 0 && u <= largest_coordinate))
      return "a vector U of a length > 0 and at most 1e7 Å";
    if (b.shape != Shape::capsule)
      thinnest = std::min(thinnest, u);
  }
  if (b.shape == Shape::box) {
    const double v = norm(b.v);
    if (!(v > 0 && v <= largest_coordinate))
      return "a vector V of a length > 0 and at most 1e7 Å";
    if (!(std::abs(dot(b.u, b.v)) <= 1e-6 * norm(b.u) * v))
      return "vectors U and V that are perpendicular";
    thinnest = std::min(thinnest, v);
  }
  if (!(b.skin <= thinnest))
    return "a skin of at most half of what is thinnest";
  return "";
}

Body moved(const Body& b, const Rigid& motion) {
  Body to = b;
  to.center = motion(b.center);
  if (motion.turns_nothing())
    return to;
  if (b.shape == Body::Shape::slab) {
    to.shape = Body::Shape::box;
    to.v = b.size * across(b.u / norm(b.u));
  }
  to.u = motion.turned(b.u);
  to.v = motion.turned(to.v);
  if (to.shape == Body::Shape::box) // rotations of files have few decimals
    to.v = to.v - dot(to.v, to.u) / norm2(to.u) * to.u;
  return to;
}

Core::Core(const Body& b) : center_(b.center) {
  using Shape = Body::Shape;
  const double u = norm(b.u);
  axis_[2] = b.shape == Shape::sphere ? Vec3d{0, 0, 1} : b.u / u;
  if (b.shape == Shape::box) {
    const Vec3d v = b.v - dot(b.v, axis_[2]) * axis_[2]; // perpendicular to the last bit or so
    axis_[0] = v / norm(v);
  } else {
    axis_[0] = across(axis_[2]);
  }
  axis_[1] = cross(axis_[2], axis_[0]);
  switch (b.shape) {
  case Shape::sphere:
  case Shape::capsule:
    kind_ = Kind::capsule;
    radius_ = b.size - b.skin;
    half_[2] = u;
    for (int a = 0; a < 3; ++a)
      extent_[a] = std::abs(axis_[2][a]) * half_[2] + radius_;
    return;
  case Shape::cylinder:
    kind_ = Kind::cylinder;
    radius_ = b.size - b.skin;
    half_[2] = u - b.skin;
    for (int a = 0; a < 3; ++a)
      extent_[a] =
          std::abs(axis_[2][a]) * half_[2] + radius_ * std::sqrt(std::max(0.0, 1 - axis_[2][a] * axis_[2][a]));
    return;
  case Shape::box:
  case Shape::slab:
    kind_ = Kind::box;
    half_[0] = (b.shape == Shape::box ? norm(b.v) : b.size) - b.skin;
    half_[1] = b.size - b.skin;
    half_[2] = u - b.skin;
    for (int a = 0; a < 3; ++a)
      for (int k = 0; k < 3; ++k)
        extent_[a] += std::abs(axis_[k][a]) * half_[k];
  }
}

Vec3d Core::nearest(Vec3d p) const {
  const Vec3d q = p - center_;
  const double along = dot(q, axis_[2]), clamped = std::clamp(along, -half_[2], half_[2]);
  if (kind_ == Kind::box) {
    const double a = dot(q, axis_[0]), b = dot(q, axis_[1]), ca = std::clamp(a, -half_[0], half_[0]),
                 cb = std::clamp(b, -half_[1], half_[1]);
    return a == ca && b == cb && along == clamped ? p
                                                  : center_ + ca * axis_[0] + cb * axis_[1] + clamped * axis_[2];
  }
  // The part that is cut to the radius: of a capsule from the segment on, of a cylinder from the axis on.
  const Vec3d w = q - (kind_ == Kind::capsule ? clamped : along) * axis_[2];
  const double r = norm(w);
  if (r <= radius_ && (kind_ == Kind::capsule || along == clamped))
    return p;
  return center_ + clamped * axis_[2] + (r <= radius_ ? w : radius_ / r * w);
}

} // namespace molmesh
