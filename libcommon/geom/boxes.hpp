// boxes.hpp — boxes in single precision, rounded outwards, one at a time and eight side by side for searches
// that look at many and meet few.
#pragma once
#include "geom/vec.hpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace molmesh {

struct Boxf {
  /// At first it meets none.
  Vec3f low{HUGE_VALF, HUGE_VALF, HUGE_VALF}, high{-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};

  void add(const Boxf& o) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], o.low[k]);
      high[k] = std::max(high[k], o.high[k]);
    }
  }
  bool meets(const Boxf& o) const {
    for (int k = 0; k < 3; ++k)
      if (low[k] > o.high[k] || high[k] < o.low[k])
        return false;
    return true;
  }
};

/// Of a triangle.
inline Boxf box_around(Vec3d a, Vec3d b, Vec3d c) {
  constexpr auto most = std::numeric_limits<float>::max();
  const auto nearest = [](double x) { return static_cast<float>(std::clamp<double>(x, -most, most)); };
  const auto margin = [](float x) { return std::abs(x) * 0x1p-23f + 0x1p-126f; }; // the next float or the one after
  Boxf box;
  for (int k = 0; k < 3; ++k) {
    const float low = nearest(std::min({a[k], b[k], c[k]})), high = nearest(std::max({a[k], b[k], c[k]}));
    box.low[k] = low - margin(low);
    box.high[k] = high + margin(high);
  }
  return box;
}

struct EightBoxes {
  std::array<std::array<float, 8>, 3> low, high;
  std::array<int32_t, 8> id; ///< the caller's; -1: none, and nothing meets it

  EightBoxes() {
    id.fill(-1);
    for (size_t n = 0; n < 8; ++n)
      set_box(n, {});
  }
  void set(size_t n, int32_t its, const Boxf& box) {
    id[n] = its;
    set_box(n, box);
  }
  void set_box(size_t n, const Boxf& box) {
    for (size_t k = 0; k < 3; ++k) {
      low[k][n] = box.low[int(k)];
      high[k][n] = box.high[int(k)];
    }
  }
  /// Of all of them.
  Boxf bounds() const {
    Boxf all;
    for (size_t k = 0; k < 3; ++k)
      for (size_t n = 0; n < 8; ++n) {
        all.low[int(k)] = std::min(all.low[int(k)], low[k][n]);
        all.high[int(k)] = std::max(all.high[int(k)], high[k][n]);
      }
    return all;
  }
  /// Those that meet the box, a bit each.
  uint32_t met(const Boxf& box) const;
};

inline uint32_t EightBoxes::met(const Boxf& box) const {
  // Vectors that any x86-64 has: left to itself g++ takes none here.
  typedef float Four __attribute__((vector_size(16)));
  typedef int32_t FourInts __attribute__((vector_size(16)));
  const auto load = [](auto& into, const auto* from) { std::memcpy(&into, from, sizeof into); };
  uint32_t bits = 0;
  for (size_t first = 0; first < 8; first += 4) {
    FourInts taken;
    load(taken, &id[first]);
    FourInts meet = taken >= FourInts{};
    for (size_t k = 0; k < 3; ++k) {
      const float from = box.low[int(k)], to = box.high[int(k)];
      Four lows, highs;
      load(lows, &low[k][first]);
      load(highs, &high[k][first]);
      meet &= lows <= Four{to, to, to, to};
      meet &= highs >= Four{from, from, from, from};
    }
    meet &= FourInts{1, 2, 4, 8};
    bits |= static_cast<uint32_t>(meet[0] | meet[1] | meet[2] | meet[3]) << first;
  }
  return bits;
}

} // namespace molmesh
