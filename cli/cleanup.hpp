// cleanup.hpp — temporary files that go away with the process, also when a signal ends it (I10).
#pragma once
#include <string>

namespace molmesh::cli {

/// Makes writes to a closed pipe and over a file-size limit ordinary errors, removes watched files before dying of
/// SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU, SIGABRT or a timer's signal and on exit(), and
/// makes sure that no file opened later takes the place of a closed standard stream. Call once, before anything is
/// opened.
void guard_process();

/// A file that must not outlive this object, unless kept. At most 16 at a time, paths under 4096 bytes.
/// Throws Error(not_written).
class Temporary {
public:
  explicit Temporary(const std::string& path);
  ~Temporary();
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  /// The file has become something else (renamed): leave it alone from now on.
  void keep();

private:
  int slot_;
};

} // namespace molmesh::cli
