// contour.hpp — a density to a tetrahedral mesh: contour::contour().
#pragma once
#include "contour/contour.hpp"
