// optimize.hpp — a tetrahedral mesh to one of better elements: optimize::improve().
#pragma once
#include "optimize/optimize.hpp"
