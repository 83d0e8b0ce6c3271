// distance.hpp — atoms to the distance from a molecular surface on a sparse grid: distance::compute().
#pragma once
#include "distance/distance.hpp"
