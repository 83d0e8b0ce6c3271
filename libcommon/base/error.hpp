// error.hpp — the one exception of the library, and the exit status every tool maps it to (docs/conventions.md).
#pragma once
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace molmesh {

enum class Status {
  good = 0,
  failed = 1,           ///< the run failed
  usage = 2,            ///< options
  bad_input = 3,        ///< input unreadable or invalid
  not_written = 4,      ///< output not written
  below_quality = 5,    ///< valid and written, but below the quality asked for
  mode_unavailable = 6, ///< no GPU, or built without
};

/// what() is one line without a final newline; for bad input "FILE:LINE: what was found, what was expected".
/// quantities: what the caller may change to get further ("spacing", "box"), so that a program can name its flags.
struct Error : std::runtime_error {
  Error(Status s, const std::string& line, std::vector<std::string> changed = {})
      : std::runtime_error(line), status(s), quantities(std::move(changed)) {}
  Status status;
  std::vector<std::string> quantities;
};

[[noreturn]] inline void fail(Status status, const std::string& line, std::vector<std::string> quantities = {}) {
  throw Error(status, line, std::move(quantities));
}
/// Input that is unreadable or invalid: status 3. What the input itself put into the message stays on the line.
[[noreturn]] inline void fail_input(std::string line) {
  for (char& c : line)
    if (c == '\n' || c == '\r')
      c = '?';
  fail(Status::bad_input, line);
}

} // namespace molmesh
