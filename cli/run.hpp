// run.hpp — what every program shares: common options, the run report, main() around run(options).
#pragma once
#include "base/error.hpp"
#include "cli/file.hpp"
#include "cli/options.hpp"
#include "cli/phase_line.hpp"
#include "cli/value.hpp"
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace molmesh::cli {

/// Options of every program. A program's Options derives from it.
struct Common {
  std::string input = "-", output = "-";
  std::string mode = "auto"; ///< auto, seq, omp, cuda; auto becomes omp before the work, unless chooses_mode
  int threads = 0;           ///< 0: all
  std::string report;        ///< empty: none
  bool quiet = false, verbose = false;

  virtual ~Common() = default;
  /// The files written. None may be one of the files that options of type FILE and further arguments name, nor the
  /// report, nor, where the output is not what the input is, the input.
  virtual std::vector<std::string> outputs() const { return {output}; }
  bool keep_input = true;
  bool chooses_format = false;     ///< the program itself says which endings its output may have
  bool shows_every_output = false; ///< in the last line; else the first alone
  bool uses_threads = true;        ///< false: -t is taken, and all is done by one

  /// Set by programs that have a cuda mode: throws Error(mode_unavailable) where there is no device for it.
  void (*require_device)() = nullptr;
  bool chooses_mode = false; ///< the program itself says what auto is
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
  /// From now on a terminal shows the phase (PhaseLine), until the work is over.
  /// foreseen: where the program tells no share itself.
  void show_phases(std::vector<ForeseenPhase> foreseen = {});
  void hide_phases() { line_.reset(); }
  bool shows_phases() const { return line_ != nullptr; }
  /// Of the present phase, where it is shown.
  void share(double done) {
    if (line_)
      line_->share(done);
  }
  Value counts;
  /// It gets its name when the run is over and the report, too, could be written.
  void complete(OutputFile& output) { outputs.push_back(output.complete()); }
  /// What was made, for one line at the end unless -q: "1,164,552 tetrahedra, 1 body". The seconds and the first
  /// output's name follow in it. Empty: no line.
  std::string made;
  /// They get their names in the opposite order, the report, which comes last, before all others: where an output
  /// is, its report is.
  std::vector<CompleteFile> outputs;
  /// A line on stderr unless -q (prefixed with the program's name): what the user should know, not an error.
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

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
  }

private:
  const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point started_;
  static constexpr auto none = static_cast<size_t>(-1);
  size_t open_ = none; ///< of phases
  std::unique_ptr<PhaseLine> line_;
};

std::string version();
/// "hier2density 0.1.0"
std::string creator(const std::string& tool);

/// The whole of a program's main() but for what its table and its work are. Every exception becomes one line on
/// stderr and its exit status; the flags of the quantities that an Error names stand in that line.
int run_program(Table& table, Common& options, int argc, char** argv, const std::function<void()>& describe,
                const std::function<Status(Run&)>& work);

/// describe(table, options) declares the program's own options; work(options, run) works and returns a Status.
/// Before it options.check(), where there is one, throws what the table cannot say of them.
template <class Options, class Describe, class Work>
int run_main(const char* program, const char* purpose, int argc, char** argv, Describe describe, Work work) {
  Options options;
  Table table(program, purpose);
  return run_program(
      table, options, argc, argv, [&] { describe(table, options); },
      [&](Run& run) {
        if constexpr (requires { options.check(); })
          options.check();
        return work(options, run);
      });
}

} // namespace molmesh::cli
