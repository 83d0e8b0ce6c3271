// phase_line.cpp — writes the line again and again, as wide as the terminal lets it be.
#include "cli/phase_line.hpp"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sys/ioctl.h>
#include <unistd.h>
#include <utility>

namespace molmesh::cli {

std::string phase_text(const std::string& tool, const std::string& phase, double share, double seconds,
                       double phase_seconds, double since) {
  constexpr int wide = 12;
  char text[160];
  if (share < 0) {
    std::snprintf(text, sizeof text, ", %.0f s", seconds);
    return tool + ": " + phase + text;
  }
  std::string bar(wide, '.');
  std::fill_n(bar.begin(), std::clamp(static_cast<int>(share * wide), 0, wide), '#');
  std::snprintf(text, sizeof text, " [%s] %3.0f %%, %.0f s", bar.c_str(), 100 * share, seconds);
  std::string line = tool + ": " + phase + text;
  if (share > 0.02) {
    std::snprintf(text, sizeof text, ", about %.0f s left",
                  std::max(0., phase_seconds * (1 - share) / share - since));
    line += text;
  }
  return line;
}

double foreseen_share(double begin, double end, double seconds, double phase_seconds) {
  const double before = seconds - phase_seconds;
  if (begin <= 0 || before <= 0)
    return begin;
  constexpr double even = 0.8; // of what is foreseen for the phase
  const double part = phase_seconds / (before / begin * (end - begin));
  return begin + (end - begin) * (part < even ? part : 1 - (1 - even) * std::exp((even - part) / (1 - even)));
}

PhaseLine::PhaseLine(const std::string& tool, bool quiet) : tool_(tool) {
  if (quiet || !isatty(STDERR_FILENO))
    return;
  writer_ = std::thread([this] {
    std::unique_lock lock(guard_);
    while (!ending_.wait_for(lock, std::chrono::milliseconds(200), [this] { return over_; }))
      write();
  });
}

PhaseLine::~PhaseLine() {
  if (!writer_.joinable())
    return;
  {
    const std::lock_guard lock(guard_);
    over_ = true;
  }
  ending_.notify_one();
  writer_.join();
  clear();
}

void PhaseLine::clear() {
  const std::lock_guard lock(guard_);
  if (std::exchange(shown_, false))
    std::fputs("\r\033[K", stderr);
}

void PhaseLine::phase(const std::string& name) {
  const std::lock_guard lock(guard_);
  phase_ = name;
  phase_begun_ = Clock::now();
  share_ = -1;
  const size_t before = place_;
  place_ = static_cast<size_t>(
      std::find_if(foreseen_.begin(), foreseen_.end(), [&](const ForeseenPhase& p) { return p.name == name; }) -
      foreseen_.begin());
  if (place_ < foreseen_.size() && before < foreseen_.size() && place_ <= before)
    pass_ = phase_begun_;
}

void PhaseLine::foresee(std::vector<ForeseenPhase> phases) {
  const std::lock_guard lock(guard_);
  foreseen_ = std::move(phases);
  place_ = foreseen_.size();
}

void PhaseLine::share(double done) {
  const std::lock_guard lock(guard_);
  share_ = done;
  told_ = Clock::now();
}

void PhaseLine::write() {
  if (phase_.empty())
    return;
  const auto seconds = [](Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
  };
  const Clock::time_point now = Clock::now();
  std::string line;
  if (place_ < foreseen_.size()) {
    const double end = place_ + 1 < foreseen_.size() ? foreseen_[place_ + 1].begin : 1, all = seconds(pass_, now);
    line = phase_text(tool_, phase_, foreseen_share(foreseen_[place_].begin, end, all, seconds(phase_begun_, now)),
                      seconds(begun_, now), all);
  } else {
    line =
        phase_text(tool_, phase_, share_, seconds(begun_, now), seconds(phase_begun_, told_), seconds(told_, now));
  }
  winsize terminal{};
  const bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &terminal) == 0 && terminal.ws_col > 1;
  const int most = known ? terminal.ws_col - 1 : static_cast<int>(line.size());
  std::fprintf(stderr, "\r%.*s\033[K", most, line.c_str());
  shown_ = true;
}

} // namespace molmesh::cli
