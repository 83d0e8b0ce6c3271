// phase_line.hpp — one line on a terminal that tells what a long run does: phase, share, time.
#pragma once
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace molmesh::cli {

/// A phase, and which share of the whole work is mostly done when it begins, 0 to 1.
struct ForeseenPhase {
  std::string name;
  double begin;
};

/// The share of the whole work after `seconds` of it, of which the present phase has lasted phase_seconds. What the
/// phase takes is guessed from what those before it took; where it takes longer, the share goes on ever more
/// slowly. begin, end: of the phase, as ForeseenPhase::begin.
double foreseen_share(double begin, double end, double seconds, double phase_seconds);

/// Nothing where standard error is no terminal, or with quiet. Written five times a second by a thread of its own,
/// so that a phase that takes minutes is seen to run.
class PhaseLine {
public:
  PhaseLine(const std::string& tool, bool quiet);
  ~PhaseLine(); ///< the line goes
  PhaseLine(const PhaseLine&) = delete;
  PhaseLine& operator=(const PhaseLine&) = delete;

  void phase(const std::string& name);
  /// For work that tells no share: which phases there are, ascending. The line has the share of the whole then. If
  /// a phase comes again the work has begun anew.
  void foresee(std::vector<ForeseenPhase> phases);
  /// Of the phase's work, 0 to 1; negative: not known. From any thread.
  void share(double done);
  /// Takes the line away until it is next written: before other lines on standard error.
  void clear();

private:
  void write();

  using Clock = std::chrono::steady_clock;
  const std::string tool_;
  const Clock::time_point begun_ = Clock::now();
  Clock::time_point phase_begun_ = begun_;
  std::string phase_;
  double share_ = -1;
  Clock::time_point told_ = begun_; ///< when share_ was last told
  std::vector<ForeseenPhase> foreseen_;
  size_t place_ = 0;                ///< of the phase in foreseen_; their number: none of them
  Clock::time_point pass_ = begun_; ///< when the first of them began
  bool over_ = false, shown_ = false;
  std::mutex guard_;
  std::condition_variable ending_;
  std::thread writer_;
};

/// "tetsmooth: improve [######......]  52 %, 12 s, about 11 s left"; share < 0: without share and time left. The
/// share was told `since` seconds ago, when the phase had taken phase_seconds: meanwhile the time left runs down.
std::string phase_text(const std::string& tool, const std::string& phase, double share, double seconds,
                       double phase_seconds, double since = 0);

} // namespace molmesh::cli
