// contour_options.hpp — density2tet's options as the mesher's.
#pragma once
#include "base/error.hpp"
#include "cli/text.hpp"
#include "contour/options.hpp"
#include "tools/options/density2tet.hpp"
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace molmesh {

inline contour::BoxRequest parse_box(const std::string& text) {
  contour::BoxRequest box;
  if (text == "auto")
    return box;
  if (text == "tight") {
    box.kind = contour::BoxRequest::tight;
    return box;
  }
  const auto refuse = [&](const std::string& expected) {
    fail(Status::usage, "--box: found '" + text + "', expected " + expected);
  };
  constexpr double largest_bare = 10; // a number alone is a factor; what is larger was meant to be Å
  if (text.rfind('+', 0) == 0) {
    box.kind = contour::BoxRequest::padding;
    box.distance = cli::numbers("--box", text.substr(1), 1)[0];
    if (!(box.distance > 0))
      refuse("+ and a distance above 0 Å");
    return box;
  }
  if (std::count(text.begin(), text.end(), ',') == 0) {
    box.kind = contour::BoxRequest::factor;
    const bool times = !text.empty() && text.back() == 'x';
    box.scale = cli::numbers("--box", times ? text.substr(0, text.size() - 1) : text, 1)[0];
    if (!(box.scale > 1))
      refuse("a factor above 1");
    if (!times && box.scale > largest_bare)
      refuse(text + "x for that many times the surface's extents, +" + text +
             " for that many Å round it, or x0,y0,z0,x1,y1,z1");
    return box;
  }
  const std::vector<double> v = cli::numbers("--box", text, 6);
  box.kind = contour::BoxRequest::corners;
  box.lower = {v[0], v[1], v[2]};
  box.upper = {v[3], v[4], v[5]};
  for (int a = 0; a < 3; ++a)
    if (!(box.lower[a] < box.upper[a]))
      fail(Status::usage, "--box: found '" + text + "', expected x0 < x1, y0 < y1 and z0 < z1");
  return box;
}

inline std::optional<double> parse_adapt(const std::string& text) {
  if (text == "auto")
    return {};
  const double adapt = cli::numbers("--adapt", text, 1)[0];
  if (!(adapt >= 0 && adapt <= 100))
    fail(Status::usage, "--adapt: found '" + text + "', expected auto or a number from 0 to 100");
  return adapt;
}

inline contour::Options contour_options(const Options& o) {
  contour::Options options;
  options.meshed = o.region == "interior"   ? contour::Options::interior
                   : o.region == "exterior" ? contour::Options::exterior
                                            : contour::Options::both;
  options.box = parse_box(o.box);
  options.adapt = parse_adapt(o.adapt);
  options.fill_cavities = o.cavities == "fill";
  options.drop_below = o.drop_below;
  options.threads = o.resolved_threads();
  return options;
}

} // namespace molmesh
