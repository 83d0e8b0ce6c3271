// sheets.cpp — chains of triangles by cell, and where each face's triangle is.
#include "improve/sheets.hpp"
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

int64_t Sheets::find(int64_t face) const {
  if (face_table_.empty())
    return -1;
  const size_t mask = face_table_.size() - 1;
  for (size_t i = size_t(mix(uint64_t(face))) & mask; face_table_[i].face >= 0; i = (i + 1) & mask)
    if (face_table_[i].face == face)
      return static_cast<int64_t>(i);
  return -1;
}

Sheets::Known& Sheets::known(int64_t face) {
  const auto place = [&](int64_t f) {
    const size_t mask = face_table_.size() - 1;
    size_t i = size_t(mix(uint64_t(f))) & mask;
    while (face_table_[i].face >= 0 && face_table_[i].face != f)
      i = (i + 1) & mask;
    return i;
  };
  if (2 * (faces_ + 1) > face_table_.size()) {
    std::vector<Known> old(std::max<size_t>(64, 4 * face_table_.size()));
    old.swap(face_table_);
    for (const Known& k : old)
      if (k.face >= 0)
        face_table_[place(k.face)] = k;
  }
  Known& k = face_table_[place(face)];
  if (k.face < 0)
    ++faces_;
  k.face = face;
  return k;
}

void Sheets::put(uint64_t key, int32_t triangle) {
  const auto place = [&](uint64_t k) {
    const size_t mask = cell_table_.size() - 1;
    size_t i = size_t(k) & mask;
    while (cell_table_[i].chain >= 0 && cell_table_[i].key != k)
      i = (i + 1) & mask;
    return i;
  };
  if (2 * (cells_ + 1) > cell_table_.size()) {
    std::vector<Cell> old(std::max<size_t>(64, 4 * cell_table_.size()));
    old.swap(cell_table_);
    for (const Cell& c : old)
      if (c.chain >= 0)
        cell_table_[place(c.key)] = c;
  }
  Cell& c = cell_table_[place(key)];
  if (c.chain < 0)
    ++cells_;
  c.key = key;
  link_.push_back({triangle, c.chain});
  c.chain = static_cast<int32_t>(link_.size() - 1);
}

void Sheets::insert(const SheetTriangle& t) {
  erase(t.face);
  const auto id = static_cast<int32_t>(triangle_.size());
  triangle_.push_back(t);
  known(t.face).triangle = id;
  ++alive_;
  for_cells(t, [&](uint64_t key) { put(key, id); });
}

void Sheets::erase(int64_t face) {
  Known& k = known(face);
  if (k.triangle < 0)
    return;
  triangle_[size_t(k.triangle)].v[0] = -1;
  k.triangle = -1;
  --alive_;
}

void Sheets::merge(const Sheets& later) {
  for (const Known& k : later.face_table_)
    if (k.face >= 0)
      erase(k.face);
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
