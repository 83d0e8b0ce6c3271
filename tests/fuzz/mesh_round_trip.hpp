// mesh_round_trip.hpp — what holds of every mesh that a reader accepts: it is in range, and writes back to itself
// as .vtu.
#pragma once
#include "base/error.hpp"
#include "formats/vtu/vtu.hpp"
#include <cstdlib>
#include <sstream>
#include <string>

namespace molmesh {

/// read(text): a mesh; it throws Error(bad_input) with one line. again(text): that of a .vtu which we wrote.
template <class Read, class Again>
int round_trip(const uint8_t* data, size_t size, const Read& read, const Again& again) {
  TetMesh m;
  try {
    m = read(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const Error& e) {
    if (e.status != Status::bad_input || std::string(e.what()).find('\n') != std::string::npos)
      std::abort();
    return 0;
  }
  const auto check = [&](const auto& cells) {
    for (const auto& c : cells)
      for (const int32_t p : c)
        if (p < 0 || p >= static_cast<int64_t>(m.point.size()))
          std::abort();
  };
  check(m.tet);
  check(m.tri);
  if (m.tet.empty() || m.region.size() != m.tet.size() || m.boundary.size() != m.tri.size())
    std::abort();
  for (const CellArray& a : m.cell_array)
    if (a.integer.size() + a.real.size() != m.tet.size() + m.tri.size())
      std::abort();
  std::ostringstream once, twice;
  formats::write_vtu(once, m);
  formats::write_vtu(twice, again(once.str()));
  if (once.str() != twice.str())
    std::abort();
  return 0;
}

} // namespace molmesh
