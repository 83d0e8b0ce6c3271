// plan_fuzz.cpp — a plan of densities is refused with one line, or every copy's motion is a rotation.
#include "base/error.hpp"
#include "formats/plan/plan.hpp"
#include <cstdlib>
#include <sstream>

using namespace molmesh;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  try {
    for (const formats::PlanPiece& p : formats::read_plan(in, "fuzz")) {
      if (p.file.empty() || p.copies.empty())
        std::abort();
      for (const Rigid& m : p.copies)
        if (!is_rotation(m, 1e-6))
          std::abort();
    }
  } catch (const Error& e) {
    if (std::string(e.what()).find('\n') != std::string::npos || e.status != Status::bad_input)
      std::abort();
  }
  return 0;
}
