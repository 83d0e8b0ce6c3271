// vtu_fuzz.cpp — a .vtu is refused with one line, or is a mesh in range that writes back to itself.
#include "base/error.hpp"
#include "formats/vtu/vtu.hpp"
#include <cstdlib>
#include <sstream>

using namespace molmesh;

namespace {

TetMesh read(const std::string& text) {
  std::istringstream in(text);
  return formats::read_vtu(in, "fuzz", nullptr, formats::CellArrays::keep);
}

template <class Cells>
void check(const TetMesh& m, const Cells& cells) {
  for (const auto& c : cells)
    for (const int32_t p : c)
      if (p < 0 || p >= static_cast<int64_t>(m.point.size()))
        std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  TetMesh m;
  try {
    m = read(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const Error& e) {
    if (std::string(e.what()).find('\n') != std::string::npos)
      std::abort();
    return 0;
  }
  check(m, m.tet);
  check(m, m.tri);
  const size_t cells = m.tet.size() + m.tri.size();
  if (m.tet.empty() || m.region.size() != m.tet.size() || m.boundary.size() != m.tri.size())
    std::abort();
  for (const CellArray& a : m.cell_array)
    if (a.integer.size() + a.real.size() != cells)
      std::abort();
  std::ostringstream once, twice;
  formats::write_vtu(once, m);
  formats::write_vtu(twice, read(once.str()));
  if (once.str() != twice.str())
    std::abort();
  return 0;
}
