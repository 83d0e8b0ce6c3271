// map_fuzz.cpp — a CCP4/MRC or OpenDX map is refused with one line, or holds as many finite values as points.
#include "base/error.hpp"
#include "formats/map/read_map.hpp"
#include <cmath>
#include <cstdlib>
#include <string>

using namespace molmesh;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    const compose::DenseMap m = formats::read_map(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
    if (m.value.size() != static_cast<size_t>(int64_t{m.points.x} * m.points.y * m.points.z) ||
        !(std::abs(m.volume_of_cell()) > 0))
      std::abort();
    for (const float v : m.value)
      if (!std::isfinite(v))
        std::abort();
  } catch (const Error& e) {
    if (std::string(e.what()).find('\n') != std::string::npos || e.status != Status::bad_input)
      std::abort();
  }
  return 0;
}
