// tile.hpp — the option --tile of hier2density, and what tells tiles of one run from those of another.
#pragma once
#include "density/density.hpp"
#include "molecule/digest.hpp"
#include "molecule/words.hpp"
#include <cmath>
#include <string>

namespace molmesh {

inline Tile tile_of(const std::string& text, bool on_device) {
  constexpr double most = 1e6;
  const size_t slash = text.find('/');
  const auto number = [&](const std::string& digits) {
    const double n = decimal(digits).value_or(0);
    return n >= 1 && n <= most && std::floor(n) == n ? static_cast<int32_t>(n) : 0;
  };
  const bool two = slash != std::string::npos;
  const Tile t{number(text.substr(0, slash)), two ? number(text.substr(slash + 1)) : 0};
  if (!(1 <= t.number && t.number <= t.count))
    fail(Status::usage, "--tile: found '" + text + "', expected I/N with 1 <= I <= N <= 1000000");
  if (on_device && !t.whole())
    fail(Status::usage, "--tile: found " + text + ", expected --mode omp or seq with it");
  return t;
}

/// Of what the values depend on besides what the file says.
inline int64_t digest_of(const Hierarchy& h, const density::Options& d) {
  return static_cast<int64_t>(digest(digest(digest(h), d.full_search), d.atoms == density::AtomSearch::all));
}

} // namespace molmesh
