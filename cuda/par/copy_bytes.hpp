// copy_bytes.hpp — copies memory by the host's threads, for files that are compiled without OpenMP.
#pragma once
#include <cstddef>
#include <cstdint>

namespace molmesh::cuda {

/// Regions do not overlap.
void copy_bytes(const std::byte* from, int64_t bytes, std::byte* to, int threads);

} // namespace molmesh::cuda
