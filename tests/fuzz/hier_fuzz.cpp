// hier_fuzz.cpp — a .hier is refused with one line, or holds what check() asks and writes back to itself.
#include "base/error.hpp"
#include "formats/hier/hier.hpp"
#include <cstdlib>
#include <sstream>

using namespace molmesh;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  Hierarchy h;
  try {
    h = formats::read_hier(in, "fuzz");
  } catch (const Error& e) {
    if (std::string(e.what()).find('\n') != std::string::npos)
      std::abort();
    return 0;
  }
  check(h, "fuzz");
  std::ostringstream once, twice;
  formats::write_hier(once, h);
  std::istringstream back(once.str());
  formats::write_hier(twice, formats::read_hier(back, "back"));
  if (once.str() != twice.str())
    std::abort();
  return 0;
}
