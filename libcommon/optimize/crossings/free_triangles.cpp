// free_triangles.cpp — chains of boxes by cell, and where each face's triangle is.
#include "optimize/crossings/free_triangles.hpp"
#include "base/error.hpp"
#include "par/pages.hpp"
#include <algorithm>
#include <utility>

namespace molmesh::optimize {
namespace {

// Whether such a plane of a has all of b on its other side, but for a corner that both have on the edge.
bool edge_parts(const std::vector<Vec3d>& point, const FreeTriangle& a, const FreeTriangle& b) {
  const auto at = [&](int32_t v) { return point[v]; };
  const Vec3d normal{double(a.normal.x), double(a.normal.y), double(a.normal.z)};
  for (size_t i = 0; i < 3; ++i) {
    const int32_t from = a.v[i], to = a.v[(i + 1) % 3], third = a.v[(i + 2) % 3];
    const Vec3d edge = at(to) - at(from), out = cross(edge, normal);
    const double rounding = 1e-10 * norm2(edge);
    const auto beyond = [&](int32_t v) { return dot(out, at(v) - at(from)); };
    if (beyond(third) < -rounding && std::all_of(b.v.begin(), b.v.end(), [&](int32_t v) {
          return v == from || v == to || beyond(v) > rounding;
        }))
      return true;
  }
  return false;
}

} // namespace

bool side_by_side(const std::vector<Vec3d>& point, const FreeTriangle& a, const FreeTriangle& b,
                  const Apart& apart) {
  return apart.of_first == 0 || apart.share_edge() || edge_parts(point, a, b) || edge_parts(point, b, a);
}

FreeTriangle free_triangle(const std::vector<Vec3d>& point, std::array<int32_t, 3> v, int64_t face) {
  const Vec3d a = point[v[0]], b = point[v[1]], c = point[v[2]];
  FreeTriangle t{box_around(a, b, c), v, face, {}};
  const Vec3d n = cross(b - a, c - a), unit = n / std::max(norm(n), 1e-300);
  t.normal = {static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)};
  return t;
}

void FreeTriangles::reserve(size_t triangles, int threads) {
  par::reserve_pages(triangle_, triangles, triangles / 4, threads);
  par::reserve_pages(eight_, triangles / 2, triangles / 8, threads); // they lie in some two cells and a half each
  face_.reserve(triangles);
}

void FreeTriangles::insert(const FreeTriangle& t) {
  if (eight_.size() + 27 > INT32_MAX)
    fail(Status::failed, "too many surface triangles to keep from crossing each other");
  if (const int32_t* const at = face_.find(uint64_t(t.face)); at && *at >= 0 && move(*at, t))
    return;
  erase(t.face);
  if (free_.empty()) {
    free_.push_back(static_cast<int32_t>(triangle_.size()));
    triangle_.emplace_back();
  }
  const int32_t id = free_.back();
  free_.pop_back();
  triangle_[id] = t;
  face_[uint64_t(t.face)] = id;
  levels_ |= uint64_t{1} << cell_level(t.low, t.high, cell_);
  for_cells(t, [&](uint64_t key, uint8_t begins) { put(chain_[key], id, begins); });
}

/// Most moves are short. False, and nothing done, where that needs other cells.
bool FreeTriangles::move(int32_t id, const FreeTriangle& t) {
  FreeTriangle& before = triangle_[id];
  const int level = cell_level(t.low, t.high, cell_);
  if (cell_level(before.low, before.high, cell_) != level || cells(before, level) != cells(t, level))
    return false;
  before = t;
  for_cells(t, [&](uint64_t key, uint8_t begins) {
    const int32_t* const first = chain_.find(key);
    for (int32_t c = first ? *first : -1; c >= 0; c = eight_[c].next)
      for (size_t n = 0; n < 8; ++n)
        if (Eight& e = eight_[c]; e.id[n] == id) {
          e.set_box(n, t);
          e.begins[n] = begins;
          return;
        }
  });
  return true;
}

void FreeTriangles::put(int32_t& chain, int32_t id, uint8_t begins) {
  constexpr int most_looked_at = 64; // eights of a cell, which a fan makes thousands of
  size_t n = 0;                      // where there is room
  int32_t at = chain;
  for (int looked_at = 0; at >= 0; at = eight_[at].next) {
    if (++looked_at > most_looked_at) {
      at = -1;
      break;
    }
    const auto& held = eight_[at].id;
    n = size_t(std::find(held.begin(), held.end(), -1) - held.begin());
    if (n < held.size())
      break;
  }
  if (at < 0) { // in front: what comes next finds room at once
    at = static_cast<int32_t>(eight_.size());
    eight_.emplace_back().next = chain;
    chain = at;
    n = 0;
  }
  eight_[at].set(n, id, triangle_[id]);
  eight_[at].begins[n] = begins;
}

void FreeTriangles::take_out(int32_t chain, int32_t id) {
  for (; chain >= 0; chain = eight_[chain].next)
    for (size_t n = 0; n < 8; ++n)
      if (Eight& e = eight_[chain]; e.id[n] == id) {
        e.set(n, -1, {});
        return;
      }
}

void FreeTriangles::erase(int64_t face) {
  int32_t& at = face_[uint64_t(face)];
  if (at < 0)
    return;
  const int32_t id = std::exchange(at, -1);
  FreeTriangle& t = triangle_[id];
  for_cells(t, [&](uint64_t key, uint8_t) { take_out(chain_[key], id); });
  t.face = -1;
  free_.push_back(id);
}

size_t FreeTriangles::boxes() const {
  size_t n = 0;
  for (const Eight& e : eight_)
    n += e.id.size() - size_t(std::count(e.id.begin(), e.id.end(), -1));
  return n;
}

FreeTriangleChanges FreeTriangles::changes() const {
  FreeTriangleChanges all;
  face_.for_each([&](uint64_t face, int32_t triangle) {
    if (triangle < 0)
      all.gone.push_back(int64_t(face));
    else
      all.there.push_back(triangle_[triangle]);
  });
  return all;
}

void FreeTriangles::move_along(FreeTriangleChanges& later) {
  std::erase_if(later.there, [&](const FreeTriangle& t) {
    const int32_t* const at = face_.find(uint64_t(t.face));
    return at && *at >= 0 && move(*at, t);
  });
}

void FreeTriangles::merge(const FreeTriangleChanges& later) {
  for (const int64_t face : later.gone)
    erase(face);
  for (const FreeTriangle& t : later.there)
    insert(t);
}

} // namespace molmesh::optimize
