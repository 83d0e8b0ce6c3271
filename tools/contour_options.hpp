// contour_options.hpp — density2tet's options as the mesher's.
#pragma once
#include "base/error.hpp"
#include "cli/text.hpp"
#include "contour/options.hpp"
#include "tools/box_request.hpp"
#include "tools/element_limit.hpp"
#include "tools/options/density2tet.hpp"
#include <optional>
#include <string>

namespace molmesh {

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
  options.meshed = meshed_of(o.region);
  options.box = parse_box(o.box);
  if (options.box.is_sphere() && options.meshed == contour::Options::interior)
    fail(Status::usage, "--box: found '" + o.box +
                            "' with --region interior, which ends at the molecule's surface, "
                            "expected --region exterior or both");
  options.adapt = parse_adapt(o.adapt);
  if (o.elements > 0 && options.adapt)
    fail(Status::usage, "--elements excludes --adapt, which it chooses, expected one of them");
  if (!o.size.empty() && options.adapt == 0)
    fail(Status::usage, "--size excludes --adapt 0, of whose cells all have the grid's spacing");
  options.fill_cavities = o.cavities == "fill";
  options.drop_below = o.drop_below;
  options.threads = o.resolved_threads();
  return options;
}

} // namespace molmesh
