// vec.hpp — vectors of three numbers: positions (Å) and grid indices. Host and device.
#pragma once
#include "base/hd.hpp"
#include <cmath>
#include <cstdint>

namespace molmesh {

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  MOLMESH_HD constexpr T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  MOLMESH_HD constexpr const T& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  MOLMESH_HD friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  MOLMESH_HD friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  MOLMESH_HD friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  MOLMESH_HD friend constexpr Vec3 operator*(T s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
  MOLMESH_HD friend constexpr Vec3 operator*(Vec3 a, T s) { return {s * a.x, s * a.y, s * a.z}; }
  MOLMESH_HD friend constexpr Vec3 operator/(Vec3 a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  MOLMESH_HD constexpr Vec3& operator+=(Vec3 b) { return *this = *this + b; }
  MOLMESH_HD constexpr Vec3& operator-=(Vec3 b) { return *this = *this - b; }
  MOLMESH_HD friend constexpr bool operator==(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
  /// Lexicographic, x first.
  MOLMESH_HD friend constexpr bool operator<(Vec3 a, Vec3 b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  }
};

using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;
using Vec3i = Vec3<int32_t>; // grid index; products of extents need int64_t

template <class T>
MOLMESH_HD constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
MOLMESH_HD constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
MOLMESH_HD constexpr T norm2(Vec3<T> a) {
  return dot(a, a);
}
MOLMESH_HD inline double norm(Vec3d a) {
  return std::sqrt(norm2(a));
}
MOLMESH_HD constexpr Vec3d to_double(Vec3i a) {
  return {double(a.x), double(a.y), double(a.z)};
}

} // namespace molmesh
