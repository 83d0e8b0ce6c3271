// run.hpp — what every tool shares: common options, the run report, main() around run(options).
#pragma once
#include "base/error.hpp"
#include "base/large_array.hpp"
#include "base/memory.hpp"
#include "cli/cleanup.hpp"
#include "cli/file.hpp"
#include <CLI/CLI.hpp>
#include <chrono>
#include <ios>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace molmesh::cli {

/// Options of every tool (docs/conventions.md). A tool's Options derives from it.
struct Common {
  std::string input = "-", output = "-";
  std::string mode = "omp"; ///< seq, omp, cuda
  int threads = 0;          ///< 0: all
  std::string report;       ///< empty: none
  bool quiet = false, verbose = false;

  virtual ~Common() = default;
  /// The files written. None may be one of the files that options of type FILE and further arguments name, nor the
  /// report, nor, where the output is not what the input is, the input.
  virtual std::vector<std::string> outputs() const { return {output}; }
  bool keep_input = true;

  /// Set by tools that have a cuda mode: throws Error(mode_unavailable) where there is no device for it.
  void (*require_device)() = nullptr;
  bool on_device() const { return mode == "cuda"; }
  /// Threads to use on the host: 1 for seq. Throws Error(mode_unavailable) for cuda where that cannot be.
  int resolved_threads() const;
};

/// Phases and counts of one run, for --report and -v.
class Run {
public:
  /// Ends the phase before, starts this one or goes on with it.
  void phase(const std::string& name);
  void end_phase();
  nlohmann::ordered_json counts = nlohmann::ordered_json::object();
  /// It gets its name when the run is over and the report, too, could be written.
  void complete(OutputFile& output) { outputs.push_back(output.complete()); }
  std::vector<CompleteFile> outputs; ///< in the order in which they get their names
  /// A line on stderr unless -q (prefixed with the tool's name): what the user should know, not an error.
  void note(const std::string& line) const;
  void notes(const std::vector<std::string>& lines) const {
    for (const std::string& line : lines)
      note(line);
  }

  std::string tool;
  bool quiet = false, verbose = false;
  struct Phase {
    std::string name;
    double seconds;
  };
  std::vector<Phase> phases;

private:
  std::chrono::steady_clock::time_point started_;
  static constexpr auto none = static_cast<size_t>(-1);
  size_t open_ = none; ///< of phases
};

/// "hier2density 0.1.0"
std::string creator(const std::string& tool);

/// Numbers with a fixed count separated by commas ("0.9,1.1"), strictly parsed. Throws Error(usage).
std::vector<double> numbers(const std::string& option, const std::string& text, size_t count);

namespace detail {
void describe_common(CLI::App& app, Common& o);
/// Exit status when the run stops here (help, version, usage), else -1.
int parse(CLI::App& app, int argc, char** argv);
/// Opened before the run, so that a report that cannot be written stops it before any work. Null without --report.
/// Throws Error(usage) for files that would be written over.
std::unique_ptr<OutputFile> open_report(const CLI::App& app, const Common& o);
int finish(const CLI::App& app, const Common& o, Run& run, OutputFile* report, Status status);
int failed(const std::string& tool, const std::exception& e);
} // namespace detail

/// The whole of a tool's main(). describe(app, options) declares the tool's own options; run(options, run) works
/// and returns a Status. Every exception becomes one line on stderr and its exit status.
template <class Options, class Describe, class RunTool>
int run_main(const char* tool, const char* purpose, int argc, char** argv, Describe describe, RunTool run_tool) {
  try {
    guard_process();
    keep_freed_pages();
    std::ios::sync_with_stdio(false);
    Options options;
    CLI::App app(purpose, tool);
    detail::describe_common(app, options);
    describe(app, options);
    if (const int status = detail::parse(app, argc, argv); status >= 0)
      return status;
    const int threads = options.resolved_threads(); // a mode that is not here stops before any file is touched
    if (!options.on_device())                       // whose driver sets aside addresses beyond any memory
      limit_memory(threads);
    const std::unique_ptr<OutputFile> report = detail::open_report(app, options);
    Run run;
    run.tool = tool;
    run.quiet = options.quiet;
    run.verbose = options.verbose;
    if (options.threads > threads && options.mode == "seq")
      run.note("-t " + std::to_string(options.threads) + ": --mode seq is one thread");
    const Status result = run_tool(options, run);
    return detail::finish(app, options, run, report.get(), result);
  } catch (const std::exception& e) {
    return detail::failed(tool, e);
  }
}

} // namespace molmesh::cli
