// sheets.hpp — the triangles where a mesh ends in a curved surface, by place: hash grids of their boxes.
// Nothing on the other side keeps such a triangle from crossing another sheet of the surface.
#pragma once
#include "geom/vec.hpp"
#include "improve/cell_levels.hpp"
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
  /// Cells of this size (Å), larger ones for larger triangles.
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
  size_t links() const { return link_.size(); } ///< of records to cells: 27 a record at most
  /// True as soon as f(triangle) is, over all whose boxes t's meets, and others; some more than once.
  template <class F>
  bool any(const SheetTriangle& t, F&& f) const;

private:
  struct Link {
    int32_t triangle, next;
  };
  CellRange cells(const SheetTriangle& t, int level) const {
    return cell_range(t.low, t.high, cell_size(cell_, level));
  }

  double cell_;
  std::vector<SheetTriangle> triangle_;
  size_t alive_ = 0;
  uint64_t levels_ = 0; ///< a bit each where there are triangles
  OpenTable chain_;     ///< of a cell: its first link, -1: none; cells of one key share a chain
  OpenTable face_;      ///< of a face: its triangle, -1: gone
  std::vector<Link> link_;
};

template <class F>
bool Sheets::any(const SheetTriangle& t, F&& f) const {
  bool found = false, all = false;
  const auto visit = [&](const SheetTriangle& other) { found = found || (other.v[0] >= 0 && f(other)); };
  if (alive_ > 0)
    for_levels(levels_, [&](int level) {
      const CellRange range = cells(t, level);
      all = all || range.count() > 27 + double(triangle_.size()); // one far larger than those
      if (!all)
        range.for_each([&](int64_t i, int64_t j, int64_t k) {
          const int32_t* first = chain_.find(cell_key(i, j, k, level));
          for (int32_t c = first ? *first : -1; c >= 0 && !found; c = link_[size_t(c)].next)
            visit(triangle_[size_t(link_[size_t(c)].triangle)]);
        });
    });
  if (all)
    for (const SheetTriangle& other : triangle_)
      visit(other);
  return found;
}

} // namespace molmesh::improve
