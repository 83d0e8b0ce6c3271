// quality_kernel.hpp — tet_quality of eight elements, vectorized for the best instruction set of this machine.
#pragma once

namespace molmesh::improve {

/// Corner i of eight elements at [i][0 … 7].
struct alignas(64) EightElements {
  double x[4][8], y[4][8], z[4][8];
};

/// As tet_quality, to the last bit.
void qualities(const EightElements& e, float (&quality)[8]);

} // namespace molmesh::improve
