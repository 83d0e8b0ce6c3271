// density.hpp — atoms to a density on a sparse grid: Hierarchy, density::compute(), to_block_grid().
#pragma once
#include "density/density.hpp"
#include "grid/band.hpp"
#include "molecule/hierarchy.hpp"
