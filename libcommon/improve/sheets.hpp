// sheets.hpp — the triangles where a mesh ends in a curved surface, by place: a hash grid of their boxes.
// Nothing on the other side keeps such a triangle from crossing another sheet of the surface.
#pragma once
#include "geom/vec.hpp"
#include "improve/open_table.hpp"
#include <array>
#include <cstdint>
#include <vector>

namespace molmesh::improve {

struct SheetTriangle {
  std::array<int32_t, 3> v{-1, -1, -1}; ///< seen from outside; v[0] < 0: no longer there
  int64_t face = -1;                    ///< 4 element + face
  Vec3f low, high, normal;              ///< box, rounded outwards, and unit normal, when it was put down

  bool box_meets(const SheetTriangle& o, float apart) const;
  /// Triangles of one sheet run much the same way where they are close: there is no crossing to look for.
  bool of_one_sheet(const SheetTriangle& o, bool beside) const {
    return dot(normal, o.normal) > (beside ? 0.7f : 0.3f);
  }
};

SheetTriangle sheet_triangle(const std::vector<Vec3d>& point, std::array<int32_t, 3> v, int64_t face);

class Sheets {
public:
  /// Cells of this size (Å).
  explicit Sheets(double cell) : cell_(cell) {}
  /// In place of what was known of that face.
  void insert(const SheetTriangle& t);
  void erase(int64_t face);
  /// Whether that face was ever inserted or erased here.
  bool knows(int64_t face) const { return face_.find(uint64_t(face)) != nullptr; }
  /// Takes over what `later` knows.
  void merge(const Sheets& later);
  /// Drops what is no longer there.
  void compact();
  /// Of all records, those of triangles no longer there included.
  size_t records() const { return triangle_.size(); }
  const std::vector<SheetTriangle>& triangles() const { return triangle_; }
  size_t alive() const { return alive_; }
  /// True as soon as f(triangle) is, over those whose cells t's box touches; some more than once.
  template <class F>
  bool any(const SheetTriangle& t, F&& f) const;

private:
  struct Link {
    int32_t triangle, next;
  };
  template <class F>
  void for_cells(const SheetTriangle& t, F&& f) const;

  double cell_;
  std::vector<SheetTriangle> triangle_;
  size_t alive_ = 0;
  OpenTable chain_; ///< of a cell: its first link, -1: none; cells of one key share a chain
  OpenTable face_;  ///< of a face: its triangle, -1: gone
  std::vector<Link> link_;
};

template <class F>
void Sheets::for_cells(const SheetTriangle& t, F&& f) const {
  int64_t low[3], high[3];
  for (int a = 0; a < 3; ++a) {
    low[a] = static_cast<int64_t>(std::floor(double(t.low[a]) / cell_));
    high[a] = static_cast<int64_t>(std::floor(double(t.high[a]) / cell_));
  }
  for (int64_t i = low[0]; i <= high[0]; ++i)
    for (int64_t j = low[1]; j <= high[1]; ++j)
      for (int64_t k = low[2]; k <= high[2]; ++k)
        f(uint64_t(i) * 0x9E3779B97F4A7C15u + uint64_t(j) * 0xC2B2AE3D27D4EB4Fu +
          uint64_t(k) * 0x165667B19E3779F9u);
}

template <class F>
bool Sheets::any(const SheetTriangle& t, F&& f) const {
  bool found = false;
  if (alive_ > 0)
    for_cells(t, [&](uint64_t key) {
      const int32_t* first = chain_.find(key);
      for (int32_t c = first ? *first : -1; c >= 0 && !found; c = link_[size_t(c)].next) {
        const SheetTriangle& other = triangle_[size_t(link_[size_t(c)].triangle)];
        found = other.v[0] >= 0 && f(other);
      }
    });
  return found;
}

} // namespace molmesh::improve
