// tile_test.cpp — slabs of a grid against every index of its longest axis.
#include "grid/tile.hpp"
#include <catch2/catch.hpp>

using namespace molmesh;

TEST_CASE("every layer of blocks of a grid is in one tile, along the longest axis, in order") {
  for (const Vec3i points : {Vec3i{100, 300, 299}, Vec3i{33, 33, 33}, Vec3i{2, 5, 31}, Vec3i{64, 64, 128}})
    for (const Vec3i lower : {Vec3i{0, 0, 0}, Vec3i{-5, 7, -45}})
      for (const int32_t count : {1, 2, 3, 7, 40}) {
        GridFrame frame;
        frame.points = points;
        frame.lower = lower;
        int axis = 0;
        for (int a = 1; a < 3; ++a)
          axis = points[a] > points[axis] ? a : axis;
        int64_t all = 0;
        for (int32_t at = lower[axis]; at < lower[axis] + points[axis]; ++at) {
          int found = 0;
          for (int32_t number = 1; number <= count; ++number) {
            const Slab s = slab_of(frame, {number, count});
            REQUIRE(s.axis == axis);
            Vec3i block;
            block[axis] = at & ~7;
            found += s.contains(block);
          }
          REQUIRE(found == 1);
        }
        for (int32_t number = 1; number <= count; ++number) {
          const Slab s = slab_of(frame, {number, count});
          CHECK((s.begin - (lower[axis] & ~7)) % tile_layer * (s.begin < s.end) == 0);
          all += points_of(frame, s);
        }
        CHECK(all == int64_t{points.x} * points.y * points.z);
      }
}
