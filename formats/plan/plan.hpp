// plan.hpp — reads a plan of densities: one line a piece, with its file and its places (PLAN.md).
#pragma once
#include "geom/rigid.hpp"
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace molmesh::formats {

struct PlanPiece {
  std::string file;
  std::vector<Rigid> copies = {Rigid{}}; ///< at least one
  bool subtract = false;
  std::string where; ///< for messages: "FILE:LINE"
};

/// FILE KEY=VALUE …, what stands behind `piece`. Throws Error(bad_input).
PlanPiece parse_piece(std::string_view text, const std::string& where);
/// Names of files are those beside the plan, unless they begin with "/" or the plan is none. Throws
/// Error(bad_input) "FILE:LINE: found, expected", also where there is no piece.
std::vector<PlanPiece> read_plan(std::istream& in, const std::string& file);

} // namespace molmesh::formats
