// free_triangles.hpp — finds the triangles where a mesh ends in a curved surface by place, in hash grids of boxes.
// Nothing on the other side keeps such a triangle from crossing another one.
#pragma once
#include "base/large_array.hpp"
#include "base/open_table.hpp"
#include "geom/boxes.hpp"
#include "geom/cell_levels.hpp"
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace molmesh::optimize {

/// A triangle with its box when it was inserted.
struct FreeTriangle : Boxf {
  std::array<int32_t, 3> v{-1, -1, -1}; ///< seen from outside
  int64_t face = -1;                    ///< 4 element + face; -1: no longer there
  Vec3f normal;                         ///< unit

  /// Neighbours on a smooth surface run much the same way.
  bool runs_alike(const FreeTriangle& o, bool beside) const {
    return dot(normal, o.normal) > (beside ? 0.7f : 0.3f);
  }
};

/// Which vertices of either of two triangles the other has not, a bit each.
struct Apart {
  unsigned of_first = 7, of_second = 7;
  Apart(const std::array<int32_t, 3>& a, const std::array<int32_t, 3>& b) {
    for (unsigned i = 0; i < 3; ++i)
      for (unsigned j = 0; j < 3; ++j)
        if (a[i] == b[j])
          of_first &= ~(1u << i), of_second &= ~(1u << j);
  }
  bool beside() const { return of_first != 7; }
  /// std::has_single_bit is a call, as std::popcount (geom/bits.hpp).
  bool share_edge() const { return of_first == 1 || of_first == 2 || of_first == 4; }
};

/// Whether triangles that run much the same way are one, share an edge, or are clearly parted by a plane along the
/// normal of either through one of its edges: they do not cross then.
bool side_by_side(const std::vector<Vec3d>& point, const FreeTriangle& a, const FreeTriangle& b,
                  const Apart& apart);

/// Faces that have been inserted or erased.
struct FreeTriangleChanges {
  std::vector<FreeTriangle> there;
  std::vector<int64_t> gone;
};

FreeTriangle free_triangle(const std::vector<Vec3d>& point, std::array<int32_t, 3> v, int64_t face);

class FreeTriangles {
public:
  /// cell: size of the cells (Å); larger triangles get larger ones. A few edges of the triangles is best.
  explicit FreeTriangles(double cell) : cell_(cell) {}
  double cell() const { return cell_; }
  void reserve(size_t triangles, int threads); ///< of a surface
  /// Replaces what was known of that face.
  void insert(const FreeTriangle& t);
  void erase(int64_t face);
  /// Whether that face was ever inserted or erased.
  bool knows(int64_t face) const { return face_.find(uint64_t(face)) != nullptr; }
  /// All that was ever inserted or erased, as it is now.
  FreeTriangleChanges changes() const;
  /// Moves triangles that are known and stay in their cells, and takes them out of `later`. Threads may do so for
  /// different faces at once, while nothing else changes.
  void move_along(FreeTriangleChanges& later);
  void merge(const FreeTriangleChanges& later);
  size_t alive() const { return triangle_.size() - free_.size(); }
  size_t boxes() const; ///< that cells hold: 27 for each triangle at most
  /// True as soon as f(triangle) is, for the triangles whose boxes meet t, each once.
  template <class F>
  bool any(const Boxf& t, F&& f) const;

private:
  CellRange cells(const Boxf& t, int level) const { return cell_range(t.low, t.high, cell_size(cell_, level)); }
  /// f(key of the cell, axes on which it is the first), over the cells that hold t.
  template <class F>
  void for_cells(const Boxf& t, F&& f) const {
    const int level = cell_level(t.low, t.high, cell_);
    const CellRange range = cells(t, level);
    range.for_each([&](int64_t i, int64_t j, int64_t k) { f(cell_key(i, j, k, level), range.begins(i, j, k)); });
  }
  /// Of triangles: their places in triangle_.
  struct Eight : EightBoxes {
    std::array<uint8_t, 8> begins{}; ///< axes, a bit each, on which this is the first of the box's cells
    int32_t next = -1;
  };
  bool move(int32_t id, const FreeTriangle& t);
  void put(int32_t& chain, int32_t id, uint8_t begins);
  void take_out(int32_t chain, int32_t id);

  double cell_;
  std::vector<FreeTriangle, LargeAllocator<FreeTriangle>> triangle_;
  std::vector<int32_t> free_; ///< of triangle_
  uint64_t levels_ = 0;       ///< a bit each where there are or were triangles
  OpenTable chain_;           ///< of a cell: its first eight, -1: none; cells of one key share a chain
  OpenTable face_;            ///< of a face: its triangle, -1: gone
  std::vector<Eight, LargeAllocator<Eight>> eight_;
};

template <class F>
bool FreeTriangles::any(const Boxf& t, F&& f) const {
  bool found = false, all = false;
  if (alive() > 0)
    for_levels(levels_, [&](int level) {
      const CellRange range = cells(t, level);
      all = all || range.count() > 27 + double(triangle_.size()); // one far larger than those
      if (!all)
        range.for_each([&](int64_t i, int64_t j, int64_t k) {
          const int32_t* first = found ? nullptr : chain_.find(cell_key(i, j, k, level));
          const uint8_t begun = range.begins(i, j, k); // each box in the first of the cells that t shares with it
          for (int32_t c = first ? *first : -1; c >= 0 && !found; c = eight_[c].next) {
            const Eight& e = eight_[c];
            for (uint32_t met = e.met(t); met && !found; met &= met - 1) {
              const auto n = size_t(std::countr_zero(met));
              found = (begun | e.begins[n]) == 7 && f(triangle_[e.id[n]]);
            }
          }
        });
    });
  for (size_t n = 0; all && n < triangle_.size() && !found; ++n)
    found = triangle_[n].face >= 0 && t.meets(triangle_[n]) && f(triangle_[n]);
  return found;
}

} // namespace molmesh::optimize
