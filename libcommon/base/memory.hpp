// memory.hpp — measures the memory at hand and limits the process to it.
#pragma once
#include "base/control_groups.hpp"
#include <cstdint>

namespace molmesh {

enum class Swap { counts, is_no_use }; ///< no use: to memory that stays where it is

/// Bytes that the system has at hand, or the least that a control group around this process grants. -1: not known.
int64_t memory_at_hand(const SystemFiles& system = {}, Swap swap = Swap::counts);

/// Bytes that this process had in use at the most; -1: not known. Unlike getrusage() it leaves out the process that
/// started this one.
int64_t peak_memory(const SystemFiles& system = {});

/// From here on asking for more is std::bad_alloc, a line and a status, where the system would grant it and kill
/// the process as it is used. The stacks of that many threads, of which little is used, come on top. Nothing
/// happens where memory is not known or where that much is mapped already, as by a sanitizer.
void limit_memory(int threads);
/// As it was before limit_memory(), for a library that sets aside addresses beyond any memory.
void lift_memory_limit();

} // namespace molmesh
