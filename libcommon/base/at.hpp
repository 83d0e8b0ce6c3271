// at.hpp — signed indices into standard containers.
#pragma once
#include "base/hd.hpp"
#include <cstddef>
#include <cstdint>

namespace molmesh {

HD constexpr size_t at(int64_t i) {
  return static_cast<size_t>(i);
}

} // namespace molmesh
