// run_reports.hpp — finds which run reports (REPORTv1.md) tell how a mesh was made.
#pragma once
#include <string>
#include <vector>

namespace molmesh::formats {

struct RunReport {
  std::string json;               ///< the whole object
  std::vector<std::string> input; ///< base names of the files that it read
  std::string output;             ///< base name
};

/// Throws Error(bad_input), which names `file`, for what is no run report.
RunReport read_run_report(const std::string& text, const std::string& file);

/// Those of the run that wrote the mesh and of the runs that wrote what it read, and so on: first the first of the
/// chain. only_one: the page is about this mesh alone, and so are runs that name no file of the chain.
std::vector<std::string> runs_of(const std::vector<RunReport>& runs, const std::string& mesh, bool only_one);

} // namespace molmesh::formats
