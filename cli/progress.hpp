// progress.hpp — a progress bar on stderr, shown only when it is a terminal.
#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>

namespace molmesh::cli {

/// Call it from any thread; it draws at most ten times a second.
class Progress {
public:
  Progress(std::string label, std::string unit, bool quiet);
  ~Progress();
  void operator()(int64_t done, int64_t total);

private:
  std::string label_, unit_;
  bool shown_ = false;
  std::atomic<int64_t> last_ms_{-1000};
  std::chrono::steady_clock::time_point started_;
};

} // namespace molmesh::cli
