// cube_distances.cpp — the deepest ball of each point, then arcs and vertices where that ball's sphere is not free.
#include "distance/cube_distances.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace molmesh::distance {
namespace {

/// Depths that differ by less, Å, count as equal: the sphere that is free of either gives the distance.
constexpr double equal_depth = 1e-9;

} // namespace

double CubeDistances::Box::distance(Vec3d p) const {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = std::max(std::abs(p[a] - middle[a]) - half[a], 0.0);
    sum += d * d;
  }
  return std::sqrt(sum);
}

double CubeDistances::Box::farthest(Vec3d p) const {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = std::abs(p[a] - middle[a]) + half[a];
    sum += d * d;
  }
  return std::sqrt(sum);
}

CubeDistances::Box CubeDistances::box_of(const PointCube& cube) const {
  const Vec3d low = frame_.position(cube.lo), high = frame_.position(cube.hi - Vec3i{1, 1, 1});
  return {0.5 * (low + high), 0.5 * (high - low)};
}

void CubeDistances::narrow(const std::vector<int32_t>& from, const PointCube& cube,
                           std::vector<int32_t>& to) const {
  const Box box = box_of(cube);
  to.clear();
  for (const int32_t n : from) {
    const Ball& place = influence_.places()[static_cast<size_t>(n)];
    if (box.distance(place.center) <= place.radius)
      to.push_back(n);
  }
}

void CubeDistances::choose(const Box& box, const std::vector<int32_t>& near) {
  ball_.clear();
  edge_.clear();
  for (const int32_t n : near) {
    const Ball& place = influence_.places()[static_cast<size_t>(n)];
    const double distance = box.distance(place.center);
    if (distance > place.radius)
      continue;
    const bool is_ball = n < influence_.first_arc();
    const double least = distance - place.radius;
    if (is_ball)
      ball_.push_back({least + influence_.beyond_balls(), n});
    else
      edge_.push_back({least + influence_.beyond_edges(), n});
  }
}

/// Without its points: mixed where that cannot be told.
Side CubeDistances::one_side(const Box& box) const {
  if (ball_.empty())
    return Side::outside;
  bool sphere_near = false, inside = false;
  for (const Candidate& c : ball_) {
    const Ball& b = influence_.balls()[static_cast<size_t>(c.number)];
    const double least = b.radius - box.farthest(b.center);
    if (least > influence_.wanted().highest)
      return Side::inside;
    sphere_near = sphere_near ||
                  (influence_.boundary().free[static_cast<size_t>(c.number)] && least <= influence_.beyond_edges());
    inside = inside || norm(box.middle - b.center) < b.radius;
  }
  // Without any boundary near, all of the cube lies where its middle does.
  if (!sphere_near && edge_.empty())
    return inside ? Side::inside : Side::outside;
  return Side::mixed;
}

/// value_: depth in the deepest ball; second_: in the next one, where it is nearly as deep.
void CubeDistances::find_deepest_balls(size_t n) {
  constexpr double none = -std::numeric_limits<double>::max();
  std::sort(ball_.begin(), ball_.end());
  std::fill_n(value_.begin(), n, none);
  std::fill_n(second_.begin(), n, none);
  std::fill_n(deepest_.begin(), n, -1.0);
  const Points p{x_.data(), y_.data(), z_.data(), n};
  double least = none;
  for (const Candidate& c : ball_) {
    if (-c.near < least - 2 * equal_depth)
      break;
    ++visits;
    least = take_deeper(p, influence_.balls()[static_cast<size_t>(c.number)], c.number, value_.data(),
                        second_.data(), deepest_.data());
  }
}

/// Whether the nearest place on the ball's sphere belongs to the boundary.
bool CubeDistances::on_free_part(int32_t ball, Vec3d p) const {
  if (!influence_.boundary().free[static_cast<size_t>(ball)])
    return false;
  const Vec3d from = p - influence_.balls()[static_cast<size_t>(ball)].center;
  const double length = norm(from);
  for (const Cap& c : influence_.boundary().caps(ball))
    if (dot(from, c.normal) > c.buries() * length)
      return false;
  return true;
}

bool CubeDistances::on_free_part_of_equals(Vec3d p, double depth) const {
  return std::any_of(ball_.begin(), ball_.end(), [&](const Candidate& c) {
    const Ball& b = influence_.balls()[static_cast<size_t>(c.number)];
    return b.radius - norm(p - b.center) >= depth - equal_depth && on_free_part(c.number, p);
  });
}

/// Of the first n points that are left.
void CubeDistances::find_nearest_edges(size_t n) {
  std::sort(edge_.begin(), edge_.end());
  const double beyond = 2 * (influence_.beyond_edges() + 1);
  std::fill_n(left_d2_.begin(), n, beyond * beyond);
  const Points p{left_x_.data(), left_y_.data(), left_z_.data(), n};
  const Boundary& boundary = influence_.boundary();
  double most = beyond * beyond;
  for (const Candidate& c : edge_) {
    if (c.near > 0 && c.near * c.near > most)
      break;
    ++visits;
    if (const int32_t v = c.number - influence_.first_vertex(); v >= 0)
      most = take_nearer(p, boundary.vertex[static_cast<size_t>(v)], left_d2_.data());
    else
      most = take_nearer(p, boundary.arc[static_cast<size_t>(c.number - influence_.first_arc())], left_d2_.data());
  }
}

Side CubeDistances::find(const PointCube& cube, const std::vector<int32_t>& near) {
  const Box box = box_of(cube);
  choose(box, near);
  if (const Side side = one_side(box); side != Side::mixed)
    return side;
  // Copies of the last point fill up what is computed at once.
  const auto fill = [](Numbers& x, Numbers& y, Numbers& z, size_t n) {
    const size_t all = (n + 7) & ~size_t{7};
    for (size_t i = n; i < all; ++i)
      x[i] = x[n - 1], y[i] = y[n - 1], z[i] = z[n - 1];
    return all;
  };
  size_t n = 0, left = 0;
  for (int32_t x = cube.lo.x; x < cube.hi.x; ++x)
    for (int32_t y = cube.lo.y; y < cube.hi.y; ++y)
      for (int32_t z = cube.lo.z; z < cube.hi.z; ++z, ++n) {
        const Vec3d p = frame_.position({x, y, z});
        x_[n] = p.x, y_[n] = p.y, z_[n] = p.z;
      }
  find_deepest_balls(fill(x_, y_, z_, n));
  const double highest = influence_.wanted().highest;
  for (size_t i = 0; i < n; ++i) {
    if (value_[i] < 0 || value_[i] > highest)
      continue;
    const Vec3d p{x_[i], y_[i], z_[i]};
    if (on_free_part(static_cast<int32_t>(deepest_[i]), p) ||
        (value_[i] - second_[i] <= equal_depth && on_free_part_of_equals(p, value_[i])))
      continue;
    left_x_[left] = p.x, left_y_[left] = p.y, left_z_[left] = p.z;
    left_[left++] = static_cast<int32_t>(i);
  }
  if (left > 0)
    find_nearest_edges(fill(left_x_, left_y_, left_z_, left));
  for (size_t l = 0; l < left; ++l)
    value_[static_cast<size_t>(left_[l])] = std::sqrt(left_d2_[l]);
  return Side::mixed;
}

} // namespace molmesh::distance
