// colours.hpp — the colours of pictures and pages: a ramp for measures, a list for labels.
#pragma once
#include "picture/image.hpp"
#include <array>

namespace molmesh::picture {

struct RampStop {
  double at; ///< 0 to 1
  Rgb colour;
};
/// From bad (red) over pale yellow to good (blue): told apart by those who do not see red or green, too.
inline constexpr std::array<RampStop, 5> quality_ramp{{{0, {178, 34, 34}},
                                                       {0.25, {236, 131, 60}},
                                                       {0.5, {247, 225, 150}},
                                                       {0.75, {127, 178, 190}},
                                                       {1, {38, 107, 150}}}};
/// x from 0 to 1; beyond, the ends.
inline Rgb ramp_colour(double x) {
  size_t i = 1;
  while (i + 1 < quality_ramp.size() && quality_ramp[i].at < x)
    ++i;
  const RampStop &a = quality_ramp[i - 1], &b = quality_ramp[i];
  const double share = (x - a.at) / (b.at - a.at);
  return mixed(a.colour, b.colour, share < 0 ? 0 : share > 1 ? 1 : share);
}

inline constexpr std::array<Rgb, 12> label_list{{{78, 121, 167},
                                                 {237, 145, 60},
                                                 {98, 164, 92},
                                                 {208, 96, 94},
                                                 {146, 116, 178},
                                                 {150, 112, 90},
                                                 {110, 184, 190},
                                                 {216, 180, 70},
                                                 {196, 120, 160},
                                                 {122, 138, 62},
                                                 {92, 92, 140},
                                                 {170, 170, 176}}};
inline constexpr Rgb no_label{198, 203, 209}, plain{205, 196, 182}, white{255, 255, 255}, ink{34, 38, 45};

/// Of the i-th label, from 0. Each time the list begins anew it is lighter or darker.
inline Rgb label_colour(int64_t i) {
  if (i < 0)
    return no_label;
  const Rgb c = label_list[static_cast<size_t>(i) % label_list.size()];
  switch (static_cast<size_t>(i) / label_list.size() % 3) {
  case 1:
    return mixed(c, white, 0.4);
  case 2:
    return mixed(c, ink, 0.35);
  default:
    return c;
  }
}

} // namespace molmesh::picture
