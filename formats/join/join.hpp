// join.hpp — reader of .join, version 1 (JOINv1.md): which pieces make a hierarchy, and where they go.
#pragma once
#include "molecule/exponents.hpp"
#include "molecule/join.hpp"
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace molmesh::formats {

struct JoinPlan {
  std::vector<Piece> piece;              ///< in the order of the file, hierarchies not yet read
  std::vector<std::string> file;         ///< [pieces] as the plan has it; of a body its name
  std::vector<std::optional<Body>> body; ///< [pieces] in place of a file
  std::vector<Rule> rule;
};

/// The rigid motions of an assembly in a structure file; where: for messages.
using AssemblyReader =
    std::function<std::vector<Rigid>(const std::string& file, const std::string& id, const std::string& where)>;

/// Throws Error(bad_input) "FILE:LINE: found, expected"; `file` names the stream.
JoinPlan read_join(std::istream& in, const std::string& file, const AssemblyReader& assembly);

} // namespace molmesh::formats
