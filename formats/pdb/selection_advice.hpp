// selection_advice.hpp — how residues are selected that somebody wrote in a way that gemmi's syntax does not have.
#pragma once
#include <string>

namespace molmesh::formats {

/// What to expect in place of a selection (without "around") that was refused: "names of residues in parentheses:
/// '//H/(ANS)'" for //H/ANS; numbers without names for //H/HIS57; "!" within the parentheses for !(NA). Empty where
/// none of these is meant.
std::string selection_advice(const std::string& selection);

} // namespace molmesh::formats
