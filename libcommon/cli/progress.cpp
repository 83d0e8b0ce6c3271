// progress.cpp — done, rate, time left.
#include "cli/progress.hpp"
#include <algorithm>
#include <cstdio>
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
  char bar[31];
  for (int i = 0; i < 30; ++i)
    bar[i] = i < share * 30 ? '#' : '.';
  bar[30] = 0;
  std::fprintf(stderr, "\r%s [%s] %3.0f %%  %.3g %s/s  %.0f s left\033[K", label_.c_str(), bar, 100 * share, rate,
               unit_.c_str(), share > 0 ? seconds * (1 - share) / share : 0.0);
}

} // namespace molmesh::cli
