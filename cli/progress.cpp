// progress.cpp — done, rate, time left.
#include "cli/progress.hpp"
#include <algorithm>
#include <cstdio>
#include <sys/ioctl.h>
#include <unistd.h>

namespace molmesh::cli {

Progress::Progress(std::string label, std::string unit, bool quiet)
    : label_(std::move(label)), unit_(std::move(unit)), shown_(!quiet && isatty(STDERR_FILENO)),
      started_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
  if (shown_)
    std::fputs("\r\033[K", stderr);
}

void Progress::operator()(int64_t done, int64_t total) {
  if (!shown_)
    return;
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  const auto ms = static_cast<int64_t>(seconds * 1000);
  int64_t last = last_ms_.load();
  if (ms - last < 100 || !last_ms_.compare_exchange_strong(last, ms))
    return;
  const double share = total > 0 ? double(done) / double(total) : 0, rate = double(done) / std::max(seconds, 1e-3);
  constexpr int wide = 12;
  char bar[wide + 1], line[200];
  for (int i = 0; i < wide; ++i)
    bar[i] = i < share * wide ? '#' : '.';
  bar[wide] = 0;
  const int length =
      std::snprintf(line, sizeof line, "%s [%s] %3.0f %%  %lld of %lld %s  %.0f/s  %.0f s left", label_.c_str(),
                    bar, 100 * share, static_cast<long long>(done), static_cast<long long>(total), unit_.c_str(),
                    rate, share > 0 ? seconds * (1 - share) / share : 0.0);
  winsize terminal{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &terminal) == 0 && terminal.ws_col > 1;
  std::fprintf(stderr, "\r%.*s\033[K", known ? std::min(length, terminal.ws_col - 1) : length, line);
}

} // namespace molmesh::cli
