// cleanup.hpp — temporary files that go away with the process, also when a signal ends it (I10).
#pragma once
#include <string>

namespace molmesh::cli {

/// Makes writes to a closed pipe and over a file-size limit ordinary errors, removes watched files before dying of
/// any signal that ends a process and can be caught, and on exit(), and makes sure that no file opened later takes
/// the place of a closed standard stream. As the first process of a container, whose signals the system would not
/// let end it, it then exits with 128 and the signal's number. Call once, before anything is opened.
void guard_process();

/// The name of a file that must not outlive this object, unless kept. It may be watched before the file is there,
/// when nobody else can have a file of that name. At most 16 at a time, paths under 4096 bytes.
/// Throws Error(not_written).
class Temporary {
public:
  explicit Temporary(const std::string& path);
  ~Temporary();
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  /// The file has become something else (renamed), or never was this process' own: leave it alone from now on.
  void keep();

private:
  int slot_;
};

} // namespace molmesh::cli
