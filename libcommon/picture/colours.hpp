// colours.hpp — the colours of pictures and pages: a ramp for measures, a list for labels.
#pragma once
#include "picture/image.hpp"
#include <array>

namespace molmesh::picture {

struct RampStop {
  double at; ///< 0 to 1
  Rgb colour;
};
/// From bad (dark red) over grays to good (pale): colours that no label has, each lighter than the one before, so
/// that they are told apart by those who do not see red, too.
inline constexpr std::array<RampStop, 4> quality_ramp{
    {{0, {110, 0, 40}}, {0.3, {118, 92, 98}}, {0.6, {158, 154, 154}}, {1, {204, 206, 202}}}};
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
