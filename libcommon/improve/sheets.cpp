// sheets.cpp — chains of triangles by cell, and where each face's triangle is.
#include "improve/sheets.hpp"
#include "error.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::improve {

bool SheetTriangle::box_meets(const SheetTriangle& o, float apart) const {
  for (int a = 0; a < 3; ++a)
    if (low[a] > o.high[a] + apart || high[a] + apart < o.low[a])
      return false;
  return true;
}

SheetTriangle sheet_triangle(const std::vector<Vec3d>& point, std::array<int32_t, 3> v, int64_t face) {
  SheetTriangle t;
  t.v = v;
  t.face = face;
  const Vec3d a = point[size_t(v[0])], b = point[size_t(v[1])], c = point[size_t(v[2])];
  for (int k = 0; k < 3; ++k) {
    t.low[k] = std::nextafter(static_cast<float>(std::min({a[k], b[k], c[k]})), -HUGE_VALF);
    t.high[k] = std::nextafter(static_cast<float>(std::max({a[k], b[k], c[k]})), HUGE_VALF);
  }
  const Vec3d n = cross(b - a, c - a), unit = n / std::max(norm(n), 1e-300);
  t.normal = {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)};
  return t;
}

void Sheets::insert(const SheetTriangle& t) {
  if (link_.size() + 27 > INT32_MAX)
    fail(Status::failed, "too many surface triangles to keep from crossing each other");
  erase(t.face);
  const auto id = static_cast<int32_t>(triangle_.size());
  triangle_.push_back(t);
  face_[uint64_t(t.face)] = id;
  ++alive_;
  const int level = cell_level(t.low, t.high, cell_);
  levels_ |= uint64_t{1} << level;
  cells(t, level).for_each([&](int64_t i, int64_t j, int64_t k) {
    int32_t& chain = chain_[cell_key(i, j, k, level)];
    link_.push_back({id, chain});
    chain = static_cast<int32_t>(link_.size() - 1);
  });
}

void Sheets::erase(int64_t face) {
  int32_t& triangle = face_[uint64_t(face)];
  if (triangle < 0)
    return;
  triangle_[size_t(triangle)].v[0] = -1;
  triangle = -1;
  --alive_;
}

void Sheets::merge(const Sheets& later) {
  later.face_.for_each_key([&](uint64_t face) { erase(int64_t(face)); });
  for (const SheetTriangle& t : later.triangle_)
    if (t.v[0] >= 0)
      insert(t);
}

void Sheets::compact() {
  std::vector<SheetTriangle> old;
  old.swap(triangle_);
  *this = Sheets(cell_);
  for (const SheetTriangle& t : old)
    if (t.v[0] >= 0)
      insert(t);
}

} // namespace molmesh::improve
