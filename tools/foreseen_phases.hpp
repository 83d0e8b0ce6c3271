// foreseen_phases.hpp — when the phases of density2tet begin, as shares of its whole time.
#pragma once
#include "cli/phase_line.hpp"

namespace molmesh {

/// Of meshes of both sides at 0.5 Å, and about of others: relaxation takes two thirds.
inline std::vector<cli::ForeseenPhase> foreseen_phases() {
  return {{"read", 0},       {"surface cells", 0.01}, {"octree", 0.03},  {"dual vertices", 0.07},
          {"elements", 0.1}, {"relaxation", 0.25},    {"regions", 0.93}, {"assembly", 0.95},
          {"write", 0.97}};
}

} // namespace molmesh
