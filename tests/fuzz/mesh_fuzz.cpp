// mesh_fuzz.cpp — a mesh of any format is refused with one line, or is in range and writes back to itself as .vtu.
#include "formats/mesh/read_mesh.hpp"
#include "mesh_round_trip.hpp"

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

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return round_trip(
      data, size, [&](const std::string& text) { return read(text, size % 2 == 1); },
      [](const std::string& text) { return read(text, false); });
}
