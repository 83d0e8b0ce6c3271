// vtu_fuzz.cpp — a .vtu is refused with one line, or is a mesh in range that writes back to itself.
#include "mesh_round_trip.hpp"

using namespace molmesh;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto read = [](const std::string& text) {
    std::istringstream in(text);
    return formats::read_vtu(in, "fuzz", nullptr, formats::CellArrays::keep);
  };
  return round_trip(data, size, read, read);
}
