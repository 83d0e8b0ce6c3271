// mesh.hpp — a tetrahedral mesh, its validity and the quality of its elements: TetMesh, check_validity(),
// measure_quality().
#pragma once
#include "mesh/quality.hpp"
#include "mesh/tet_mesh.hpp"
#include "mesh/validity.hpp"
