// mesh_fuzz.cpp — a mesh of any format is refused with one line, or is in range and writes back to itself as .vtu.
#include "base/error.hpp"
#include "formats/mesh/read_mesh.hpp"
#include <cstdlib>
#include <sstream>

using namespace molmesh;

namespace {

TetMesh read(const std::string& text, bool merge) {
  std::istringstream in(text);
  formats::MeshReading as;
  as.arrays = formats::CellArrays::keep;
  as.merge_points = merge;
  formats::MeshNotes notes;
  TetMesh m = formats::read_mesh(in, "fuzz", as, notes);
  for (const std::string& line : described(notes))
    if (line.size() > 10000)
      std::abort();
  return m;
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
    const std::string text(reinterpret_cast<const char*>(data), size);
    m = read(text, size % 2 == 1);
  } catch (const Error& e) {
    if (e.status != Status::bad_input || std::string(e.what()).find('\n') != std::string::npos)
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
  formats::write_vtu(twice, read(once.str(), false));
  if (once.str() != twice.str())
    std::abort();
  return 0;
}
