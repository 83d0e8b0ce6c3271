// run_reports.cpp — goes back from a mesh, from output to inputs.
#include "formats/html/run_reports.hpp"
#include "base/error.hpp"
#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace molmesh::formats {
namespace {

using json = nlohmann::ordered_json;

std::string base_name(const std::string& path) {
  return path.substr(path.rfind('/') + 1);
}

} // namespace

RunReport read_run_report(const std::string& text, const std::string& file) {
  const json j = json::parse(text, nullptr, false);
  const auto is_text = [&](const char* key) { return j.contains(key) && j[key].is_string(); };
  if (!j.is_object() || !is_text("tool") || !is_text("version") || !is_text("input") || !is_text("output"))
    fail_input(file + ": found no run report, expected a JSON object with tool, version, input and output");
  json kept; // what the page shows; times of other machines are as good as any
  for (const char* key :
       {"tool", "version", "mode", "threads", "input", "output", "options", "phases", "counts", "peak_rss_bytes"})
    if (j.contains(key))
      kept[key] = j[key];
  RunReport r{
      kept.dump(-1, ' ', false, json::error_handler_t::replace), {base_name(j["input"])}, base_name(j["output"])};
  if (j.contains("options") && j["options"].is_object())
    for (const auto& [name, value] : j["options"].items())
      if (value.is_string()) // --density and the like
        r.input.push_back(base_name(value));
  return r;
}

std::vector<std::string> runs_of(const std::vector<RunReport>& runs, const std::string& mesh, bool only_one) {
  std::vector<size_t> found; // the last of the chain first
  std::set<std::string> wanted{base_name(mesh)};
  for (bool more = true; more;) {
    more = false;
    for (size_t i = runs.size(); i-- > 0;)
      if (wanted.count(runs[i].output) > 0 && std::count(found.begin(), found.end(), i) == 0) {
        found.push_back(i);
        wanted.insert(runs[i].input.begin(), runs[i].input.end());
        more = true;
        break;
      }
  }
  std::vector<std::string> all;
  if (only_one)
    for (size_t i = 0; i < runs.size(); ++i)
      if (std::count(found.begin(), found.end(), i) == 0)
        all.push_back(runs[i].json);
  for (size_t i = found.size(); i-- > 0;)
    all.push_back(runs[found[i]].json);
  return all;
}

} // namespace molmesh::formats
