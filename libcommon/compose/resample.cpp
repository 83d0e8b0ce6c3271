// resample.cpp — values at the moved grid's points, block by block, and how well they lead back.
#include "compose/resample.hpp"
#include "base/error.hpp"
#include "compose/draft.hpp"
#include "compose/interpolant.hpp"
#include "par/pages.hpp"
#include "par/par.hpp"
#include <algorithm>
#include <cmath>

namespace molmesh::compose {
namespace {

Vec3i rounded(Vec3d u) {
  return {static_cast<int32_t>(std::lround(u.x)), static_cast<int32_t>(std::lround(u.y)),
          static_cast<int32_t>(std::lround(u.z))};
}
Vec3i lower(Vec3d u) {
  return {static_cast<int32_t>(std::floor(u.x)), static_cast<int32_t>(std::floor(u.y)),
          static_cast<int32_t>(std::floor(u.z))};
}

/// From one lattice's indices to the other's.
class Map {
public:
  Map(const GridFrame& from, const Rigid& place, Vec3d origin)
      : to_(place), back_(index_motion(from, place, origin)) {
    to_.t = (place(from.origin) - origin) / from.spacing;
  }
  Vec3d there(Vec3d u) const { return to_(u); }
  Vec3d back(Vec3d u) const { return back_(u); }

private:
  Rigid to_, back_;
};

/// The box, in the other lattice, of a box of indices and `more` spacings round it.
void moved_box(const Map& map, Vec3d lo, Vec3d hi, double more, Vec3i& first, Vec3i& last) {
  Vec3d least{1e300, 1e300, 1e300}, most{-1e300, -1e300, -1e300};
  for (int k = 0; k < 8; ++k) {
    const Vec3d p = map.there({k & 1 ? hi.x : lo.x, k & 2 ? hi.y : lo.y, k & 4 ? hi.z : lo.z});
    for (int a = 0; a < 3; ++a) {
      least[a] = std::min(least[a], p[a]);
      most[a] = std::max(most[a], p[a]);
    }
  }
  first = lower(least - Vec3d{more, more, more});
  last = lower(most + Vec3d{more + 1, more + 1, more + 1});
}

GridFrame moved_frame(const GridFrame& f, const Map& map, Vec3d origin) {
  Vec3i first, last;
  moved_box(map, to_double(f.lower), to_double(f.lower + f.points - Vec3i{1, 1, 1}), 0, first, last);
  return {origin, f.spacing, first, last - first + Vec3i{1, 1, 1}};
}

/// What a point that maps to u holds, and whether that is a value.
struct Sample {
  float value;
  bool known;
};
Sample sample(const Interpolant& from, const FieldInfo& info, Vec3d u) {
  const Vec3i cell = lower(u);
  const int side = from.side(cell);
  Interpolant::Value v;
  if (!from.fit(u, v)) {
    const bool inside = side != 0 ? side > 0 : from.inside(rounded(u));
    return {inside ? static_cast<float>(info.inside_value) : 0.0f, false};
  }
  // A fit may not turn over what the cell tells: its side, and that it is no band cell.
  const double lower = std::log(info.band_lower / info.isovalue), upper = std::log(info.band_upper / info.isovalue);
  if (!from.whole(cell)) {
    constexpr double beyond = 1e-3;
    v.f = side > 0 ? std::max(v.f, upper + beyond) : std::min(v.f, lower - beyond);
  } else if (side * v.f < 0) {
    v.f = side > 0 ? 0.5 * upper : 0.5 * lower;
  }
  return {static_cast<float>(info.isovalue * std::exp(std::clamp(v.f, -60.0, 60.0))), true};
}

ResamplingError measure(const BlockGrid& grid, const BlockGrid& moved, const Map& map, int threads) {
  const Interpolant back(moved, threads);
  constexpr int64_t samples = 20'000;
  const auto slots = static_cast<int64_t>(grid.value.size());
  const int64_t step = std::max<int64_t>(1, slots / (20 * samples)) | 1;
  struct Difference {
    double value, distance;
  };
  std::vector<Difference> d(static_cast<size_t>((slots + step - 1) / step), {-1, 0});
  par::for_n(static_cast<int64_t>(d.size()), threads, 256, [&](int64_t i) {
    const int64_t at = i * step, b = at / 512;
    const int s = static_cast<int>(at % 512);
    const double g = grid.value[at];
    if (!(grid.active[8 * b + (s >> 6)] >> (s & 63) & 1) || g < grid.info.band_lower || g > grid.info.band_upper)
      return;
    Interpolant::Value v;
    if (!back.fit(map.there(to_double(grid.corner[b] + within_block(s))), v))
      return;
    const double other = grid.info.isovalue * std::exp(v.f), slope = norm(v.gradient) / grid.frame.spacing;
    d[i].value = std::abs(other - g) / std::max(1.0, g);
    d[i].distance = slope > 0 ? std::abs(std::log(other / g)) / slope : 0;
  });
  ResamplingError e;
  std::vector<double> distance;
  for (const Difference& one : d)
    if (one.value >= 0) {
      e.value = std::max(e.value, one.value);
      distance.push_back(one.distance);
    }
  std::sort(distance.begin(), distance.end());
  if (!distance.empty()) {
    e.distance = distance.back();
    e.distance_99 = distance[(distance.size() - 1) * 99 / 100];
  }
  return e;
}

} // namespace

Rigid index_motion(const GridFrame& grid, const Rigid& place, Vec3d origin) {
  Rigid back;
  for (int a = 0; a < 3; ++a)
    back.row[a] = {place.row[0][a], place.row[1][a], place.row[2][a]};
  back.t = -back.turned(place.t);
  back.t = (back(origin) - grid.origin) / grid.spacing;
  return back;
}

BlockGrid resample(const BlockGrid& grid, const Rigid& place, Vec3d origin, int threads, ResamplingError& error) {
  const Map map(grid.frame, place, origin);
  Draft draft;
  draft.frame = moved_frame(grid.frame, map, origin);
  draft.info = grid.info;
  std::vector<Vec3i>& corner = draft.corner;
  const auto touch = [&](Vec3i block, double more, std::vector<Vec3i>& to) {
    Vec3i first, last;
    moved_box(map, to_double(block), to_double(block + Vec3i{7, 7, 7}), more, first, last);
    first = block_corner(first);
    for (int32_t x = first.x; x <= last.x; x += 8)
      for (int32_t y = first.y; y <= last.y; y += 8)
        for (int32_t z = first.z; z <= last.z; z += 8)
          to.push_back({x, y, z});
  };
  for (const Vec3i c : grid.corner)
    touch(c, 3, corner); // as far as fit() looks
  std::vector<Vec3i> touched;
  for (const Vec3i c : grid.inside)
    touch(c, 1, touched);
  par::sort_unique(corner, threads);
  par::sort_unique(touched, threads);
  const Interpolant from(grid, threads);
  const Vec3i lo = draft.frame.lower, hi = lo + draft.frame.points;
  for (const Vec3i c : touched)
    if (!std::binary_search(corner.begin(), corner.end(), c) && from.inside(rounded(map.back(to_double(c)))))
      draft.inside.push_back(c);
  const auto n = static_cast<int64_t>(corner.size());
  par::resize_pages(draft.value, static_cast<size_t>(512 * n), threads);
  par::resize_pages(draft.known, static_cast<size_t>(8 * n), threads);
  par::for_n(n, threads, 16, [&](int64_t b) {
    std::fill_n(&draft.known[8 * b], 8, uint64_t{0});
    for (int s = 0; s < 512; ++s) {
      const Vec3i p = corner[b] + within_block(s);
      float& value = draft.value[512 * b + s];
      value = 0;
      if (p.x < lo.x || p.y < lo.y || p.z < lo.z || p.x >= hi.x || p.y >= hi.y || p.z >= hi.z)
        continue;
      const Sample here = sample(from, grid.info, map.back(to_double(p)));
      value = here.value;
      draft.known[8 * b + (s >> 6)] |= uint64_t{here.known} << (s & 63);
    }
  });
  int64_t unknown = 0;
  BlockGrid moved = finish(std::move(draft), threads, unknown);
  if (unknown > 0)
    fail(Status::failed, "resampling left " + std::to_string(unknown) +
                             " corners of cells in the band without a value: expected a wider band");
  error = measure(grid, moved, map, threads);
  return moved;
}

} // namespace molmesh::compose
