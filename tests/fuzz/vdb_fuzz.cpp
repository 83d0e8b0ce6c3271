// vdb_fuzz.cpp — a .vdb is refused with one line, or is a grid that writes back to itself.
#include "base/error.hpp"
#include "formats/vdb/vdb.hpp"
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <sstream>

using namespace molmesh;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  try {
    const BlockGrid grid = formats::read_vdb(in, "fuzz");
    const size_t blocks = grid.corner.size();
    if (grid.value.size() != 512 * blocks || grid.active.size() != 8 * blocks)
      std::abort();
    std::stringstream written;
    formats::write_vdb(written, grid);
    const BlockGrid back = formats::read_vdb(written, "back");
    const auto same = [](float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0; };
    if (back.corner != grid.corner || back.inside != grid.inside || back.active != grid.active ||
        !(back.frame.points == grid.frame.points) ||
        !std::equal(grid.value.begin(), grid.value.end(), back.value.begin(), back.value.end(), same))
      std::abort();
  } catch (const Error& e) {
    if (std::string(e.what()).find('\n') != std::string::npos)
      std::abort();
  }
  return 0;
}
