// work.hpp — what a pass over arrays has to do.
#pragma once

namespace molmesh::par {

/// The least, for its share of the machine's peak: bytes of memory moved at least once, multiply-adds in single or
/// double precision.
struct Work {
  double bytes = 0, multiply_adds = 0;
  bool in_double = false;
};

} // namespace molmesh::par
